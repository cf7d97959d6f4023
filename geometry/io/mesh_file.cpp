#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>

#include "geometry/io/format_internal.h"
#include "geometry/io/pds_label_internal.h"
#include "numerics/files/gzip_stream.h"
#include "numerics/files/input_file.h"
#include "numerics/files/zstd_stream.h"

namespace astrolith {

void MeshFile::fail(std::string_view place, std::string_view what, std::string_view remedy) const {
  std::string message = path.string() + ": ";
  if (!place.empty()) message.append(place).append(": ");
  throw InputError(message.append(what).append("; ").append(remedy));
}

namespace {

// Replaces a compressed file by its content. Meshes become a few times smaller; a file that would become a
// hundred times as large is refused.
void unpack(MeshFile& file) {
  constexpr std::uint64_t kMostGrowth = 100;
  try {
    const std::uint64_t most = kMostGrowth * file.bytes.size();
    file.bytes = is_gzip(file.bytes) ? unpack_gzip(file.bytes, most) : unpack_zstd(file.bytes, most);
  } catch (const InputError& e) {
    throw InputError(file.path.string() + ": " + e.what());
  }
}

// Whether the bytes begin as UTF-16 in either byte order: every other one of them is zero.
bool is_utf16(std::string_view bytes) {
  constexpr std::size_t kSeen = 16;
  for (const std::string_view mark : {"\xff\xfe", "\xfe\xff"}) {
    if (bytes.starts_with(mark)) bytes.remove_prefix(mark.size());
  }
  const auto is_zero = [&](std::size_t k) { return bytes[k] == '\0'; };
  if (bytes.size() < kSeen || is_zero(0) == is_zero(1)) return false;
  for (std::size_t k = 2; k < kSeen; ++k) {
    if (is_zero(k) != is_zero(k % 2)) return false;
  }
  return true;
}

}  // namespace

MeshFile load_mesh_file(const std::filesystem::path& path) {
  MeshFile file{path, {}, {}};
  require_plain_file(path);
  std::ifstream in(path, std::ios::binary);
  if (!in) file.fail("", std::string("cannot be read (") + std::strerror(errno) + ")", "check its rights");
  file.bytes.resize(std::filesystem::file_size(path));
  in.read(file.bytes.data(), static_cast<std::streamsize>(file.bytes.size()));
  if (in.bad()) file.fail("", "reading failed", "copy it to another disk");
  file.bytes.resize(static_cast<std::size_t>(in.gcount()));
  if (is_zstd(file.bytes) || is_gzip(file.bytes)) unpack(file);
  if (is_utf16(file.bytes)) file.fail("", "its text is UTF-16", "save it as UTF-8 or ASCII");
  blank_label(file);
  return file;
}

std::string quoted(std::string_view piece) {
  constexpr std::size_t kLongest = 40;
  std::string text = "'";
  for (const char c : piece.substr(0, kLongest)) text += c >= ' ' && c <= '~' ? c : '?';
  return text + (piece.size() > kLongest ? "...'" : "'");
}

}  // namespace astrolith
