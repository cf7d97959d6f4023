#include <array>
#include <utility>

#include "geometry/io/ply_header_internal.h"

namespace astrolith {
namespace {

PlyType parse_type(const TextScanner& scan, std::string_view word) {
  using enum PlyType;
  // The names of Turk 1994, and later names that state the size.
  static constexpr std::array<std::pair<std::string_view, PlyType>, 16> kNames{{
      {"char", int8},
      {"int8", int8},
      {"uchar", uint8},
      {"uint8", uint8},
      {"short", int16},
      {"int16", int16},
      {"ushort", uint16},
      {"uint16", uint16},
      {"int", int32},
      {"int32", int32},
      {"uint", uint32},
      {"uint32", uint32},
      {"float", float32},
      {"float32", float32},
      {"double", float64},
      {"float64", float64},
  }};
  for (const auto& [name, type] : kNames) {
    if (name == word) return type;
  }
  scan.fail(quoted(word) + " is no PLY type", "use char, uchar, short, ushort, int, uint, float or double");
}

void parse_format(TextScanner& scan, PlyHeader& header) {
  const std::string_view format = scan.word();
  header.ascii = format == "ascii";
  header.order = format == "binary_big_endian" ? std::endian::big : std::endian::little;
  if (!header.ascii && format != "binary_little_endian" && format != "binary_big_endian") {
    scan.fail("the format is " + quoted(format), "use ascii, binary_little_endian or binary_big_endian");
  }
}

PlyElement parse_element(TextScanner& scan) {
  PlyElement element;
  element.name = scan.word();
  const std::int64_t count = scan.integer("the element's count");
  if (count < 0) scan.fail("the element's count is negative", "correct the header");
  element.count = static_cast<std::uint64_t>(count);
  return element;
}

PlyProperty parse_property(TextScanner& scan) {
  PlyProperty property;
  std::string_view word = scan.word();
  if (word == "list") {
    property.is_list = true;
    property.count_type = parse_type(scan, scan.word());
    word = scan.word();
  }
  property.type = parse_type(scan, word);
  property.name = scan.word();
  if (property.name.empty()) scan.fail("the property has no name", "correct the header");
  return property;
}

}  // namespace

std::size_t type_size(PlyType type) {
  static constexpr std::array<std::size_t, 8> kSizes{1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

std::size_t PlyElement::least_row_bytes() const {
  std::size_t bytes = 0;
  for (const PlyProperty& p : properties) bytes += type_size(p.is_list ? p.count_type : p.type);
  return bytes;
}

PlyHeader read_ply_header(TextScanner& scan) {
  if (!scan.next_line() || scan.word() != "ply") {
    scan.fail("a PLY file starts with the line 'ply'", "give a PLY file or the right extension");
  }
  PlyHeader header;
  bool has_format = false;
  while (scan.next_line()) {
    const std::string_view keyword = scan.word();
    if (keyword == "end_header") {
      if (!has_format) scan.fail("the header has no line 'format'", "add it");
      return header;
    }
    if (keyword == "format") {
      parse_format(scan, header);
      has_format = true;
    } else if (keyword == "element") {
      header.elements.push_back(parse_element(scan));
    } else if (keyword == "property") {
      if (header.elements.empty()) scan.fail("a property before any element", "correct the header");
      header.elements.back().properties.push_back(parse_property(scan));
    } else if (keyword != "comment" && keyword != "obj_info" && !keyword.empty()) {
      scan.fail(quoted(keyword) + " is no keyword of a PLY header", "correct the header");
    }
  }
  scan.fail_truncated("'end_header'");
}

}  // namespace astrolith
