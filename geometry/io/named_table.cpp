#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "geometry/io/named_table_internal.h"
#include "numerics/portable_angles.h"

namespace astrolith {

std::string short_unit(std::string_view word) {
  static constexpr std::pair<std::string_view, std::string_view> kUnits[] = {{"m", "m"},
                                                                             {"meter", "m"},
                                                                             {"meters", "m"},
                                                                             {"metre", "m"},
                                                                             {"metres", "m"},
                                                                             {"km", "km"},
                                                                             {"kilometer", "km"},
                                                                             {"kilometers", "km"},
                                                                             {"kilometre", "km"},
                                                                             {"kilometres", "km"},
                                                                             {"cm", "cm"},
                                                                             {"centimetre", "cm"},
                                                                             {"centimetres", "cm"},
                                                                             {"centimeter", "cm"},
                                                                             {"centimeters", "cm"},
                                                                             {"mm", "mm"},
                                                                             {"millimetre", "mm"},
                                                                             {"millimetres", "mm"},
                                                                             {"millimeter", "mm"},
                                                                             {"millimeters", "mm"},
                                                                             {"deg", "deg"},
                                                                             {"degree", "deg"},
                                                                             {"degrees", "deg"},
                                                                             {"\xc2\xb0", "deg"},
                                                                             {"ft", "ft"},
                                                                             {"feet", "ft"},
                                                                             {"mi", "mi"},
                                                                             {"in", "in"},
                                                                             {"inch", "in"},
                                                                             {"inches", "in"},
                                                                             {"um", "um"},
                                                                             {"micron", "um"},
                                                                             {"microns", "um"},
                                                                             {"micrometer", "um"},
                                                                             {"micrometers", "um"},
                                                                             {"micrometre", "um"},
                                                                             {"micrometres", "um"},
                                                                             {"au", "au"},
                                                                             {"rad", "rad"},
                                                                             {"radian", "rad"},
                                                                             {"radians", "rad"}};
  for (const auto& [name, unit] : kUnits) {
    if (name == word) return std::string(unit);
  }
  return {};
}

namespace {

constexpr std::string_view kBlanks = " \t\r\v\f", kComments = "#%!";

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) + 1 - first);
}

// A field without blanks and quotes around it.
std::string_view unquoted(std::string_view field) {
  field = trimmed(field);
  const bool in_quotes = field.size() > 1 && field.front() == '"' && field.back() == '"';
  return in_quotes ? trimmed(field.substr(1, field.size() - 2)) : field;
}

constexpr std::string_view kSeparators = ",;\t";

// The line with letters for all that stands in quotes, which open at the start of a field.
std::string without_quoted(std::string_view line) {
  std::string text(line);
  bool quoted = false, at_start = true;
  for (char& c : text) {
    const bool mark = c == '"' && (quoted || at_start);
    if (mark) quoted = !quoted;
    // A quote behind one that closes opens again: it stands for a quote in the text.
    at_start = !quoted && (mark || kSeparators.find(c) != kSeparators.npos || (at_start && c == ' '));
    if (quoted) c = 'q';
  }
  return text;
}

// The fields of a line, without those that are empty at its end.
void split_fields(std::string_view line, std::vector<std::string_view>& fields) {
  fields.clear();
  const std::string quoted = line.find('"') == line.npos ? "" : without_quoted(line);
  const std::string_view seen = quoted.empty() ? line : std::string_view(quoted);
  const auto* const separator =
      std::find_if(kSeparators.begin(), kSeparators.end(), [&](char c) { return seen.find(c) != seen.npos; });
  const bool by_blanks = separator == kSeparators.end();
  for (std::size_t start = 0; start < line.size();) {
    const std::size_t end =
        std::min(by_blanks ? seen.find_first_of(kBlanks, start) : seen.find(*separator, start), line.size());
    const std::string_view field = unquoted(line.substr(start, end - start));
    if (!by_blanks || !field.empty()) fields.push_back(field);
    start = end + 1;
  }
  while (!fields.empty() && fields.back().empty()) fields.pop_back();
}

bool is_comment(std::string_view line) {
  return !line.empty() && (kComments.find(line.front()) != kComments.npos || line.starts_with("//"));
}

struct ColumnName {
  std::string base, unit;  // in lower case; the unit may be any word in brackets
};

