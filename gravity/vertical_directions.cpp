#include "gravity/vertical_directions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <unordered_map>

#include "geometry/mesh_measure.h"
#include "gravity/body_mass.h"
#include "gravity/polyhedron_gravity.h"
#include "gravity/surface_gravity.h"

namespace astrolith {
namespace {

// The cells that hold vertices, numbered as they are met.
class CellNumbers {
 public:
  CellNumbers(const Box& bounds, int cells) : low_(bounds.min) {
    const Vec3d e = bounds.extent();
    const double longest = std::max({e.x, e.y, e.z});
    per_unit_ = longest > 0.0 ? cells / longest : 0.0;
  }

  std::uint32_t of(const Vec3d& p) {
    const Vec3d at = per_unit_ * (p - low_);
    const auto x = static_cast<std::uint64_t>(at.x), y = static_cast<std::uint64_t>(at.y),
               z = static_cast<std::uint64_t>(at.z);
    const auto next = static_cast<std::uint32_t>(numbers_.size());
    return numbers_.try_emplace(x << 42 | y << 21 | z, next).first->second;
  }

 private:
  Vec3d low_;
  double per_unit_;
  std::unordered_map<std::uint64_t, std::uint32_t> numbers_;
};

constexpr int kFewestCells = 48, kMostCells = 384;  // along the longest side
constexpr double kVolumeError = 0.03;               // relative; a thin body needs more cells
constexpr GravityDetail kRoughDetail{3, 12};
// Neighbours on a plane say nothing about the change across it. This share of the whole weight keeps that
// change at zero.
constexpr double kDamping = 0.02;

CoarseSurface coarse_body(const TriangleMesh& mesh) {
  const double wanted = volume(mesh);
  for (int cells = kFewestCells;; cells *= 2) {
    CoarseSurface coarse = coarse_surface(mesh, cells);
    const bool right = std::fabs(volume(coarse.mesh) - wanted) <= kVolumeError * std::fabs(wanted);
    if (right || cells >= kMostCells) return coarse;
  }
}

// The normal equations of the gradient at one vertex: sums over neighbours at distance d of d d^T / d^2 and
// of (change of acceleration) d^T / d^2.
struct GradientSums {
  Matrix3 spread{}, change{};
};

void add_neighbour(const Vec3d& d, const Vec3d& change, GradientSums& sums) {
  const double square = squared_norm(d), weight = square > 0.0 ? 1.0 / square : 0.0;
  const std::array<double, 3> along{d.x, d.y, d.z}, by{change.x, change.y, change.z};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      sums.spread[i][k] += weight * along[i] * along[k];
      sums.change[i][k] += weight * by[i] * along[k];
    }
  }
}

std::vector<GradientSums> gradient_sums(const TriangleMesh& mesh, std::span<const Attraction> values) {
  std::vector<GradientSums> sums(mesh.vertices.size());
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      const Vec3d d = mesh.vertices[b] - mesh.vertices[a];
      const Vec3d change = values[b].acceleration - values[a].acceleration;
      add_neighbour(d, change, sums[a]);
      add_neighbour(d, change, sums[b]);
    }
  }
  return sums;
}

using Rows = std::array<Vec3d, 3>;

// change * (spread + damping)^-1; zero for a vertex without neighbours.
Rows solve_gradient(const GradientSums& sums) {
  const Matrix3& s = sums.spread;
  const double damping = kDamping * (s[0][0] + s[1][1] + s[2][2]);
  const Vec3d a{s[0][0] + damping, s[0][1], s[0][2]}, b{s[1][0], s[1][1] + damping, s[1][2]},
      c{s[2][0], s[2][1], s[2][2] + damping};
  const Vec3d bc = cross(b, c), ca = cross(c, a), ab = cross(a, b);
  const double determinant = dot(a, bc);
  if (!(determinant > 0.0)) return {};
  Rows rows;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::array<double, 3>& by = sums.change[i];
    rows[i] = (by[0] * bc + by[1] * ca + by[2] * ab) * (1.0 / determinant);
  }
  return rows;
}

