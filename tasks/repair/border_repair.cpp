#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "geometry/mesh_edges.h"
#include "geometry/wound_surface.h"
#include "numerics/box_tree.h"
#include "numerics/errors.h"
#include "tasks/repair/mesh_repair_internal.h"

namespace astrolith {
namespace {

// Two ends of a border edge are never joined: less than half of the edge.
constexpr double kReachPerEdge = 0.45;
// A vertex lies on a border edge when it is nearer to it than this share of the edge, and farther than this
// share from its ends.
constexpr double kBesideEdge = 0.2, kFromEnds = 0.02;
constexpr double kMostReach = 0.005;  // of the diagonal
constexpr int kRounds = 3;
// Candidates for each border vertex or edge, on average.
constexpr std::size_t kMostCandidates = 256;
// Border vertices nearer than this share of the diagonal are one, however many they are: poles of grids of
// longitude and latitude are often there once for every longitude.
constexpr double kOnePlace = 1e-6;

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

struct Border {
  std::vector<TriangleSide> sides;      // edges of one facet
  std::vector<std::uint32_t> vertices;  // ascending
  std::vector<double> reach;            // (#V of the mesh) how far a border vertex may be joined
  BoxTree tree;                         // of the places of `vertices`
};

Box reach_box(const Vec3d& p, double reach) { return widened(Box{p, p}, reach); }

Border find_border(const TriangleMesh& mesh, double most_reach) {
  Border border;
  border.reach.assign(mesh.vertices.size(), most_reach);
  for_each_edge(sorted_sides(mesh), [&](std::span<const TriangleSide> edge) {
    if (edge.size() != 1) return;
    border.sides.push_back(edge[0]);
    const double length = norm(mesh.vertices[edge[0].low] - mesh.vertices[edge[0].high]);
    for (const std::uint32_t v : {edge[0].low, edge[0].high}) {
      border.vertices.push_back(v);
      border.reach[v] = std::min(border.reach[v], kReachPerEdge * length);
    }
  });
  std::sort(border.vertices.begin(), border.vertices.end());
  border.vertices.erase(std::unique(border.vertices.begin(), border.vertices.end()), border.vertices.end());
  std::vector<Box> boxes;
  for (const std::uint32_t v : border.vertices) boxes.push_back(reach_box(mesh.vertices[v], 0.0));
  border.tree = BoxTree(boxes);
  return border;
}

// Counts candidates and throws where they are too many.
class Crowd {
 public:
  Crowd(const std::string& name, std::size_t searches)
      : name_(name), left_(kMostCandidates * (searches + kMostCandidates)) {}
  void count(std::size_t candidates) {
    if (candidates > left_) throw InputError(name_ + ": too many borders lie on one another");
    left_ -= candidates;
  }

