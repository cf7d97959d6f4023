#include <algorithm>
#include <cmath>
#include <iterator>

#include "geometry/io/named_table_internal.h"
#include "numerics/length_unit.h"

namespace astrolith {
namespace {

constexpr double kLargestPlace = 1e18;

TableLayout require_layout(const NamedTable& table, bool cloud) {
  if (table.layout()) return *table.layout();
  if (!table.unknown_names().empty()) {
    table.fail("the first line " + quoted(table.unknown_names()) +
                   " names no x, y, z and no latitude, longitude, radius",
               "name the columns so, such as id,x_km,y_km,z_km, or give lines of x y z");
  }
  TableLayout layout;
  // Clouds of points have normals or colours behind their coordinates, and no names.
  layout.width = cloud ? 0 : 3;
  return layout;
}

// What a length of the table is to be multiplied with.
double scale_to(const TableLayout& layout, std::string_view unit, const NamedTable& table) {
  if (layout.unit.empty()) return 1.0;
  if (!has_known_length(layout.unit))
    table.fail("the columns state lengths in " + astrolith::quoted(layout.unit), "convert them to m or km");
  return unit.empty() ? 1.0 : metres_per_unit(layout.unit) / metres_per_unit(unit);
}

void require_width(const NamedTable& table, const TableLayout& layout) {
  if (table.width() == layout.width || (layout.width == 0 && table.width() >= 3)) return;
  const bool named = !layout.words.empty();
  table.fail("has " + std::to_string(table.width()) + " columns where " +
                 std::to_string(layout.width == 0 ? 3 : layout.width) +
                 (named ? " are named" : " (x, y, z) are due"),
             named               ? "complete the line or correct the names"
             : table.width() < 3 ? "complete the line"
                                 : "name the columns in a first line, such as id,x,y,z");
}

Vec3d place_in(const NamedTable& table, const TableLayout& layout) {
  const auto& [first, second, third] = layout.columns;
  if (!layout.spherical) {
    const double x = table.number(first, "x"), y = table.number(second, "y"), z = table.number(third, "z");
    return {x, y, z};
  }
  const double latitude = layout.radians * table.number(first, "latitude"),
               longitude = layout.radians * table.number(second, "longitude");
  if (std::fabs(latitude) > 1.5707963267949) table.fail("the latitude is beyond a pole", "correct the line");
  return spherical_point(latitude, layout.west ? -longitude : longitude, table.number(third, "radius"));
}

PointTable read_table(const MeshFile& content, std::string_view unit, bool cloud) {
  refuse_other_kinds(content, "give lines of x, y and z");
  NamedTable table(content);
  const TableLayout layout = require_layout(table, cloud);
  const double scale = scale_to(layout, unit, table);
  PointTable points{{}, layout.words};
  std::size_t counting = 0;  // rows that begin with their number, from 0 or 1
  for (std::size_t rows = 0; table.next_row(); ++rows) {
    // The number of points, in front of them.
    if (cloud && rows == 0 && table.width() == 1) continue;
    require_width(table, layout);
    const Vec3d p = scale * place_in(table, layout);
    for (const double c : {p.x, p.y, p.z}) {
      if (!(std::fabs(c) <= kLargestPlace))
        table.fail("a coordinate is beyond 1e18", "state lengths in a larger unit");
    }
    points.points.push_back(p);
    const auto number = static_cast<double>(points.points.size());
    counting += layout.width == 0 && table.width() > 3 && (p.x == number || p.x == number - 1.0);
  }
  if (points.points.empty()) content.fail("", "holds no points", "give lines of x, y and z");
  if (counting > 1 && counting == points.points.size())
    content.fail("", "the first of its columns counts the lines",
                 "name the columns in a first line, such as id,x,y,z");
  return points;
}

// Endings of clouds of points in text.
constexpr std::string_view kCloudExtensions[] = {".xyz", ".pts", ".asc", ".xyzn", ".xyzrgb"};

}  // namespace

bool holds_points(const std::filesystem::path& file) {
  const std::string extension = mesh_extension(file);
  return std::find(std::begin(kCloudExtensions), std::end(kCloudExtensions), extension) !=
         std::end(kCloudExtensions);
}

PointTable read_point_table(const std::filesystem::path& file, std::string_view unit) {
  return read_table(load_mesh_file(file), unit, mesh_extension(file) == ".xyz");
}

std::vector<Vec3d> read_points(const std::filesystem::path& file) {
  return read_table(load_mesh_file(file), "", true).points;
}

TriangleMesh read_cloud(const std::filesystem::path& file) {
  const MeshFile content = load_mesh_file(file);
  const bool table = holds_points(file) || (!has_readable_extension(file) && !looks_like_mesh(content));
  return table ? TriangleMesh{read_table(content, "", true).points, {}, {}} : read_any(content);
}

}  // namespace astrolith
