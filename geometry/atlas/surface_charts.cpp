#include "geometry/atlas/surface_charts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>
#include <unordered_map>
#include <utility>

#include "geometry/mesh_edges.h"
#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

constexpr std::uint32_t kNoTriangle = 0xffffffff, kNoChart = 0xffffffff;

using FaceNeighbours = std::vector<std::array<std::uint32_t, 3>>;  // (#F) across each side, or kNoTriangle

FaceNeighbours face_neighbours(const TriangleMesh& mesh) {
  FaceNeighbours neighbours(mesh.triangles.size(), {kNoTriangle, kNoTriangle, kNoTriangle});
  for_each_edge(sorted_sides(mesh), [&](std::span<const TriangleSide> sides) {
    if (sides.size() != 2) return;
    neighbours[sides[0].triangle][sides[0].corner] = sides[1].triangle;
    neighbours[sides[1].triangle][sides[1].corner] = sides[0].triangle;
  });
  return neighbours;
}

// Twice the area of each triangle times its normal.
std::vector<Vec3d> area_vectors(const TriangleMesh& mesh) {
  std::vector<Vec3d> areas;
  areas.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    const Vec3d& a = mesh.vertices[t[0]];
    areas.push_back(cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a));
  }
  return areas;
}

// Sums over neighbours, sweep after sweep: what the surface around a triangle faces.
std::vector<Vec3d> smoothed_areas(std::vector<Vec3d> areas, const FaceNeighbours& neighbours) {
  constexpr int kSweeps = 12;
  std::vector<Vec3d> sums(areas.size());
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    parallel_for(
        0, static_cast<std::int64_t>(areas.size()),
        [&](std::int64_t i) {
          const auto f = static_cast<std::size_t>(i);
          sums[f] = areas[f];
          for (const std::uint32_t n : neighbours[f]) {
            if (n != kNoTriangle) sums[f] += areas[n];
          }
          sums[f] *= 0.25;
        },
        4096);
    std::swap(areas, sums);
  }
  return areas;
}

// The choice of an axis for each triangle.
class AxisChoice {
 public:
  AxisChoice(const TriangleMesh& mesh, const FaceNeighbours& neighbours)
      : neighbours_(neighbours), normals_(area_vectors(mesh)), around_(smoothed_areas(normals_, neighbours)) {
    for (Vec3d& n : normals_) n = normalized(n);
    for (Vec3d& n : around_) n = normalized(n);
    axis_.resize(normals_.size());
  }

  std::vector<std::uint8_t> result() {
    constexpr int kSweeps = 8, kRounds = 3;
    for (std::size_t f = 0; f < axis_.size(); ++f) axis_[f] = best_axis(f, false);
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      for (std::size_t f = 0; f < axis_.size(); ++f) axis_[f] = best_axis(f, true);
    }
    for (int round = 0; round < kRounds; ++round) dissolve_small_parts();
    return std::move(axis_);
  }

 private:
  bool may_have(std::size_t f, std::size_t axis) const {
    return !(squared_norm(normals_[f]) > 0.0) || dot(normals_[f], kChartAxes[axis].out) >= kLeastChartCosine;
  }

  // What an axis costs a triangle: the cosine that it lacks, and the length of the border that it makes.
  double cost(std::size_t f, std::size_t axis, bool with_neighbours) const {
    constexpr double kBorder = 0.3;  // of a side, in cosines
    double sum = 1.0 - dot(around_[f], kChartAxes[axis].out);
    if (!with_neighbours) return sum;
    for (const std::uint32_t n : neighbours_[f]) {
      if (n != kNoTriangle && axis_[n] != axis) sum += kBorder;
    }
    return sum;
  }

  std::uint8_t best_axis(std::size_t f, bool with_neighbours) const {
    std::size_t best = kChartAxes.size();
    double least = 1e300;
    for (std::size_t axis = 0; axis < kChartAxes.size(); ++axis) {
      if (!may_have(f, axis)) continue;
      const double c = cost(f, axis, with_neighbours);
      if (c < least) least = c, best = axis;
    }
    return static_cast<std::uint8_t>(best);
  }

  // Parts of few triangles take the axis of a neighbour, where all of their triangles may have it.
  void dissolve_small_parts() {
    constexpr std::size_t kFew = 64;
    std::vector<bool> seen(axis_.size());
    std::vector<std::uint32_t> part;
    for (std::uint32_t f = 0; f < axis_.size(); ++f) {
      if (seen[f]) continue;
      part.assign(1, f);
      seen[f] = true;
      for (std::size_t k = 0; k < part.size(); ++k) {
        for (const std::uint32_t n : neighbours_[part[k]]) {
          if (n == kNoTriangle || seen[n] || axis_[n] != axis_[f]) continue;
          seen[n] = true;
          part.push_back(n);
        }
      }
      if (part.size() <= kFew) dissolve(part);
    }
  }

  void dissolve(const std::vector<std::uint32_t>& part) {
    std::array<int, kChartAxes.size()> sides{};  // of neighbours, by their axis
    for (const std::uint32_t f : part) {
      for (const std::uint32_t n : neighbours_[f]) {
        if (n != kNoTriangle) ++sides[axis_[n]];
      }
    }
    const std::uint8_t own = axis_[part.front()];
    std::size_t best = own;
    for (std::size_t axis = 0; axis < sides.size(); ++axis) {
      const auto may = [&](std::uint32_t f) { return may_have(f, axis); };
      if (axis == own || sides[axis] == 0 || !std::all_of(part.begin(), part.end(), may)) continue;
      if (best == own || sides[axis] > sides[best]) best = axis;
    }
    for (const std::uint32_t f : part) axis_[f] = static_cast<std::uint8_t>(best);
  }

  const FaceNeighbours& neighbours_;
  std::vector<Vec3d> normals_, around_;
  std::vector<std::uint8_t> axis_;
};