ColumnName parse_name(std::string_view field) {
  const std::string name = lower_case(field);
  if (const std::size_t open = name.find_first_of("(["); open != name.npos && open > 0) {
    std::string_view words = trimmed(std::string_view(name).substr(open));
    // Words behind the brackets are of the unit too: "lon (deg) west".
    if (const std::size_t close = words.find_first_of(")]"); close >= words.size() - 1)
      words = trimmed(words.substr(1, close - 1));
    const std::string unit = short_unit(words);
    return {std::string(trimmed(std::string_view(name).substr(0, open))),
            unit.empty() ? std::string(words) : unit};
  }
  const std::size_t cut = name.find_last_of("_/ .");
  if (cut != name.npos && cut > 0) {
    if (const std::string unit = short_unit(std::string_view(name).substr(cut + 1)); !unit.empty())
      return {name.substr(0, cut), unit};
  }
  return {name, {}};
}

// The names of columns in a line. Where blanks separate names, a unit in brackets belongs to the name before.
std::vector<std::string> names_in(std::string_view line) {
  std::vector<std::string_view> fields;
  split_fields(line, fields);
  std::vector<std::string> names;
  bool in_brackets = false;
  for (const std::string_view field : fields) {
    const bool is_unit = in_brackets || field.starts_with('(') || field.starts_with('[');
    if (is_unit && !names.empty()) {
      names.back().append(" ").append(field);
    } else {
      names.emplace_back(field);
    }
    const std::size_t bracket = field.find_last_of("()[]");
    if (bracket != field.npos) in_brackets = field[bracket] == '(' || field[bracket] == '[';
  }
  return names;
}

using Names = std::vector<std::string_view>;

// The first column with one of the names; `columns.size()` where none has one.
std::size_t find_column(const std::vector<ColumnName>& columns, const Names& names) {
  for (const std::string_view name : names) {
    const auto at =
        std::find_if(columns.begin(), columns.end(), [&](const auto& c) { return c.base == name; });
    if (at != columns.end()) return static_cast<std::size_t>(at - columns.begin());
  }
  return columns.size();
}

bool find_columns(const std::vector<ColumnName>& columns, const std::array<Names, 3>& names,
                  TableLayout& layout) {
  for (std::size_t k = 0; k < 3; ++k) layout.columns[k] = find_column(columns, names[k]);
  return *std::max_element(layout.columns.begin(), layout.columns.end()) < columns.size();
}

const Names kWest = {"west_longitude", "w_longitude", "longitude_w", "wlon",           "lon_w",
                     "w_lon",          "west_lon",    "lonw",        "longitude west", "west longitude"};

bool find_place(const std::vector<ColumnName>& columns, TableLayout& layout) {
  for (const std::string_view stem :
       {"", "pos_", "position_", "point_", "points_", "center_", "centre_", "vertex_", "coord_"}) {
    const std::string s(stem), x = s + "x", y = s + "y", z = s + "z";
    if (find_columns(columns, {Names{x}, Names{y}, Names{z}}, layout)) return true;
  }
  if (find_columns(columns, {Names{"points:0"}, Names{"points:1"}, Names{"points:2"}}, layout)) return true;
  layout.spherical = true;
  Names longitudes{"longitude",      "lon",         "long",        "lng",
                   "east_longitude", "e_longitude", "longitude_e", "east longitude",
                   "east_lon",       "elon",        "e_lon",       "lon_e"};
  longitudes.insert(longitudes.end(), kWest.begin(), kWest.end());
  return find_columns(columns, {Names{"latitude", "lat"}, longitudes, Names{"radius", "r"}}, layout);
}

// The unit of x, y and z. It may stand behind one of them only: "x, y, z (km)".
std::string table_unit(const std::vector<ColumnName>& columns, const TableLayout& layout) {
  std::string unit;
  for (const std::size_t k : layout.columns) {
    if (!unit.empty() && !columns[k].unit.empty() && columns[k].unit != unit) return "several units";
    if (!columns[k].unit.empty()) unit = columns[k].unit;
  }
  return unit;
}

// What the unit of an angle says: "deg W", "degrees_north", "rad".
struct AngleUnit {
  bool west = false, radians = false, known = true;
};

AngleUnit angle_unit(std::string_view unit) {
  constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyz";
  static const Names kPassedOver = {"e", "east", "n", "north", "positive", "to", "planetocentric"};
  AngleUnit said;
  for (std::size_t at = 0; (at = unit.find_first_of(kLetters, at)) != unit.npos;) {
    const std::string_view word = unit.substr(at, unit.find_first_not_of(kLetters, at) - at);
    at += word.size();
    const std::string angle = short_unit(word);
    if (word == "w" || word == "west") {
      said.west = true;
    } else if (angle == "rad") {
      said.radians = true;
    } else if (angle != "deg" &&
               std::find(kPassedOver.begin(), kPassedOver.end(), word) == kPassedOver.end()) {
      said.known = false;
    }
  }
  return said;
}