 private:
  const std::string& name_;
  std::size_t left_;
};

// (#V) the border vertex that each border vertex would be joined to, or kNone.
std::vector<std::uint32_t> nearest_border_vertices(const TriangleMesh& mesh, const Border& border,
                                                   const std::string& name) {
  Crowd crowd(name, border.vertices.size());
  std::vector<std::uint32_t> nearest(mesh.vertices.size(), kNone);
  for (const std::uint32_t v : border.vertices) {
    const std::vector<std::uint32_t> found =
        border.tree.touching(reach_box(mesh.vertices[v], border.reach[v]));
    crowd.count(found.size());
    double least = std::numeric_limits<double>::infinity();
    for (const std::uint32_t i : found) {
      const std::uint32_t u = border.vertices[i];
      const double distance = norm(mesh.vertices[u] - mesh.vertices[v]);
      if (u == v || distance > std::min(border.reach[u], border.reach[v]) || distance >= least) continue;
      least = distance;
      nearest[v] = u;
    }
  }
  return nearest;
}

// Joins pairs of border vertices that are each other's nearest; the first of the mesh stays in place.
std::int64_t join_vertices(JoinedBorders& joined, double most_reach, const std::string& name) {
  TriangleMesh& mesh = joined.mesh;
  const Border border = find_border(mesh, most_reach);
  const std::vector<std::uint32_t> nearest = nearest_border_vertices(mesh, border, name);
  std::int64_t count = 0;
  for (const std::uint32_t v : border.vertices) {
    const std::uint32_t u = nearest[v];
    if (u == kNone || u < v || nearest[u] != v) continue;
    joined.moved = std::max(joined.moved, norm(mesh.vertices[u] - mesh.vertices[v]));
    mesh.vertices[u] = mesh.vertices[v];
    ++count;
  }
  if (count > 0) mesh = drop_degenerate_and_repeated_faces(weld_vertices(std::move(mesh), 0.0));
  joined.joined_vertices += count;
  return count;
}

// Gives border vertices at nearly one place the coordinates of the first.
void join_places(JoinedBorders& joined) {
  TriangleMesh& mesh = joined.mesh;
  const Border border = find_border(mesh, 0.0);
  TriangleMesh places;
  for (const std::uint32_t v : border.vertices) {
    const auto i = static_cast<std::uint32_t>(places.vertices.size());
    places.vertices.push_back(mesh.vertices[v]);
    places.triangles.push_back({i, i, i});
  }
  const double diagonal = places.bounds().diagonal();
  constexpr double kMostTolerance = 0.09;
  if (places.vertices.empty() || !(diagonal > 0.0)) return;
  places = weld_vertices(std::move(places),
                         std::min(kMostTolerance, kOnePlace * mesh.bounds().diagonal() / diagonal));
  if (places.vertices.size() == border.vertices.size()) return;
  for (std::size_t i = 0; i < border.vertices.size(); ++i) {
    const Vec3d& place = places.vertices[places.triangles[i][0]];
    Vec3d& p = mesh.vertices[border.vertices[i]];
    joined.moved = std::max(joined.moved, norm(place - p));
    p = place;
  }
  mesh = drop_degenerate_and_repeated_faces(weld_vertices(std::move(mesh), 0.0));
}

struct VertexOnEdge {
  double along;  // 0 .. 1
  std::uint32_t vertex;
};

// The border vertices on one border edge, in their order along it.
std::vector<VertexOnEdge> vertices_on(const TriangleMesh& mesh, const Border& border,
                                      const TriangleSide& side, double most_reach, Crowd& crowd,
                                      double& moved) {
  const Triangle& facet = mesh.triangles[side.triangle];
  const Vec3d a = mesh.vertices[facet[side.corner]], b = mesh.vertices[facet[(side.corner + 1u) % 3]];
  const double length = norm(b - a);
  const double reach = std::min(kBesideEdge * length, most_reach);
  Box box = reach_box(a, reach);
  box.extend(widened(Box{b, b}, reach).min);
  box.extend(widened(Box{b, b}, reach).max);
  const std::vector<std::uint32_t> found = border.tree.touching(box);
  crowd.count(found.size());
  std::vector<VertexOnEdge> on;
  for (const std::uint32_t i : found) {
    const std::uint32_t v = border.vertices[i];
    if (std::find(facet.begin(), facet.end(), v) != facet.end()) continue;
    const Vec3d p = mesh.vertices[v] - a;
    const double along = dot(p, b - a) / (length * length);
    const double distance = norm(p - along * (b - a));
    if (!(along > kFromEnds && along < 1.0 - kFromEnds)) continue;
    if (distance > std::min(reach, border.reach[v])) continue;
    on.push_back({along, v});
    moved = std::max(moved, distance);
  }
  std::sort(on.begin(), on.end(), [](const VertexOnEdge& p, const VertexOnEdge& q) {
    return std::pair(p.along, p.vertex) < std::pair(q.along, q.vertex);
  });
  return on;
}

// Splits facets at the border vertices on one of their border edges.
std::int64_t split_facets(JoinedBorders& joined, double most_reach, const std::string& name) {
  TriangleMesh& mesh = joined.mesh;
  const Border border = find_border(mesh, most_reach);
  Crowd crowd(name, border.sides.size());
  std::map<std::uint32_t, std::vector<Triangle>> parts;  // by facet
  for (const TriangleSide& side : border.sides) {
    if (parts.contains(side.triangle)) continue;
    const std::vector<VertexOnEdge> on = vertices_on(mesh, border, side, most_reach, crowd, joined.moved);
    if (on.empty()) continue;
    const Triangle facet = mesh.triangles[side.triangle];
    const std::uint32_t end = facet[(side.corner + 1u) % 3], apex = facet[(side.corner + 2u) % 3];
    std::uint32_t last = facet[side.corner];
    std::vector<Triangle>& fan = parts[side.triangle];
    for (const VertexOnEdge& v : on) {
      fan.push_back({apex, last, v.vertex});
      last = v.vertex;
    }
    fan.push_back({apex, last, end});
  }
  for (auto& [facet, fan] : parts) {
    mesh.triangles[facet] = fan.front();
    mesh.triangles.insert(mesh.triangles.end(), fan.begin() + 1, fan.end());
  }
  if (!parts.empty()) mesh = drop_degenerate_and_repeated_faces(std::move(mesh));
  joined.split_facets += static_cast<std::int64_t>(parts.size());
  return static_cast<std::int64_t>(parts.size());
}

}  // namespace

JoinedBorders join_borders(TriangleMesh mesh, const std::string& name) {
  const double most_reach = kMostReach * mesh.bounds().diagonal();
  JoinedBorders joined{std::move(mesh)};
  join_places(joined);
  for (int round = 0; round < kRounds; ++round) {
    const std::int64_t vertices = join_vertices(joined, most_reach, name);
    if (vertices + split_facets(joined, most_reach, name) == 0) break;
  }
  return joined;
}

}  // namespace astrolith
