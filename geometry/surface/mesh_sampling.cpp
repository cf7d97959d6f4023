#include "geometry/surface/mesh_sampling.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <queue>
#include <string>
#include <utility>
#include <vector>

#include "geometry/mesh_measure.h"
#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "numerics/portable_double.h"
#include "numerics/reported_loop.h"
#include "numerics/vec3.h"

namespace astrolith {
namespace {

// Points sorted into the cells of a uniform grid, to find all neighbours within one fixed radius.
class PointGrid {
 public:
  // Keeps a reference to the points. radius > 0.
  PointGrid(const std::vector<Vec3d>& points, double radius) : points_(points), radius_(radius) {
    for (const Vec3d& p : points) box_.extend(p);
    // The key of a cell has 21 bits for each axis, so that cells have a smallest size.
    cell_ = std::max(radius, box_.diagonal() / (kMostCells - 2));
    sorted_.reserve(points.size());
    for (std::uint32_t i = 0; i < points.size(); ++i) sorted_.emplace_back(key(cell_at(points[i])), i);
    std::sort(sorted_.begin(), sorted_.end());
  }

  // Calls visit(index, squared distance) for each other point at a distance below the radius, in an order
  // that depends on the points and the radius alone.
  template <typename Visit>
  void for_each_neighbour(std::uint32_t i, const Visit& visit) const {
    const Cell center = cell_at(points_[i]);
    for (std::int64_t x = center.x - 1; x <= center.x + 1; ++x) {
      for (std::int64_t y = center.y - 1; y <= center.y + 1; ++y) {
        // The three cells along z have consecutive keys.
        const std::uint64_t last = key({x, y, center.z + 1});
        auto it = std::lower_bound(sorted_.begin(), sorted_.end(),
                                   std::pair{key({x, y, center.z - 1}), std::uint32_t{0}});
        for (; it != sorted_.end() && it->first <= last; ++it) {
          const double d2 = squared_norm(points_[it->second] - points_[i]);
          if (it->second != i && d2 < radius_ * radius_) visit(it->second, d2);
        }
      }
    }
  }

 private:
  static constexpr int kMostCells = 1 << 20;  // along an axis
  struct Cell {
    std::int64_t x, y, z;
  };
  Cell cell_at(const Vec3d& p) const {
    const auto along = [&](double value, double low) {
      // At least 1, so that lower neighbours have numbers of at least 0.
      return static_cast<std::int64_t>(std::floor((value - low) / cell_)) + 1;
    };
    return {along(p.x, box_.min.x), along(p.y, box_.min.y), along(p.z, box_.min.z)};
  }
  static std::uint64_t key(const Cell& c) {
    return static_cast<std::uint64_t>(c.x) << 42 | static_cast<std::uint64_t>(c.y) << 21 |
           static_cast<std::uint64_t>(c.z);
  }

  const std::vector<Vec3d>& points_;
  double radius_;
  double cell_ = 0;
  Box box_;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> sorted_;  // (cell, point)
};

constexpr std::int64_t kCandidatesPerSample = 5;
constexpr std::size_t kRemovalsPerReport = 4096;  // some hundredths of a second
// The number of candidates must fit into 32 bits.
constexpr std::int64_t kMaxSamples = std::numeric_limits<std::int32_t>::max() / kCandidatesPerSample;

std::vector<double> cumulative_areas(const TriangleMesh& mesh) {
  std::vector<double> sums;
  sums.reserve(mesh.triangles.size());
  double sum = 0;
  for (const Triangle& t : mesh.triangles) sums.push_back(sum += triangle_area(mesh, t));
  if (!(sum > 0) || !std::isfinite(sum)) {
    throw InputError("mesh: its surface has no area or is not finite; points cannot be placed on it");
  }
  return sums;
}

void check_count(std::int64_t n) {
  if (n < 0 || n > kMaxSamples) {
    throw InputError("number of surface samples: " + std::to_string(n) + " is outside 0 to " +
                     std::to_string(kMaxSamples) + "; choose fewer");
  }
}

// The weight that a neighbour at some distance adds to the crowding of a candidate: eq. 2 and 3 of Yuksel
// 2015.
class Crowding {
 public:
  Crowding(double max_radius, double min_radius) : reach_(2 * max_radius), floor_(2 * min_radius) {}
  double reach() const { return reach_; }
  double weight(double squared_distance) const {
    const double x = 1 - std::max(std::sqrt(squared_distance), floor_) / reach_;
    const double x2 = x * x, x4 = x2 * x2;
    return x4 * x4;  // alpha = 8
  }

