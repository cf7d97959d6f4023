#include "synthesis/finish/erosion.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include "geometry/mesh_measure.h"
#include "numerics/errors.h"
#include "numerics/portable_angles.h"
#include "synthesis/finish/ground_slides_internal.h"

namespace astrolith {
namespace {

constexpr double kLeastUpward = 0.0872;  // cosine of 85 degrees: vertices of steeper faces are rock
// The smallest a_v, as a fraction of the mean. Next to a vertex of smaller area a slide would move almost
// nothing.
constexpr double kLeastArea = 0.1;
// Passes of slides on clusters, each over slopes as the one before left them.
constexpr int kMostCoarsePasses = 2;

constexpr double kDegrees = 180.0 / std::numbers::pi;

struct Vertices {
  std::vector<double> area;    // a_v; 0 for rock
  std::vector<double> height;  // rise along the vertical since the areas were measured
  std::vector<char> changed;   // 1 where the vertex has ever moved
};

Vec3d area_vector(const TriangleMesh& mesh, const Triangle& t) {
  const Vec3d& p = mesh.vertices[t[0]];
  return 0.5 * cross(mesh.vertices[t[1]] - p, mesh.vertices[t[2]] - p);
}

// a_v of all vertices, rock included.
std::vector<double> seen_areas(const TriangleMesh& mesh, std::span<const Vec3d> up) {
  std::vector<double> areas(up.size(), 0.0);
  for (const Triangle& t : mesh.triangles) {
    const Vec3d area = area_vector(mesh, t);
    for (const std::uint32_t v : t) areas[v] += dot(area, up[v]) / 3.0;
  }
  return areas;
}

// Vertices whose faces have no area are rock too: nothing could lie on them.
std::vector<char> find_rock(const TriangleMesh& mesh, std::span<const Vec3d> up) {
  std::vector<char> rock(up.size(), 0);
  const std::vector<double> areas = seen_areas(mesh, up);
  for (std::size_t v = 0; v < rock.size(); ++v) rock[v] = areas[v] > 0.0 ? 0 : 1;
  for (const Triangle& t : mesh.triangles) {
    const Vec3d area = area_vector(mesh, t);
    for (const std::uint32_t v : t) {
      if (!(dot(area, up[v]) >= kLeastUpward * norm(area))) rock[v] = 1;
    }
  }
  return rock;
}

// Measures the areas of the mesh as it is now, and sets the heights to 0. A vertex that is not rock can
// always move: where a slide has folded its faces over, it has the smallest area until it has slid back.
void measure_areas(const TriangleMesh& mesh, std::span<const Vec3d> up, const std::vector<char>& rock,
                   Vertices& vertices) {
  vertices.area = seen_areas(mesh, up);
  double sum = 0.0, movable = 0.0;
  for (std::size_t v = 0; v < rock.size(); ++v) {
    if (rock[v] != 0 || !(vertices.area[v] > 0.0)) vertices.area[v] = 0.0;
    sum += vertices.area[v];
    movable += vertices.area[v] > 0.0 ? 1.0 : 0.0;
  }
  for (std::size_t v = 0; v < rock.size(); ++v) {
    if (rock[v] == 0) vertices.area[v] = std::max(vertices.area[v], kLeastArea * sum / movable);
  }
  vertices.height.assign(rock.size(), 0.0);
}

// The edges between two vertices that are not rock. Each edge of a closed mesh runs once from its lower
// vertex number to its higher one.
std::vector<GroundPair> loose_edges(const TriangleMesh& mesh, const std::vector<char>& rock) {
  std::vector<GroundPair> pairs;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      if (a < b && rock[a] == 0 && rock[b] == 0) pairs.push_back({a, b});
    }
  }
  return pairs;
}

// The steepest loose edge, in degrees.
double steepest(const TriangleMesh& mesh, std::span<const Vec3d> up, std::span<const GroundPair> pairs) {
  double slope = 0.0;
  for (const GroundPair& pair : pairs) {
    const Incline i = incline(mesh.vertices, up, pair);
    slope = std::max(slope, portable::atan2(std::fabs(i.drop), i.length));
  }
  return slope * kDegrees;
}

// Verticals converge, and small areas count as larger ones. The volume therefore differs from what the areas
// promise, by a few thousandths of what slid. All heights change a little to make up for it.
void restore_volume(TriangleMesh& mesh, std::span<const Vec3d> up, double wanted) {
  for (int pass = 0; pass < 3; ++pass) {
    const std::vector<double> areas = seen_areas(mesh, up);
    const double area = std::accumulate(areas.begin(), areas.end(), 0.0);
    if (!(area > 0.0)) return;
    const double lift = (wanted - volume(mesh)) / area;
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) mesh.vertices[v] += lift * up[v];
  }
}

// Normals around vertices that moved become those of the mesh; the others stay those of the field.
void renew_normals(TriangleMesh& mesh, const Vertices& vertices) {
  if (mesh.normals.empty()) return;
  std::vector<char> stale(mesh.vertices.size(), 0);
  for (const Triangle& t : mesh.triangles) {
    const bool moved =
        std::any_of(t.begin(), t.end(), [&](std::uint32_t v) { return vertices.changed[v] != 0; });
    for (const std::uint32_t v : t) stale[v] |= moved ? 1 : 0;
  }
  const std::vector<Vec3d> fresh = vertex_normals(mesh);
  for (std::size_t v = 0; v < stale.size(); ++v) {
    if (stale[v] != 0) mesh.normals[v] = fresh[v];
  }
}