// Accelerations at the vertices of the mesh, for G times density = 1.
std::vector<Vec3d> continued(const TriangleMesh& mesh, const CoarseSurface& coarse,
                             std::span<const Attraction> values) {
  const std::vector<GradientSums> sums = gradient_sums(coarse.mesh, values);
  std::vector<Rows> gradients;
  gradients.reserve(sums.size());
  for (const GradientSums& s : sums) gradients.push_back(solve_gradient(s));
  std::vector<Vec3d> accelerations(mesh.vertices.size());
  for (std::size_t i = 0; i < accelerations.size(); ++i) {
    const std::uint32_t cell = coarse.cell[i];
    const Vec3d d = mesh.vertices[i] - coarse.mesh.vertices[cell];
    const Rows& g = gradients[cell];
    accelerations[i] = values[cell].acceleration + Vec3d{dot(g[0], d), dot(g[1], d), dot(g[2], d)};
  }
  return accelerations;
}

// The centrifugal acceleration at unit distance from the axis, divided by G times the density.
double spin_rate(const BodyMotion& motion) {
  if (!(motion.rotation_hours > 0.0)) return 0.0;
  const double turn = 2.0 * std::numbers::pi / (3600.0 * motion.rotation_hours);
  return turn * turn / (kGravitationalConstant * motion.density);
}

// Makes verticals of accelerations at the points, for G times density = 1.
void turn_upwards(std::span<const Vec3d> points, const Vec3d& center, const BodyMotion& motion,
                  std::vector<Vec3d>& accelerations) {
  const double spin = spin_rate(motion);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3d from = points[i] - center;
    accelerations[i] = normalized(-1.0 * (accelerations[i] + spin * Vec3d{from.x, from.y, 0.0}));
  }
}

}  // namespace

CoarseSurface coarse_surface(const TriangleMesh& mesh, int cells) {
  CoarseSurface coarse;
  CellNumbers numbers(mesh.bounds(), cells);
  std::vector<Vec3d>& means = coarse.mesh.vertices;
  std::vector<double> counts;
  coarse.cell.reserve(mesh.vertices.size());
  for (const Vec3d& p : mesh.vertices) {
    const std::uint32_t cell = numbers.of(p);
    if (cell == means.size()) {
      means.push_back({});
      counts.push_back(0.0);
    }
    means[cell] += p;
    counts[cell] += 1.0;
    coarse.cell.push_back(cell);
  }
  for (std::size_t i = 0; i < means.size(); ++i) means[i] = means[i] * (1.0 / counts[i]);
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::uint32_t i = coarse.cell[a], j = coarse.cell[b], k = coarse.cell[c];
    if (i != j && j != k && k != i) coarse.mesh.triangles.push_back({i, j, k});
  }
  return coarse;
}

std::vector<Vec3d> vertical_directions(const TriangleMesh& mesh, const BodyMotion& motion) {
  const CoarseSurface coarse = coarse_body(mesh);
  const PolyhedronGravity gravity(coarse.mesh, kRoughDetail);
  std::vector<Vec3d> up = continued(mesh, coarse, gravity.roughly_at(coarse.mesh.vertices));
  turn_upwards(mesh.vertices, body_mass(coarse.mesh).center, motion, up);
  return up;
}

std::vector<Vec3d> vertical_directions_at(const TriangleMesh& mesh, std::span<const Vec3d> points,
                                          const BodyMotion& motion) {
  const PolyhedronGravity gravity(mesh, kRoughDetail);
  std::vector<Vec3d> up;
  up.reserve(points.size());
  for (const Attraction& a : gravity.roughly_at(points)) up.push_back(a.acceleration);
  turn_upwards(points, body_mass(mesh).center, motion, up);
  return up;
}

}  // namespace astrolith
