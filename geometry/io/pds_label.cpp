#include <algorithm>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "geometry/io/named_table_internal.h"
#include "geometry/io/pds_label_internal.h"
#include "numerics/length_unit.h"

namespace astrolith {
namespace {

// The file that the label's first pointer names (^TABLE = "X.TAB"); empty where it names none.
std::string_view named_file(std::string_view label) {
  for (std::size_t at = 0; (at = label.find("\n^", at)) != label.npos; ++at) {
    const std::string_view line = label.substr(at + 1, label.find('\n', at + 1) - at - 1);
    const std::size_t open = line.find('"'), close = line.rfind('"');
    if (open < close) return line.substr(open + 1, close - open - 1);
  }
  return {};
}

// The unit of lengths that the text begins with, behind blanks and signs: \"KILOMETER\" or >km<.
std::string unit_at_start(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t=\"'<"), text.size()));
  const std::size_t end = std::min(text.find_first_of(" \t\r\n\"'<>"), text.size());
  std::string unit = short_unit(lower_case(text.substr(0, end)));
  return has_known_length(unit) ? unit : std::string();
}

}  // namespace

LabelBeside label_beside(const std::filesystem::path& file) {
  constexpr std::size_t kMostLabel = std::size_t{1} << 18;
  const std::string name = lower_case(file.filename().string());
  for (const char* extension : {".lbl", ".LBL", ".xml", ".XML"}) {
    const std::filesystem::path path = std::filesystem::path(file).replace_extension(extension);
    std::error_code error;
    if (path == file || !std::filesystem::is_regular_file(path, error)) continue;
    LabelBeside label{path, std::string(kMostLabel, '\0')};
    std::ifstream in(label.path, std::ios::binary);
    in.read(label.text.data(), static_cast<std::streamsize>(label.text.size()));
    label.text.resize(static_cast<std::size_t>(in.gcount()));
    if (lower_case(label.text).find(name) != std::string::npos) return label;
  }
  return {};
}

bool says_west(std::string_view label) {
  constexpr std::string_view kKeyword = "longitude_direction";
  const std::string lower = lower_case(label);
  for (std::size_t at = 0; (at = lower.find(kKeyword, at)) != lower.npos;) {
    at += kKeyword.size();
    std::string_view value = std::string_view(lower).substr(at);
    value.remove_prefix(std::min(value.find_first_not_of(" \t=\"'>"), value.size()));
    if (value.starts_with("positive ")) value.remove_prefix(9);
    if (value.starts_with("west") || value.starts_with("east")) return value.starts_with("west");
  }
  return lower.find("west longitude") != lower.npos && lower.find("east longitude") == lower.npos;
}

bool begins_pds3_label(std::string_view bytes) {
  return bytes.starts_with("PDS_VERSION_ID") || bytes.starts_with("CCSD3ZF");
}

std::string unit_in_label(std::string_view text) {
  const bool pds3 = begins_pds3_label(text);
  const std::string_view name = pds3 ? "UNIT" : "<unit>";
  for (std::size_t at = 0; (at = text.find(name, at)) != text.npos;) {
    at += name.size();
    std::string_view value = text.substr(at, 40);
    if (pds3) {
      value.remove_prefix(value.starts_with('S') ? 1 : 0);
      const std::size_t equals = std::min(value.find_first_not_of(" \t"), value.size());
      if (!value.substr(equals).starts_with('=')) continue;
    }
    if (std::string unit = unit_at_start(value); !unit.empty()) return unit;
  }
  return {};
}

void blank_label(MeshFile& file) {
  if (!begins_pds3_label(file.bytes)) return;
  TextScanner scan(file);
  bool ended = false;
  while (!ended && scan.next_line()) ended = scan.word() == "END" && scan.line_done();
  const auto data = file.bytes.end() - static_cast<std::ptrdiff_t>(ended ? scan.bytes_left() : 0);
  const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\0'; };
  if (std::all_of(data, file.bytes.end(), is_blank)) {
    const std::string_view name = named_file(file.bytes);
    file.fail("", "is a PDS3 label without its data",
              name.empty() ? "give the file of the data" : "give " + astrolith::quoted(name));
  }
  file.label.assign(file.bytes.begin(), data);
  std::replace_if(
      file.bytes.begin(), data, [](char c) { return c != '\r' && c != '\n'; }, ' ');
}

}  // namespace astrolith
