// Tables of latitude, longitude and radius on a regular grid, as the Planetary Data System has them: with or
// without rows at the poles, with one or all longitudes there, and with longitude 360 beside 0 or not.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "geometry/io/named_table_internal.h"
#include "geometry/io/pds_label_internal.h"

namespace astrolith {
namespace {

constexpr double kStepSlack = 1e-3;  // of a step: tables print few digits

struct Row {
  double latitude, longitude, radius;  // degrees
};

// Rings of radii from the south to the north, each of equal steps of longitude.
struct Grid {
  std::vector<double> latitudes, longitudes;  // degrees, ascending; without the poles
  std::vector<double> radii;                  // of each latitude's longitudes
  double south = 0.0, north = 0.0;            // radii at the poles
};

std::vector<double> distinct(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

bool is_regular(const std::vector<double>& values, double step) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!(std::fabs(values[i] - values[0] - static_cast<double>(i) * step) <= kStepSlack * step))
      return false;
  }
  return true;
}

double grid_step(const std::vector<double>& values) {
  return (values.back() - values.front()) / static_cast<double>(values.size() - 1);
}

bool at_pole(const Row& row) { return std::fabs(row.latitude) > 90.0 - 1e-6; }

// The mean radius of the rows at a pole, or of the ring next to it where no row is.
double pole_radius(const std::vector<Row>& rows, double sign, const double* ring, std::size_t ring_size) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const Row& row : rows) {
    if (!at_pole(row) || row.latitude * sign < 0.0) continue;
    sum += row.radius;
    ++count;
  }
  if (count > 0) return sum / static_cast<double>(count);
  for (std::size_t i = 0; i < ring_size; ++i) sum += ring[i];
  return sum / static_cast<double>(ring_size);
}

// Fills the radii of the rows between the poles. False where a place is missing or stands there twice.
bool fill(Grid& grid, const std::vector<Row>& rows, double seam) {
  const std::size_t around = grid.longitudes.size();
  if (rows.size() < grid.latitudes.size() * around) return false;  // before memory for places is taken
  grid.radii.assign(grid.latitudes.size() * around, 0.0);
  std::size_t filled = 0;
  const auto place = [](const std::vector<double>& values, double value) {
    return static_cast<std::size_t>(std::lower_bound(values.begin(), values.end(), value) - values.begin());
  };
  for (const Row& row : rows) {
    if (at_pole(row) || row.longitude == seam) continue;
    double& radius =
        grid.radii[place(grid.latitudes, row.latitude) * around + place(grid.longitudes, row.longitude)];
    if (radius != 0.0) return false;
    radius = row.radius;
    ++filled;
  }
  return filled == grid.radii.size();
}

// The grid of the rows; empty where they are none, or end before the poles.
std::optional<Grid> find_grid(const std::vector<Row>& rows) {
  Grid grid;
  for (const Row& row : rows) {
    if (std::fabs(row.latitude) > 90.0 + 1e-6 || !(row.radius > 0.0)) return {};
    if (at_pole(row)) continue;
    grid.latitudes.push_back(row.latitude);
    grid.longitudes.push_back(row.longitude);
  }
  grid.latitudes = distinct(std::move(grid.latitudes));
  grid.longitudes = distinct(std::move(grid.longitudes));
  if (grid.latitudes.size() < 2 || grid.longitudes.size() < 3) return {};
  double seam = HUGE_VAL;
  if (grid.longitudes.back() - grid.longitudes.front() >= 360.0 - kStepSlack) {
    seam = grid.longitudes.back();
    grid.longitudes.pop_back();
  }
  const double up = grid_step(grid.latitudes), along = 360.0 / static_cast<double>(grid.longitudes.size());
  if (!is_regular(grid.latitudes, up) || !is_regular(grid.longitudes, along)) return {};
  const double reach = (1.0 + kStepSlack) * up;
  if (grid.latitudes.front() - reach > -90.0 || grid.latitudes.back() + reach < 90.0) return {};
  if (!fill(grid, rows, seam)) return {};
  const std::size_t around = grid.longitudes.size();
  grid.south = pole_radius(rows, -1.0, grid.radii.data(), around);
  grid.north = pole_radius(rows, 1.0, grid.radii.data() + grid.radii.size() - around, around);
  return grid;
}

