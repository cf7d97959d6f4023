// Tables of numbers in text files whose columns have names: x, y and z, or latitude, longitude and radius.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/io/format_internal.h"
#include "geometry/io/text_scanner_internal.h"

namespace astrolith {

// What the names of a table's columns say.
struct TableLayout {
  std::array<std::size_t, 3> columns{0, 1, 2};  // of x, y, z, or of latitude, longitude and radius
  std::size_t width = 3;                        // columns of the table
  bool spherical = false;                       // latitude, longitude, radius
  bool west = false;                            // longitudes increase to the west
  double radians = 0.0;                         // of one unit of an angle
  std::string unknown;                          // the unit of an angle whose words are unknown; else empty
  std::string unit;                             // of lengths; empty where no name states one
  std::string words;                            // the columns that are taken and those left out
};

// The short form of a unit of lengths or angles in lower case, "km" for "kilometers"; empty for other
// words. Not all have a known length: numerics/length_unit.h.
std::string short_unit(std::string_view word);

// The layout that a line of names describes: x_km, x[m] or "x (km)"; lat or latitude, lon, west_longitude or
// "lon (deg W)", r or radius. The names may follow a colon. Empty where the line names no such columns.
std::optional<TableLayout> named_layout(std::string_view line);

// The place of latitude, longitude and radius, whose angles are in radians.
Vec3d spherical_point(double latitude, double longitude, double radius);

// Reads a table row by row. Fields are separated by commas, semicolons, tabs or blanks. The names stand in
// the first line, or in a comment before the first row. Throws InputError for angles in an unknown unit.
//   NamedTable table(file);
//   while (table.next_row()) x = table.number(table.layout()->columns[0], "x");
class NamedTable {
 public:
  explicit NamedTable(const MeshFile& file);

  // Empty where the file names no columns.
  const std::optional<TableLayout>& layout() const { return layout_; }
  // The first line where it holds no numbers and names no columns of a place.
  std::string_view unknown_names() const { return unknown_names_; }

  bool next_row();
  std::size_t width() const { return fields_.size(); }
  double number(std::size_t column, std::string_view what) const {
    return scan_.to_number(fields_[column], what);
  }
  // Whether the row has so many fields and these columns hold finite numbers.
  bool has_numbers(std::size_t width, const std::array<std::size_t, 3>& columns) const;
  [[noreturn]] void fail(std::string_view what, std::string_view remedy) const { scan_.fail(what, remedy); }

 private:
  void find_layout();

  TextScanner scan_;
  std::optional<TableLayout> layout_;
  std::string_view unknown_names_;
  std::vector<std::string_view> fields_;  // of the row
  bool at_first_row_ = false;             // which next_row() has not given yet
};

}  // namespace astrolith