void set_angles(const std::vector<ColumnName>& columns, TableLayout& layout) {
  const ColumnName &latitude = columns[layout.columns[0]], &longitude = columns[layout.columns[1]];
  const AngleUnit latitude_unit = angle_unit(latitude.unit), longitude_unit = angle_unit(longitude.unit);
  layout.west = longitude_unit.west || std::find(kWest.begin(), kWest.end(), longitude.base) != kWest.end();
  if (latitude_unit.radians || longitude_unit.radians) layout.radians = 1.0;
  if (!latitude_unit.known || latitude_unit.west) layout.unknown = latitude.unit;
  if (!longitude_unit.known) layout.unknown = longitude.unit;
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + astrolith::quoted(name);
  return text;
}

std::string describe(const std::vector<std::string>& names, const TableLayout& layout) {
  std::vector<std::string> taken, left;
  for (const std::size_t column : layout.columns) taken.push_back(names[column]);
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (std::find(layout.columns.begin(), layout.columns.end(), k) == layout.columns.end() && left.size() < 6)
      left.push_back(names[k]);
  }
  const bool more = names.size() > left.size() + 3;
  return "columns " + joined(taken) + " are taken as " +
         (!layout.spherical ? "x, y, z"
          : layout.west     ? "latitude, west longitude, radius"
                            : "latitude, longitude, radius") +
         (layout.unit.empty() ? "" : " in " + layout.unit) +
         (left.empty() ? "" : "; left out: " + joined(left) + (more ? ", ..." : ""));
}

}  // namespace

std::optional<TableLayout> named_layout(std::string_view line) {
  if (const std::size_t colon = line.find(": "); colon != line.npos) line.remove_prefix(colon + 2);
  const std::vector<std::string> names = names_in(line);
  std::vector<ColumnName> columns;
  for (const std::string& name : names) columns.push_back(parse_name(name));
  TableLayout layout;
  if (!find_place(columns, layout)) return {};
  layout.width = names.size();
  layout.unit = layout.spherical ? columns[layout.columns[2]].unit : table_unit(columns, layout);
  layout.radians = std::numbers::pi / 180.0;
  if (layout.spherical) set_angles(columns, layout);
  layout.words = describe(names, layout);
  return layout;
}

Vec3d spherical_point(double latitude, double longitude, double radius) {
  const portable::SineCosine lat = portable::sine_and_cosine(latitude),
                             lon = portable::sine_and_cosine(longitude);
  return radius * Vec3d{lat.cosine * lon.cosine, lat.cosine * lon.sine, lat.sine};
}

NamedTable::NamedTable(const MeshFile& file) : scan_(file) {
  find_layout();
  if (layout_ && !layout_->unknown.empty()) {
    scan_.fail("the names of the columns state an angle in " + astrolith::quoted(layout_->unknown),
               "state deg or rad, and E or W");
  }
}

void NamedTable::find_layout() {
  std::optional<TableLayout> in_comment;
  while (scan_.next_line()) {
    const std::string_view line = trimmed(scan_.whole_line());
    if (is_comment(line)) {
      const std::string_view marks = line.front() == '/' ? "/" : kComments;
      const std::size_t text = std::min(line.find_first_not_of(marks), line.size());
      if (auto named = named_layout(line.substr(text))) in_comment = std::move(named);
      continue;
    }
    split_fields(line.substr(0, line.find('#')), fields_);
    if (fields_.empty()) continue;
    layout_ = named_layout(line);
    if (layout_) return;
    const bool has_number = parse_number(fields_[0]).has_value();
    // A row with fewer columns than names is for the reader to refuse. Longer ones are of clouds of points.
    const bool lacks_columns =
        has_number && fields_.size() >= 3 && in_comment && in_comment->width > fields_.size();
    if (lacks_columns || (in_comment && in_comment->width == fields_.size())) layout_ = std::move(in_comment);
    at_first_row_ = layout_ || has_number;
    if (!at_first_row_) unknown_names_ = line;
    return;
  }
}

bool NamedTable::next_row() {
  if (std::exchange(at_first_row_, false)) return true;
  while (scan_.next_line()) {
    const std::string_view line = trimmed(scan_.whole_line());
    if (is_comment(line)) continue;
    split_fields(line.substr(0, line.find('#')), fields_);
    if (!fields_.empty()) return true;
  }
  return false;
}

bool NamedTable::has_numbers(std::size_t width, const std::array<std::size_t, 3>& columns) const {
  return fields_.size() == width && std::all_of(columns.begin(), columns.end(), [&](std::size_t k) {
           const std::optional<double> value = parse_number(fields_[k]);
           return value && std::isfinite(*value);
         });
}

}  // namespace astrolith