// Latitudes beyond the poles tell a first column of longitudes.
void swap_angles_if_longitudes_come_first(std::vector<Row>& rows) {
  if (std::none_of(rows.begin(), rows.end(),
                   [](const Row& row) { return std::fabs(row.latitude) > 90.0 + 1e-6; }))
    return;
  for (Row& row : rows) std::swap(row.latitude, row.longitude);
}

// The rows of a table without names of columns whose first three are numbers; none where it is no such table.
std::vector<Row> unnamed_rows(NamedTable& table) {
  std::vector<Row> rows;
  std::size_t width = 0;
  while (table.next_row()) {
    if (rows.empty()) width = table.width();
    if (width < 3 || !table.has_numbers(width, {0, 1, 2})) return {};
    rows.push_back({table.number(0, "latitude"), table.number(1, "longitude"), table.number(2, "radius")});
  }
  swap_angles_if_longitudes_come_first(rows);
  return rows;
}

std::vector<Row> named_rows(NamedTable& table, const TableLayout& layout) {
  std::vector<Row> rows;
  const double degrees = layout.radians * 180.0 / std::numbers::pi;
  while (table.next_row()) {
    if (table.width() != layout.width) {
      table.fail("has " + std::to_string(table.width()) + " columns where " + std::to_string(layout.width) +
                     " are named",
                 "complete the line or correct the names");
    }
    rows.push_back({degrees * table.number(layout.columns[0], "latitude"),
                    (layout.west ? -degrees : degrees) * table.number(layout.columns[1], "longitude"),
                    table.number(layout.columns[2], "radius")});
  }
  return rows;
}

TriangleMesh grid_mesh(const Grid& grid) {
  constexpr double kRadians = std::numbers::pi / 180.0;
  TriangleMesh mesh;
  const auto around = static_cast<std::uint32_t>(grid.longitudes.size()),
             rings = static_cast<std::uint32_t>(grid.latitudes.size());
  for (std::uint32_t j = 0; j < rings; ++j) {
    for (std::uint32_t i = 0; i < around; ++i) {
      mesh.vertices.push_back(spherical_point(kRadians * grid.latitudes[j], kRadians * grid.longitudes[i],
                                              grid.radii[std::size_t{j} * around + i]));
    }
  }
  const std::uint32_t south = rings * around, north = south + 1, last = south - around;
  mesh.vertices.push_back({0, 0, -grid.south});
  mesh.vertices.push_back({0, 0, grid.north});
  for (std::uint32_t i = 0; i < around; ++i) {
    const std::uint32_t next = (i + 1) % around;
    mesh.triangles.push_back({south, next, i});
    for (std::uint32_t row = 0; row < last; row += around) {
      append_quad(mesh.vertices, {row + i, row + next, row + around + next, row + around + i},
                  mesh.triangles);
    }
    mesh.triangles.push_back({north, last + i, last + next});
  }
  return mesh;
}

}  // namespace

bool is_grid_table(const MeshFile& file) {
  NamedTable table(file);
  if (table.layout()) return table.layout()->spherical;
  return table.unknown_names().empty() && find_grid(unnamed_rows(table)).has_value();
}

TriangleMesh read_grid_table(const MeshFile& file) {
  NamedTable table(file);
  std::vector<Row> rows = table.layout() ? named_rows(table, *table.layout()) : unnamed_rows(table);
  const bool named_west = table.layout() && table.layout()->west;
  if (!named_west && says_west(file.label.empty() ? label_beside(file.path).text : file.label)) {
    for (Row& row : rows) row.longitude = -row.longitude;
  }
  const std::optional<Grid> grid = find_grid(rows);
  if (!grid) {
    file.fail("",
              "its latitudes and longitudes make no regular grid from pole to pole with a radius everywhere",
              "fill the grid, or give a mesh");
  }
  if (grid->radii.size() >= static_cast<std::size_t>(kMaxVertices) - 2)
    file.fail("", "has more places than 2^32", "give fewer");
  return grid_mesh(*grid);
}

}  // namespace astrolith
