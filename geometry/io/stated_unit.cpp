#include <algorithm>
#include <fstream>
#include <string_view>
#include <system_error>

#include "geometry/io/mesh_format.h"
#include "geometry/io/mesh_io.h"
#include "geometry/io/named_table_internal.h"
#include "geometry/io/pds_label_internal.h"
#include "numerics/files/gzip_stream.h"
#include "numerics/files/zstd_stream.h"
#include "numerics/length_unit.h"

namespace astrolith {
namespace {

constexpr std::size_t kMostHeader = 4096, kLongestUnit = 8;
// More than the first block of a Zstandard frame takes (RFC 8878: at most 128 kB), and than labels take.
constexpr std::size_t kMostRead = std::size_t{1} << 18;

// The beginning of the file's content; empty for what is no plain file.
std::string read_start(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return {};
  std::ifstream in(file, std::ios::binary);
  std::string bytes(kMostRead, '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (bytes.starts_with(kByteOrderMark)) bytes.erase(0, kByteOrderMark.size());
  if (is_gzip(bytes)) return unpack_gzip_start(bytes, kMostHeader);
  return is_zstd(bytes) ? unpack_zstd_start(bytes, kMostHeader) : bytes;
}

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

std::string_view first_letters(std::string_view text) {
  const auto end = std::find_if_not(text.begin(), text.end(), is_letter);
  return text.substr(0, static_cast<std::size_t>(end - text.begin()));
}

// The comment in a line of a header; empty where it is none.
std::string_view find_comment(std::string_view line) {
  for (const std::string_view start : {"comment ", "obj_info ", "# ", "#", "//", "%", "Binary STL; "}) {
    if (line.starts_with(start)) return line.substr(start.size());
  }
  return {};
}

// The unit of lengths that a comment of the form "Units: parsecs" states in a word that short_unit() does not
// know. Other words than these come in front where it is of something else: "density units: kg/m^3".
std::string unknown_unit(std::string_view words_before, std::string_view word) {
  constexpr std::size_t kLongest = 20;
  const bool alone = words_before.find_first_not_of(" \t") == words_before.npos;
  if (!alone || word.size() > kLongest || !short_unit(word).empty() || word == "none" || word == "unknown")
    return {};
  return std::string(word);
}

// Whether a short form is of lengths; that of "ft" has no known length, and is stated all the same.
bool is_length_unit(std::string_view unit) {
  return unit.find(' ') == unit.npos && !unit.empty() && unit != "deg" && unit != "rad";
}

// The unit of lengths that words such as "Units: meters", "length_unit m", "km units" or "all lengths in km"
// state.
std::string unit_in_words(std::string_view comment) {
  const std::string lower = lower_case(comment);
  for (const std::string_view mark :
       {"unit:", "units:", "unit =", "units =", "unit=", "units=", "unit is ", "units are ",
        "coordinates in ", "vertices in ", "lengths in ", "distances in ", "coordinates are in ",
        "vertices are in ", "lengths are in ", "units of ", "unit ", "units "}) {
    const std::size_t at = lower.find(mark);
    if (at == lower.npos || (at > 0 && is_letter(lower[at - 1]))) continue;
    std::string_view rest = std::string_view(lower).substr(at + mark.size());
    rest.remove_prefix(std::min(rest.find_first_not_of(" \t(['\""), rest.size()));
    // Not "m/s", and not "in development".
    const std::string_view word = first_letters(rest), behind = rest.substr(word.size());
    if (behind.find_first_of("/^*-0123456789") == 0) continue;
    if (word == "in" && behind.size() > 1 && behind[0] == ' ' && is_letter(behind[1])) continue;
    if (std::string unit = short_unit(word); is_length_unit(unit)) return unit;
    if (word == "si") return "m";
    // "unit normals" are no lengths.
    if (!mark.starts_with("unit") || mark == "units of " || mark == "unit " || mark == "units ") continue;
    if (std::string unit = unknown_unit(std::string_view(lower).substr(0, at), first_letters(rest));
        !unit.empty())
      return unit;
  }
  // "coordinates: km units"
  for (std::size_t at = lower.find(" unit"); at != lower.npos; at = lower.find(" unit", at + 1)) {
    const std::size_t begin = lower.find_last_not_of("abcdefghijklmnopqrstuvwxyz", at == 0 ? 0 : at - 1);
    const std::size_t first = begin == lower.npos ? 0 : begin + 1;
    if (begin != lower.npos && (lower[begin] == '/' || lower[begin] == '^')) continue;
    const std::string_view word = std::string_view(lower).substr(first, at - first);
    if (word == "in") continue;  // "in units of the radius"
    if (std::string unit = short_unit(word); is_length_unit(unit)) return unit;
  }
  return {};
}

// The unit that a line of a header states; empty where it states none.
std::string line_unit(std::string_view line) {
  constexpr std::string_view kLabel = "length unit: ";  // of write_mesh()
  const std::string_view comment = find_comment(line);
  if (comment.starts_with(kLabel)) {
    const std::string_view unit = first_letters(comment.substr(kLabel.size()));
    if (!unit.empty() && unit.size() <= kLongestUnit) return std::string(unit);
  }
  if (std::string unit = unit_in_words(comment); !unit.empty()) return unit;
  const std::optional<TableLayout> columns = named_layout(comment.empty() ? line : comment);
  return columns && is_length_unit(columns->unit) ? columns->unit : std::string();
}

// The unit of a format that has one: metres of a glTF, unless its writer, this program, states another of
// unknown length; kilometres of a SPICE kernel.
std::string unit_of_format(std::string_view start) {
  if (start.starts_with("DAS/DSK") || start.starts_with("NAIF/DSK")) return "km";
  if (!start.starts_with("glTF")) return {};
  constexpr std::string_view kOwn = "\"length_unit\":\"";
  const std::size_t at = start.substr(0, kMostHeader).find(kOwn);
  const std::string_view own = at == start.npos ? "" : first_letters(start.substr(at + kOwn.size()));
  // The reader has heeded the scale that files of November 2026 and before have for a known unit.
  return own.empty() || own.size() > kLongestUnit || has_known_length(own) ? "m" : std::string(own);
}

}  // namespace

StatedUnit stated_unit(const std::filesystem::path& file) {
  const std::string start = read_start(file);
  if (std::string unit = unit_of_format(start); !unit.empty()) return {std::move(unit), {}};
  if (begins_pds3_label(start)) return {unit_in_label(start), {}};
  if (mesh_extension(file) == ".stl") {
    constexpr std::size_t kStlHeader = 80;
    if (std::string unit = unit_in_words(start.substr(0, kStlHeader)); !unit.empty())
      return {std::move(unit), {}};
  }
  for (std::string_view rest = std::string_view(start).substr(0, kMostHeader); !rest.empty();) {
    const std::size_t end = std::min(rest.find_first_of("\n\r"), rest.size());
    if (std::string unit = line_unit(rest.substr(0, end)); !unit.empty()) return {std::move(unit), {}};
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  LabelBeside label = label_beside(file);
  std::string unit = unit_in_label(label.text);
  if (unit.empty()) return {};
  return {std::move(unit), std::move(label.path)};
}

}  // namespace astrolith
