#include "synthesis/finish/erosion.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "geometry/mesh_measure.h"
#include "geometry/mesh_normals.h"
#include "numerics/errors.h"
#include "numerics/portable_angles.h"
#include "synthesis/finish/active_edges_internal.h"

namespace astrolith {
namespace {

constexpr double kLeastUpward = 0.0872;  // cosine of 85 degrees: vertices of steeper faces are rock
// Slides aim at a slope a little below the talus angle and begin a little above their aim, so that they end.
constexpr double kAim = 1.0 - 2e-3;
constexpr double kSettled = 1e-3;  // relative excess over the aim that starts no slide
// Above 1: slides go beyond their aim and settle in fewer sweeps (successive over-relaxation).
constexpr double kRelaxation = 1.6;
// The smallest a_v, as a fraction of the mean. Next to a vertex of smaller area a slide would move almost
// nothing.
constexpr double kLeastArea = 0.1;

constexpr double kDegrees = 180.0 / std::numbers::pi;

// An edge between two vertices that are not rock. With heights along the verticals its drop is drop + h_a -
// h_b.
struct Edge {
  std::uint32_t a, b;
  double drop;   // height of a above b before anything moved
  double limit;  // magnitude of the drop at the slope that slides aim at
};

struct Vertices {
  std::vector<double> area;    // a_v; 0 for rock
  std::vector<double> height;  // rise along the vertical since the edges were measured
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

// The drop and the horizontal length of an edge.
struct Incline {
  double drop, length;
};
Incline incline(const TriangleMesh& mesh, std::span<const Vec3d> up, std::uint32_t a, std::uint32_t b) {
  const Vec3d d = mesh.vertices[a] - mesh.vertices[b];
  const Vec3d vertical = normalized(up[a] + up[b]);
  const double drop = dot(d, vertical);
  return {drop, norm(d - drop * vertical)};
}

// Visits the edges between two vertices that are not rock. Each edge of a closed mesh runs once from its
// lower vertex number to its higher one.
template <typename Visit>
void for_each_loose_edge(const TriangleMesh& mesh, const std::vector<char>& rock, const Visit& visit) {
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      if (a < b && rock[a] == 0 && rock[b] == 0) visit(a, b);
    }
  }
}

std::vector<Edge> make_edges(const TriangleMesh& mesh, std::span<const Vec3d> up,
                             const std::vector<char>& rock, double slope) {
  std::vector<Edge> edges;
  for_each_loose_edge(mesh, rock, [&](std::uint32_t a, std::uint32_t b) {
    const Incline i = incline(mesh, up, a, b);
    edges.push_back({a, b, i.drop, slope * i.length});
  });
  return edges;
}

// The steepest loose edge, in degrees.
double steepest(const TriangleMesh& mesh, std::span<const Vec3d> up, const std::vector<char>& rock) {
  double slope = 0.0;
  for_each_loose_edge(mesh, rock, [&](std::uint32_t a, std::uint32_t b) {
    const Incline i = incline(mesh, up, a, b);
    slope = std::max(slope, portable::atan2(std::fabs(i.drop), i.length));
  });
  return slope * kDegrees;
}

ActiveEdges all_active(const std::vector<Edge>& edges, std::size_t num_vertices) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> ends;
  ends.reserve(edges.size());
  for (const Edge& edge : edges) ends.emplace_back(edge.a, edge.b);
  return {num_vertices, ends};
}

// Lets material slide down one edge. Returns its volume, 0 where the edge is not too high.
double slide(const Edge& edge, Vertices& vertices) {
  const double drop = edge.drop + (vertices.height[edge.a] - vertices.height[edge.b]);
  const double excess = std::fabs(drop) - edge.limit;
  if (!(excess > kSettled * edge.limit)) return 0.0;
  const double area_a = vertices.area[edge.a], area_b = vertices.area[edge.b];
  const double volume = kRelaxation * excess / (1.0 / area_a + 1.0 / area_b);
  const double down = drop > 0.0 ? volume : -volume;
  vertices.height[edge.a] -= down / area_a;
  vertices.height[edge.b] += down / area_b;
  vertices.changed[edge.a] = vertices.changed[edge.b] = 1;
  return volume;
}