struct FlatPoint {
  double x, y;
};
using FlatTriangle = std::array<FlatPoint, 3>;

// Whether all corners of `other` lie to the right of a side of `t`, or on it.
bool has_dividing_side(const FlatTriangle& t, const FlatTriangle& other) {
  for (std::size_t k = 0; k < 3; ++k) {
    const FlatPoint &a = t[k], &b = t[(k + 1) % 3];
    const auto is_beyond = [&](const FlatPoint& p) {
      return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x) <= 0.0;
    };
    if (std::all_of(other.begin(), other.end(), is_beyond)) return true;
  }
  return false;
}

// Whether two triangles, both counter-clockwise, share more than points of their borders. Corners that they
// share are the same numbers, so that neighbours are told apart exactly.
bool overlap(const FlatTriangle& a, const FlatTriangle& b) {
  return !has_dividing_side(a, b) && !has_dividing_side(b, a);
}

// The triangles of a chart in its plane, found by cells.
class FlatChart {
 public:
  explicit FlatChart(double cell) : per_length_(cell > 0.0 ? 1.0 / cell : 1.0) {}

  // Adds a triangle unless it overlaps one that is there.
  bool add(const FlatTriangle& t) {
    const auto [x0, x1] = std::minmax({t[0].x, t[1].x, t[2].x});
    const auto [y0, y1] = std::minmax({t[0].y, t[1].y, t[2].y});
    const std::int64_t i0 = cell_at(x0), i1 = cell_at(x1), j0 = cell_at(y0), j1 = cell_at(y1);
    for (std::int64_t i = i0; i <= i1; ++i) {
      for (std::int64_t j = j0; j <= j1; ++j) {
        const auto found = cells_.find(key(i, j));
        if (found == cells_.end()) continue;
        for (const std::uint32_t other : found->second) {
          if (overlap(t, triangles_[other])) return false;
        }
      }
    }
    const auto number = static_cast<std::uint32_t>(triangles_.size());
    triangles_.push_back(t);
    for (std::int64_t i = i0; i <= i1; ++i) {
      for (std::int64_t j = j0; j <= j1; ++j) cells_[key(i, j)].push_back(number);
    }
    return true;
  }

 private:
  std::int64_t cell_at(double x) const { return static_cast<std::int64_t>(std::floor(x * per_length_)); }
  static std::uint64_t key(std::int64_t i, std::int64_t j) {
    return static_cast<std::uint64_t>(i) * 0x100000001ull + static_cast<std::uint64_t>(j);
  }

  double per_length_;
  std::vector<FlatTriangle> triangles_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
};

FlatTriangle projected(const TriangleMesh& mesh, const Triangle& t, const ChartAxis& axis) {
  FlatTriangle flat{};
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3d& p = mesh.vertices[t[k]];
    flat[k] = {dot(p, axis.right), dot(p, axis.up)};
  }
  return flat;
}

// Twice the mean edge of the mesh's triangles, about.
double chart_cell(const TriangleMesh& mesh) {
  double area = 0.0;
  for (const Vec3d& a : area_vectors(mesh)) area += norm(a);
  return 2.0 * std::sqrt(area / static_cast<double>(mesh.triangles.size()));
}

}  // namespace

SurfaceCharts surface_charts(const TriangleMesh& mesh) {
  const FaceNeighbours neighbours = face_neighbours(mesh);
  const std::vector<std::uint8_t> axis = AxisChoice(mesh, neighbours).result();
  const double cell = chart_cell(mesh);
  SurfaceCharts charts{std::vector(mesh.triangles.size(), kNoChart), {}};
  for (std::uint32_t first = 0; first < mesh.triangles.size(); ++first) {
    if (charts.triangle_chart[first] != kNoChart) continue;
    const auto number = static_cast<std::uint32_t>(charts.chart_axis.size());
    charts.chart_axis.push_back(axis[first]);
    FlatChart flat(cell);
    std::deque<std::uint32_t> front{first};
    while (!front.empty()) {
      const std::uint32_t f = front.front();
      front.pop_front();
      if (charts.triangle_chart[f] != kNoChart || axis[f] != axis[first]) continue;
      if (!flat.add(projected(mesh, mesh.triangles[f], kChartAxes[axis[f]]))) continue;
      charts.triangle_chart[f] = number;
      for (const std::uint32_t n : neighbours[f]) {
        if (n != kNoTriangle) front.push_back(n);
      }
    }
  }
  return charts;
}

}  // namespace astrolith
