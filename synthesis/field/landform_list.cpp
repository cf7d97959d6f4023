#include "synthesis/field/landform_list.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "numerics/files/output_file.h"
#include "numerics/parallel_for.h"
#include "synthesis/field/bare_body.h"
#include "synthesis/field/listed_landforms.h"
#include "synthesis/field/surface_crossing.h"

namespace astrolith {
namespace {

constexpr std::array kNumbers = {"x",        "y",        "z",        "mesh_x",   "mesh_y", "mesh_z",
                                 "center_x", "center_y", "center_z", "diameter", "depth",  "rim_height",
                                 "age",      "axis_b",   "axis_c",   "heading",  "tilt",   "burial"};
constexpr std::size_t kSurfaceColumn = 0, kMeshColumn = 3, kCenterColumn = 6, kFirstSizeColumn = 9;

using Numbers = std::array<std::optional<double>, kNumbers.size()>;  // absent where the kind has none

struct Row {
  int layer;
  std::string kind;
  Numbers numbers;
  bool resolved;  // by the mesh
  double top;     // the surface is looked for about this height above the centre ...
  double reach;   // ... and so far from there, length units
};

void set_point(Numbers& numbers, std::size_t column, const Vec3d& p) {
  numbers[column] = p.x;
  numbers[column + 1] = p.y;
  numbers[column + 2] = p.z;
}

Vec3d center_of(const Row& row) {
  return {*row.numbers[kCenterColumn], *row.numbers[kCenterColumn + 1], *row.numbers[kCenterColumn + 2]};
}

Row crater_row(int layer, const PlacedCrater& c, double height_bound) {
  Row row{layer, c.complex ? "complex crater" : "simple crater", {}, false, 0.0, height_bound};
  set_point(row.numbers, kCenterColumn, c.position);
  const std::array sizes{c.diameter, c.depth, c.rim_height, c.age};
  std::copy(sizes.begin(), sizes.end(), row.numbers.begin() + kFirstSizeColumn);
  return row;
}

// Half the boulder's extent along a unit vector, as if it were an ellipsoid.
double half_extent(const PlacedBoulder& b, const Vec3d& direction) {
  double square = 0.0;
  const std::array axes{b.axes.x, b.axes.y, b.axes.z};
  for (std::size_t k = 0; k < 3; ++k) {
    const double part = 0.5 * axes[k] * dot(b.directions[k], direction);
    square += part * part;
  }
  return std::sqrt(square);
}

Row boulder_row(int layer, const PlacedBoulder& b, const BareSurface& bare) {
  const double top = half_extent(b, bare.normal(b.center));
  Row row{layer, "boulder", {}, false, top, top};
  set_point(row.numbers, kCenterColumn, b.center);
  const std::array<std::optional<double>, 9> sizes{b.axes.x, {},        {},     {},      b.axes.y,
                                                   b.axes.z, b.heading, b.tilt, b.burial};
  std::copy(sizes.begin(), sizes.end(), row.numbers.begin() + kFirstSizeColumn);
  return row;
}

std::vector<Row> rows_of(const ImplicitField& field, const BareSurface& bare,
                         const std::optional<PatchCube>& patch, double cell) {
  std::vector<Row> rows;
  for (const ListedLandform& listed : listed_landforms(field, patch)) {
    rows.push_back(listed.crater != nullptr ? crater_row(listed.layer, *listed.crater, field.height_bound())
                                            : boulder_row(listed.layer, *listed.boulder, bare));
    rows.back().resolved = is_resolved(listed, cell);
  }
  return rows;
}

void find_surface_points(const ImplicitField& field, const BareSurface& bare, const Vec3d& origin,
                         std::vector<Row>& rows) {
  parallel_for(
      0, static_cast<std::int64_t>(rows.size()),
      [&](std::int64_t i) {
        Row& row = rows[static_cast<std::size_t>(i)];
        const Vec3d center = center_of(row), normal = bare.normal(center);
        const auto point = nearest_crossing(field, center + row.top * normal, normal, row.reach);
        if (!point) return;
        set_point(row.numbers, kSurfaceColumn, *point);
        set_point(row.numbers, kMeshColumn, *point - origin);
      },
      16);
}

std::string text_of(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string csv_of(const std::vector<Row>& rows, const Recipe& recipe) {
  std::string text = "layer,kind";
  for (const char* column : kNumbers) text += std::string(",") + column;
  text += ",length_unit,resolved";
  for (const Row& row : rows) {
    text += '\n' + std::to_string(row.layer) + ',' + row.kind;
    for (const auto& number : row.numbers) text += ',' + (number ? text_of(*number) : "");
    text += ',' + recipe.length_unit + (row.resolved ? ",1" : ",0");
  }
  return text + '\n';
}

std::string json_of(const std::vector<Row>& rows, const Recipe& recipe, const Vec3d& origin) {
  const auto quoted = [](const std::string& text) { return nlohmann::json(text).dump(); };
  std::string text = "{\n  \"length_unit\": " + quoted(recipe.length_unit) +
                     ",\n  \"frame\": " + quoted(recipe.frame) + ",\n  \"origin\": [" + text_of(origin.x) +
                     ", " + text_of(origin.y) + ", " + text_of(origin.z) + "],\n  \"features\": [";
  const char* separator = "\n";
  for (const Row& row : rows) {
    text += std::string(separator) + "    {\"layer\": " + std::to_string(row.layer) + ", \"kind\": \"" +
            row.kind + '"';
    for (std::size_t k = 0; k < kNumbers.size(); ++k) {
      if (row.numbers[k]) text += std::string(", \"") + kNumbers[k] + "\": " + text_of(*row.numbers[k]);
    }
    text += row.resolved ? ", \"resolved\": true}" : ", \"resolved\": false}";
    separator = ",\n";
  }
  return text + "\n  ]\n}\n";
}

}  // namespace

void write_landform_list(const ImplicitField& field, const Recipe& recipe,
                         const std::optional<PatchCube>& patch, double cell,
                         const std::filesystem::path& file) {
  const BareSurface bare(bare_body(recipe));
  const Vec3d origin = patch ? patch->center : Vec3d{};
  std::vector<Row> rows = rows_of(field, bare, patch, cell);
  find_surface_points(field, bare, origin, rows);
  write_file(file, file.extension() == ".json" ? json_of(rows, recipe, origin) : csv_of(rows, recipe));
}

}  // namespace astrolith