// Gives every active edge one turn, forwards in odd sweeps and backwards in even ones, so that no direction
// is preferred. Returns the volume that slid.
double sweep_edges(const std::vector<Edge>& edges, int sweep, ActiveEdges& active, Vertices& vertices) {
  double moved = 0.0;
  active.sweep(sweep % 2 == 1, [&](std::size_t e) {
    const double volume = slide(edges[e], vertices);
    if (volume == 0.0) return;
    active.wake(edges[e].a);
    active.wake(edges[e].b);
    moved += volume;
  });
  return moved;
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

// Lets everything slide until a first sweep over newly measured edges moves nothing. Verticals converge
// downwards, so that edges are measured anew after far slides.
void slide_until_at_rest(TriangleMesh& mesh, std::span<const Vec3d> up, const std::vector<char>& rock,
                         double talus_degrees, int most_sweeps, const Progress& progress, Vertices& vertices,
                         ErosionStatistics& statistics) {
  const double slope = kAim * portable::tan(talus_degrees / kDegrees);
  bool at_rest = false;
  while (statistics.sweeps < most_sweeps && !at_rest) {
    measure_areas(mesh, up, rock, vertices);
    const std::vector<Edge> edges = make_edges(mesh, up, rock, slope);
    ActiveEdges active = all_active(edges, up.size());
    const int first = statistics.sweeps + 1;
    for (double moved = 1.0; moved > 0.0 && statistics.sweeps < most_sweeps;) {
      moved = sweep_edges(edges, ++statistics.sweeps, active, vertices);
      statistics.volume_moved += moved;
      at_rest = moved == 0.0 && statistics.sweeps == first;
      if (!report(progress, double(statistics.sweeps) / most_sweeps, "erosion")) {
        throw WorkError("erosion: stopped before the slopes had settled");
      }
    }
    for (std::size_t v = 0; v < up.size(); ++v) mesh.vertices[v] += vertices.height[v] * up[v];
  }
}

}  // namespace

ErosionStatistics erode(TriangleMesh& mesh, std::span<const Vec3d> up, double talus_degrees, int most_sweeps,
                        const Progress& progress) {
  if (!(talus_degrees > 0.0 && talus_degrees <= 89.0)) {
    throw InputError("erosion: the talus angle must lie above 0 and be at most 89 degrees");
  }
  const std::vector<char> rock = find_rock(mesh, up);
  Vertices vertices{{}, {}, std::vector<char>(up.size(), 0)};
  ErosionStatistics statistics;
  statistics.rock_vertices = std::count(rock.begin(), rock.end(), char{1});
  statistics.steepest_before = statistics.steepest_after = steepest(mesh, up, rock);
  const double volume_before = volume(mesh);
  // The lift that restores the volume can make slopes steeper again, by degrees where the verticals of
  // neighbours differ much. The slopes of the mesh as it is left decide whether it has settled, and slide
  // once more where one is too steep.
  bool slides = true;
  while (statistics.sweeps < most_sweeps && slides && !statistics.settled) {
    const double moved_before = statistics.volume_moved;
    slide_until_at_rest(mesh, up, rock, talus_degrees, most_sweeps, progress, vertices, statistics);
    restore_volume(mesh, up, volume_before);
    slides = statistics.volume_moved > moved_before;
    statistics.steepest_after = steepest(mesh, up, rock);
    statistics.settled = statistics.steepest_after <= talus_degrees;
  }
  report(progress, 1.0, "erosion");
  statistics.moved_vertices = std::count(vertices.changed.begin(), vertices.changed.end(), char{1});
  renew_normals(mesh, vertices);
  return statistics;
}

}  // namespace astrolith
