// Reads a binary file number by number, in either byte order, and never past its end.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <string>
#include <type_traits>

#include "geometry/io/format_internal.h"

namespace astrolith {

class ByteReader {
 public:
  explicit ByteReader(const MeshFile& file, std::size_t offset = 0, std::endian order = std::endian::little)
      : file_(file), at_(offset), swap_(order != std::endian::native) {}

  template <typename T>
  T read(std::string_view what) {
    std::array<char, sizeof(T)> raw;
    need(sizeof(T), what);
    std::memcpy(raw.data(), file_.bytes.data() + at_, sizeof(T));
    if (swap_) std::reverse(raw.begin(), raw.end());
    at_ += sizeof(T);
    const T value = std::bit_cast<T>(raw);
    if constexpr (std::is_floating_point_v<T>) {
      if (!std::isfinite(value)) fail(std::string(what) + " is not a finite number", "repair the file");
    }
    return value;
  }
  Vec3d read_floats_xyz() {
    const float x = read<float>("x"), y = read<float>("y"), z = read<float>("z");
    return {x, y, z};
  }
  void skip(std::size_t bytes, std::string_view what) {
    need(bytes, what);
    at_ += bytes;
  }
  // Throws unless `count` rows of row_bytes still follow. Readers call it before they allocate memory for the
  // rows.
  void need_rows(std::uint64_t count, std::size_t row_bytes, std::string_view rows) const {
    if (row_bytes != 0 && count > bytes_left() / row_bytes) {
      fail(std::to_string(count) + " " + std::string(rows) + " are declared, but only " +
               std::to_string(bytes_left()) + " bytes follow",
           "it may be truncated: fetch it again");
    }
  }

  std::size_t bytes_left() const { return file_.bytes.size() - at_; }
  std::string place() const { return "byte " + std::to_string(at_); }
  [[noreturn]] void fail(std::string_view what, std::string_view remedy) const {
    file_.fail(place(), what, remedy);
  }

 private:
  void need(std::size_t bytes, std::string_view what) const {
    if (bytes > bytes_left()) {
      fail("the file ends where " + std::string(what) + " should stand",
           "it may be truncated: fetch it again");
    }
  }

  const MeshFile& file_;
  std::size_t at_;
  bool swap_;
};

}  // namespace astrolith
