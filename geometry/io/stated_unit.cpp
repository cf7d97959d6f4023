#include <algorithm>
#include <fstream>
#include <string_view>
#include <system_error>

#include "geometry/io/mesh_io.h"
#include "numerics/files/zstd_stream.h"

namespace astrolith {
namespace {

constexpr std::size_t kMostHeader = 4096, kLongestUnit = 8;
// More than the first block of a Zstandard frame takes (RFC 8878: at most 128 kB).
constexpr std::size_t kMostPacked = std::size_t{1} << 18;

// The beginning of the file's content; empty for what is no plain file.
std::string header_of(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return {};
  std::ifstream in(file, std::ios::binary);
  std::string bytes(kMostPacked, '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  if (is_zstd(bytes)) return unpack_zstd_start(bytes, kMostHeader);
  bytes.resize(std::min(bytes.size(), kMostHeader));
  return bytes;
}

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

// The unit of one line of a header; empty where the line states none.
std::string_view unit_of_line(std::string_view line) {
  constexpr std::string_view kLabel = "length unit: ";
  for (const std::string_view start : {"comment ", "# ", "Binary STL; "}) {
    if (!line.starts_with(start) || !line.substr(start.size()).starts_with(kLabel)) continue;
    const std::string_view rest = line.substr(start.size() + kLabel.size());
    const auto end = std::find_if_not(rest.begin(), rest.end(), is_letter);
    const std::string_view unit = rest.substr(0, static_cast<std::size_t>(end - rest.begin()));
    return unit.size() <= kLongestUnit ? unit : std::string_view();
  }
  return {};
}

}  // namespace

std::string stated_length_unit(const std::filesystem::path& file) {
  const std::string header = header_of(file);
  for (std::string_view rest = header; !rest.empty();) {
    const std::size_t end = std::min(rest.find('\n'), rest.size() - 1);
    if (const std::string_view unit = unit_of_line(rest.substr(0, end + 1)); !unit.empty())
      return std::string(unit);
    rest.remove_prefix(end + 1);
  }
  return {};
}

}  // namespace astrolith
