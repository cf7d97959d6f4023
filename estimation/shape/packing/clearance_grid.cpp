#include "estimation/shape/packing/clearance_grid.h"

#include <algorithm>
#include <cmath>

#include "geometry/mesh_measure.h"
#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

constexpr std::int32_t kUnknown = -1;

// What is known exactly of a cell at the surface.
struct Seed {
  Vec3f nearest;  // on the surface
  bool inside;
};

class GridBuilder {
 public:
  GridBuilder(const TriangleMesh& body, const SurfaceTree& tree, double inner_cells, double max_cells)
      : body_(body), tree_(tree) {
    const Box box = body.bounds();
    const Vec3d e = box.extent();
    const auto cells_along = [&](double length) { return std::ceil(length / grid_.step) + 3.0; };
    grid_.step = std::cbrt(volume(body) / inner_cells);
    while (cells_along(e.x) * cells_along(e.y) * cells_along(e.z) > max_cells) grid_.step *= 1.05;
    const auto along = [&](double length) { return static_cast<int>(cells_along(length)); };
    grid_.cells = {along(e.x), along(e.y), along(e.z)};
    const auto half = [&](int cells) { return 0.5 * grid_.step * (cells - 1); };
    grid_.origin = box.center() - Vec3d{half(grid_.cells[0]), half(grid_.cells[1]), half(grid_.cells[2])};
  }

  ClearanceGrid build() {
    mark_seeds();
    find_seeds();
    find_inside();
    // Two sweeps in each direction: the second pair improves only a thousandth of the cells.
    for (int pass = 0; pass < 2; ++pass) {
      sweep(1);
      sweep(-1);
    }
    measure();
    return std::move(grid_);
  }

 private:
  // Numbers the cells whose centre may lie within a step and a half of a triangle.
  void mark_seeds() {
    nearest_.assign(cell_count(), kUnknown);
    for (const Triangle& t : body_.triangles) {
      Box box;
      for (const std::uint32_t v : t) box.extend(body_.vertices[v]);
      const auto [lx, ly, lz] = cell_at(box.min, -1.0);
      const auto [hx, hy, hz] = cell_at(box.max, 1.0);
      for (int z = lz; z <= hz; ++z) {
        for (int y = ly; y <= hy; ++y) {
          for (int x = lx; x <= hx; ++x) {
            if (is_far(t, grid_.center(x, y, z))) continue;
            std::int32_t& number = nearest_[grid_.index(x, y, z)];
            if (number != kUnknown) continue;
            number = static_cast<std::int32_t>(seed_cells_.size());
            seed_cells_.push_back(grid_.index(x, y, z));
          }
        }
      }
    }
  }

  // Whether p is more than a step and a half from the triangle's plane.
  bool is_far(const Triangle& t, const Vec3d& p) const {
    const Vec3d& a = body_.vertices[t[0]];
    const Vec3d normal = cross(body_.vertices[t[1]] - a, body_.vertices[t[2]] - a);
    const double reach = 1.5 * grid_.step * norm(normal);
    return std::abs(dot(p - a, normal)) > reach && reach > 0.0;
  }

  void find_seeds() {
    seeds_.resize(seed_cells_.size());
    parallel_for(
        0, static_cast<std::int64_t>(seeds_.size()),
        [&](std::int64_t i) {
          const auto s = static_cast<std::size_t>(i);
          const Vec3d center = grid_.center(seed_cells_[s]);
          const Vec3d p = tree_.closest(center).point;
          seeds_[s] = {to_float(p), tree_.signed_distance(center) > 0.0};
        },
        256);
  }

  // Marks the cells inside the body. A row crosses the surface only at seeds, so the cells between two seeds
  // are on the side of the first.
  void find_inside() {
    inside_.assign(cell_count(), false);
    std::size_t i = 0;
    for (int row = 0; row < grid_.cells[1] * grid_.cells[2]; ++row) {
      bool inside = false;
      for (int x = 0; x < grid_.cells[0]; ++x, ++i) {
        if (nearest_[i] != kUnknown) inside = seeds_[static_cast<std::size_t>(nearest_[i])].inside;
        inside_[i] = inside;
      }
    }
  }