 private:
  double reach_, floor_;
};

void go_on_or_stop(const Progress& progress) {
  if (!report(progress, 1, "sampling")) throw WorkError("sampling: stopped");
}

// Removes the most crowded point until n are left; which[i] tells whether point i stays.
std::vector<bool> eliminate(const std::vector<Vec3d>& points, std::int64_t n, const Crowding& crowding,
                            const Progress& progress) {
  const PointGrid grid(points, crowding.reach());
  std::vector<double> weights(points.size(), 0.0);
  const auto count = static_cast<std::int64_t>(points.size());
  reported_parallel_for({0, count, count}, progress, "sampling", [&](std::int64_t i) {
    double sum = 0;
    grid.for_each_neighbour(static_cast<std::uint32_t>(i),
                            [&](std::uint32_t, double d2) { sum += crowding.weight(d2); });
    weights[static_cast<std::size_t>(i)] = sum;
  });
  // Weights only fall, so that no entry of the queue is too low. An entry that is out of date goes back with
  // its present weight. Of equal weights the highest index is removed first.
  std::priority_queue<std::pair<double, std::uint32_t>> queue;
  for (std::uint32_t i = 0; i < points.size(); ++i) queue.emplace(weights[i], i);
  std::vector<bool> stays(points.size(), true);
  while (static_cast<std::int64_t>(queue.size()) > n) {
    const auto [weight, i] = queue.top();
    queue.pop();
    if (weight != weights[i]) {
      queue.emplace(weights[i], i);
      continue;
    }
    stays[i] = false;
    if (queue.size() % kRemovalsPerReport == 0) go_on_or_stop(progress);
    grid.for_each_neighbour(i, [&](std::uint32_t j, double d2) { weights[j] -= crowding.weight(d2); });
  }
  return stays;
}

SurfaceSamples only(const SurfaceSamples& all, const std::vector<bool>& stays) {
  SurfaceSamples kept;
  for (std::size_t i = 0; i < stays.size(); ++i) {
    if (!stays[i]) continue;
    kept.points.push_back(all.points[i]);
    kept.normals.push_back(all.normals[i]);
    kept.triangles.push_back(all.triangles[i]);
  }
  return kept;
}

}  // namespace

double poisson_disk_radius(double area, std::int64_t n) {
  return std::sqrt(area / (2 * std::sqrt(3.0) * static_cast<double>(n)));
}

SurfaceSamples sample_surface(const TriangleMesh& mesh, std::int64_t n, std::uint64_t seed,
                              SampleNormals kind, const Progress& progress) {
  check_count(n);
  const std::vector<double> areas = cumulative_areas(mesh);
  const auto size = static_cast<std::size_t>(n);
  const bool interpolate = kind == SampleNormals::interpolated;
  const std::vector<Vec3d> smooth = interpolate ? vertex_normals(mesh) : std::vector<Vec3d>();
  SurfaceSamples samples{std::vector<Vec3d>(size), std::vector<Vec3d>(size),
                         std::vector<std::uint32_t>(size)};
  reported_parallel_for({0, n, n}, progress, "sampling", [&](std::int64_t index) {
    const auto i = static_cast<std::size_t>(index);
    CounterRandom random(seed, i);
    const auto found = std::upper_bound(areas.begin(), areas.end(), areas.back() * random.uniform());
    // Rounding may push the drawn area onto the total. The last triangle with an area then takes the sample.
    const auto t = static_cast<std::size_t>(
        (found == areas.end() ? std::lower_bound(areas.begin(), areas.end(), areas.back()) : found) -
        areas.begin());
    const auto [a, b, c] = mesh.triangles[t];
    // These weights are uniform over the triangle: the square root makes up for the crowding at corner a.
    const double root = std::sqrt(random.uniform()), split = random.uniform();
    const double wa = 1 - root, wb = root * (1 - split), wc = root * split;
    samples.points[i] = wa * mesh.vertices[a] + wb * mesh.vertices[b] + wc * mesh.vertices[c];
    samples.normals[i] = interpolate ? normalized(wa * smooth[a] + wb * smooth[b] + wc * smooth[c])
                                     : triangle_normal(mesh, mesh.triangles[t]);
    samples.triangles[i] = static_cast<std::uint32_t>(t);
  });
  return samples;
}

SurfaceSamples sample_poisson_disk(const TriangleMesh& mesh, std::int64_t n, std::uint64_t seed,
                                   SampleNormals kind, const Progress& progress) {
  check_count(n);
  if (n == 0) return {};
  const SurfaceSamples candidates = sample_surface(mesh, kCandidatesPerSample * n, seed, kind, progress);
  const double max_radius = poisson_disk_radius(surface_area(mesh), n);
  const double min_radius =
      max_radius * 0.65 * (1 - portable::pow(1.0 / static_cast<double>(kCandidatesPerSample), 1.5));
  return only(candidates, eliminate(candidates.points, n, Crowding(max_radius, min_radius), progress));
}

}  // namespace astrolith