// The slides of one mesh.
class Slides {
 public:
  Slides(TriangleMesh& mesh, std::span<const Vec3d> up, const std::vector<char>& rock, double talus_degrees,
         int most_sweeps, const Progress& progress)
      : mesh_(mesh),
        up_(up),
        rock_(rock),
        pairs_(loose_edges(mesh, rock)),
        slope_(kSlideAim * portable::tan(talus_degrees / kDegrees)),
        most_sweeps_(most_sweeps),
        progress_(progress) {
    vertices_.changed.assign(up.size(), 0);
  }

  std::span<const GroundPair> pairs() const { return pairs_; }
  const Vertices& vertices() const { return vertices_; }
  int sweeps() const { return sweeps_; }
  double volume_moved() const { return volume_moved_; }

  // Slides over far distances. Verticals converge downwards, so that slopes are measured anew after them.
  void slide_far() {
    for (int pass = 0; pass < kMostCoarsePasses; ++pass) {
      measure_areas(mesh_, up_, rock_, vertices_);
      vertices_.height = coarse_slides(ground(), slope_, most_sweeps_, [&](int) { report_or_stop(0); });
      if (!apply_heights()) return;
    }
  }

  // Lets everything slide until a first sweep over newly measured edges moves nothing.
  void slide_until_at_rest() {
    for (bool moves = true; moves && sweeps_ < most_sweeps_;) {
      measure_areas(mesh_, up_, rock_, vertices_);
      const std::vector<GroundEdge> edges = ground_edges(ground(), pairs_, slope_);
      const GroundSlides done = slide_ground(
          edges, vertices_.area, most_sweeps_ - sweeps_, [&](int sweeps) { report_or_stop(sweeps); },
          vertices_.height);
      sweeps_ += done.sweeps;
      moves = done.any;
      apply_heights();
    }
  }

 private:
  Ground ground() const { return {mesh_.vertices, up_, vertices_.area, pairs_}; }

  void report_or_stop(int more_sweeps) const {
    if (report(progress_, double(sweeps_ + more_sweeps) / most_sweeps_, "erosion")) return;
    throw WorkError("erosion: stopped before the slopes had settled");
  }

  // Returns whether a vertex moved.
  bool apply_heights() {
    bool any = false;
    for (std::size_t v = 0; v < up_.size(); ++v) {
      const double height = vertices_.height[v];
      if (height == 0.0) continue;
      mesh_.vertices[v] += height * up_[v];
      vertices_.changed[v] = 1;
      volume_moved_ += vertices_.area[v] * std::max(-height, 0.0);
      any = true;
    }
    return any;
  }

  TriangleMesh& mesh_;
  std::span<const Vec3d> up_;
  const std::vector<char>& rock_;
  std::vector<GroundPair> pairs_;
  double slope_;  // what slides aim at, a tangent
  int most_sweeps_;
  const Progress& progress_;
  Vertices vertices_;
  int sweeps_ = 0;
  double volume_moved_ = 0.0;
};

}  // namespace

ErosionStatistics erode(TriangleMesh& mesh, std::span<const Vec3d> up, double talus_degrees, int most_sweeps,
                        const Progress& progress) {
  if (!(talus_degrees > 0.0 && talus_degrees <= 89.0)) {
    throw InputError("erosion: the talus angle must lie above 0 and be at most 89 degrees");
  }
  const std::vector<char> rock = find_rock(mesh, up);
  Slides slides(mesh, up, rock, talus_degrees, most_sweeps, progress);
  ErosionStatistics statistics;
  statistics.rock_vertices = std::count(rock.begin(), rock.end(), char{1});
  statistics.steepest_before = statistics.steepest_after = steepest(mesh, up, slides.pairs());
  const double volume_before = volume(mesh);
  if (statistics.steepest_before > talus_degrees) slides.slide_far();
  // The lift that restores the volume can make slopes steeper again, by degrees where the verticals of
  // neighbours differ much. The slopes of the mesh as it is left decide whether it has settled, and slide
  // once more where one is too steep.
  bool moves = true;
  while (slides.sweeps() < most_sweeps && moves && !statistics.settled) {
    const double moved_before = slides.volume_moved();
    slides.slide_until_at_rest();
    restore_volume(mesh, up, volume_before);
    moves = slides.volume_moved() > moved_before;
    statistics.steepest_after = steepest(mesh, up, slides.pairs());
    statistics.settled = statistics.steepest_after <= talus_degrees;
  }
  report(progress, 1.0, "erosion");
  statistics.sweeps = slides.sweeps();
  statistics.volume_moved = slides.volume_moved();
  const std::vector<char>& changed = slides.vertices().changed;
  statistics.moved_vertices = std::count(changed.begin(), changed.end(), char{1});
  renew_normals(mesh, slides.vertices());
  return statistics;
}

}  // namespace astrolith