  // A raster scan. Every cell inside takes over the nearest point of the 13 neighbours that the scan has
  // already passed.
  void sweep(int direction) {
    const auto [nx, ny, nz] = grid_.cells;
    const auto from = [&](int n) { return direction > 0 ? 1 : n - 2; };
    for (int z = from(nz); z > 0 && z < nz - 1; z += direction) {
      for (int y = from(ny); y > 0 && y < ny - 1; y += direction) {
        for (int x = from(nx); x > 0 && x < nx - 1; x += direction) {
          if (inside_[grid_.index(x, y, z)]) take_over(x, y, z, direction);
        }
      }
    }
  }

  void take_over(int x, int y, int z, int direction) {
    const std::size_t cell = grid_.index(x, y, z);
    const std::ptrdiff_t row = grid_.cells[0], plane = row * grid_.cells[1];
    const Vec3d p = grid_.center(x, y, z);
    const Vec3f center = to_float(p);
    std::int32_t best = nearest_[cell];
    float best_distance = best == kUnknown ? INFINITY : distance2(best, center);
    const auto look = [&](std::ptrdiff_t offset) {
      const std::int32_t other =
          nearest_[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(cell) - direction * offset)];
      if (other == best || other == kUnknown) return;
      const float distance = distance2(other, center);
      if (distance < best_distance) {
        best = other;
        best_distance = distance;
      }
    };
    for (std::ptrdiff_t dy = -1; dy <= 1; ++dy) {
      for (std::ptrdiff_t dx = -1; dx <= 1; ++dx) look(plane + dy * row + dx);
    }
    for (std::ptrdiff_t dx = -1; dx <= 1; ++dx) look(row + dx);
    look(1);
    nearest_[cell] = best;
  }

  float distance2(std::int32_t seed, const Vec3f& p) const {
    return squared_norm(seeds_[static_cast<std::size_t>(seed)].nearest - p);
  }

  void measure() {
    grid_.clearance.assign(cell_count(), 0.0f);
    for (std::size_t i = 0; i < grid_.clearance.size(); ++i) {
      if (!inside_[i] || nearest_[i] == kUnknown) continue;
      const Vec3d p = grid_.center(i);
      grid_.clearance[i] = std::sqrt(distance2(nearest_[i], to_float(p)));
    }
  }

  std::array<int, 3> cell_at(const Vec3d& p, double margin) const {
    const Vec3d q = (p - grid_.origin) * (1.0 / grid_.step);
    const auto at = [margin](double v, int cells) {
      return std::clamp(static_cast<int>(std::round(v + margin)), 0, cells - 1);
    };
    return {at(q.x, grid_.cells[0]), at(q.y, grid_.cells[1]), at(q.z, grid_.cells[2])};
  }

  std::size_t cell_count() const { return grid_.index(0, 0, grid_.cells[2]); }

  const TriangleMesh& body_;
  const SurfaceTree& tree_;
  ClearanceGrid grid_;
  std::vector<std::int32_t> nearest_;  // for each cell the seed whose surface point is nearest so far
  std::vector<std::size_t> seed_cells_;
  std::vector<Seed> seeds_;
  std::vector<bool> inside_;
};

}  // namespace

Vec3d ClearanceGrid::center(std::size_t index) const {
  const auto nx = static_cast<std::size_t>(cells[0]), ny = static_cast<std::size_t>(cells[1]);
  return center(static_cast<int>(index % nx), static_cast<int>(index / nx % ny),
                static_cast<int>(index / (nx * ny)));
}

ClearanceGrid make_clearance_grid(const TriangleMesh& body, const SurfaceTree& tree, double inner_cells,
                                  double max_cells) {
  return GridBuilder(body, tree, inner_cells, max_cells).build();
}

}  // namespace astrolith
