#include "geometry/mesh_topology.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <tuple>

#include "geometry/mesh_edges.h"
#include "geometry/mesh_measure.h"
#include "numerics/errors.h"
#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

// The faces whose boxes touch this box.
std::vector<Triangle> faces_in(const Box& box, const TriangleMesh& mesh) {
  std::vector<Triangle> near;
  for (const Triangle& t : mesh.triangles) {
    Box own;
    for (const std::uint32_t v : t) own.extend(mesh.vertices[v]);
    if (boxes_touch(box, own)) near.push_back(t);
  }
  return near;
}

// The centre of a face, or also its corners and the middles of its sides: large faces pass through another
// part that holds none of their corners.
std::vector<Vec3d> probe_points(const TriangleMesh& mesh, const Triangle& t, bool coarse) {
  const Vec3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
  const Vec3d center = (a + b + c) * (1.0 / 3.0);
  if (!coarse) return {center};
  return {center, a, b, c, 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)};
}

bool runs_both_ways_equally(std::span<const TriangleSide> edge) {
  return 2 * std::count_if(edge.begin(), edge.end(), [](const TriangleSide& s) { return s.forward; }) ==
         static_cast<std::ptrdiff_t>(edge.size());
}

// Results of one pass over all edges.
struct EdgeWalk {
  std::int64_t edges = 0;
  DisjointSets fans;              // 3 #F corners; shared edges join corners of one vertex
  std::vector<bool> on_bad_edge;  // (#V) whether an edge of three or more triangles ends here
};

EdgeWalk walk_edges(const TriangleMesh& mesh, MeshTopology& topology) {
  EdgeWalk walk{0, DisjointSets(3 * mesh.triangles.size()), std::vector<bool>(mesh.vertices.size(), false)};
  for_each_edge(sorted_sides(mesh), [&](std::span<const TriangleSide> edge) {
    ++walk.edges;
    for (const TriangleSide& side : edge.subspan(1)) {
      walk.fans.unite(edge[0].low_corner(), side.low_corner());
      walk.fans.unite(edge[0].high_corner(), side.high_corner());
    }
    if (edge.size() == 1) ++topology.boundary_edges;
    if (edge.size() >= 2 && !runs_both_ways_equally(edge)) ++topology.misoriented_edges;
    if (edge.size() >= 3) {
      ++topology.non_manifold_edges;
      walk.on_bad_edge[edge[0].low] = walk.on_bad_edge[edge[0].high] = true;
    }
  });
  return walk;
}

// (#V) the number of fans of triangles around each vertex: 1 for a disk or half disk, 0 for an unused vertex.
std::vector<std::uint32_t> count_fans(const TriangleMesh& mesh, DisjointSets& fans) {
  std::vector<std::uint32_t> count(mesh.vertices.size(), 0);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (is_degenerate(mesh.triangles[t])) continue;
    for (std::uint32_t k = 0; k < 3; ++k) {
      if (fans.find(3 * t + k) == 3 * t + k) ++count[mesh.triangles[t][k]];
    }
  }
  return count;
}

std::int64_t count_components(const TriangleMesh& mesh) {
  DisjointSets sets(mesh.vertices.size());
  std::vector<bool> used(mesh.vertices.size(), false);
  for (const Triangle& t : mesh.triangles) {
    if (is_degenerate(t)) continue;
    used[t[0]] = used[t[1]] = used[t[2]] = true;
    sets.unite(t[0], t[1]);
    sets.unite(t[0], t[2]);
  }
  std::int64_t components = 0;
  for (std::uint32_t v = 0; v < used.size(); ++v) components += used[v] && sets.find(v) == v;
  return components;
}

}  // namespace

std::vector<SurfacePart> split_parts(const TriangleMesh& mesh, const std::vector<std::uint32_t>& number) {
  std::vector<SurfacePart> parts(1 + *std::max_element(number.begin(), number.end()));
  // Parts may share a vertex: it is numbered anew by each part that comes upon it.
  std::vector<std::uint32_t> owner(mesh.vertices.size(), 0xffffffff), place(mesh.vertices.size(), 0);
  std::vector<std::vector<std::uint32_t>> faces(parts.size());
  for (std::uint32_t f = 0; f < number.size(); ++f) faces[number[f]].push_back(f);
  for (std::uint32_t p = 0; p < parts.size(); ++p) {
    SurfacePart& part = parts[p];
    for (const std::uint32_t f : faces[p]) {
      Triangle triangle = mesh.triangles[f];
      for (std::uint32_t& v : triangle) {
        if (owner[v] != p) {
          owner[v] = p;
          place[v] = static_cast<std::uint32_t>(part.mesh.vertices.size());
          part.mesh.vertices.push_back(mesh.vertices[v]);
          part.box.extend(mesh.vertices[v]);
        }
        v = place[v];
      }
      part.mesh.triangles.push_back(triangle);
    }
    part.volume = volume(part.mesh);
  }
  return parts;
}

bool box_holds(const Box& outer, const Box& inner) {
  const Box common = common_part(outer, inner);
  return common.min == inner.min && common.max == inner.max;
}

double PartNesting::share_inside(const SurfacePart& a, const SurfacePart& b) {
  constexpr std::size_t kMostFaces = 64;
  const std::vector<Triangle> near = faces_in(common_part(a.box, b.box), a.mesh);
  const bool coarse = a.mesh.triangles.size() < 1000;
  std::vector<Vec3d> places;
  for (std::size_t i = 0; i < near.size(); i += near.size() / kMostFaces + 1) {
    for (const Vec3d& p : probe_points(a.mesh, near[i], coarse)) places.push_back(p);
  }
  angles_left_ -= static_cast<double>(places.size()) * static_cast<double>(b.mesh.triangles.size());
  if (spent()) return 0.0;
  std::vector<double> windings(places.size());
  parallel_for(0, static_cast<std::int64_t>(places.size()), [&](std::int64_t i) {
    const auto k = static_cast<std::size_t>(i);
    windings[k] = std::abs(winding_number(b.mesh, places[k]));
  });
  const auto inside = std::count_if(windings.begin(), windings.end(), [](double w) { return w > 0.75; });
  const auto outside = std::count_if(windings.begin(), windings.end(), [](double w) { return w < 0.25; });
  return inside > 0 ? static_cast<double>(inside) / static_cast<double>(inside + outside) : 0.0;
}

bool PartNesting::lies_inside(const SurfacePart& a, const SurfacePart& b) {
  constexpr double kBoxTest = 16.0;  // about the time of so many angles
  angles_left_ -= kBoxTest;
  return box_holds(b.box, a.box) && !spent() && share_inside(a, b) == 1.0;
}

void check_indices(const TriangleMesh& mesh) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t v : mesh.triangles[t]) {
      if (v < mesh.vertices.size()) continue;
      throw InputError("mesh: triangle " + std::to_string(t) + " names vertex " + std::to_string(v) + " of " +
                       std::to_string(mesh.vertices.size()) + "; repair the file's faces");
    }
  }
}

std::vector<TriangleSide> sorted_sides(const TriangleMesh& mesh) {
  std::vector<TriangleSide> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& triangle = mesh.triangles[t];
    if (is_degenerate(triangle)) continue;
    for (std::uint8_t k = 0; k < 3; ++k) {
      const std::uint32_t a = triangle[k], b = triangle[(k + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), t, k, a < b});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const TriangleSide& a, const TriangleSide& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  return sides;
}

std::vector<std::uint32_t> triangle_components(const TriangleMesh& mesh) {
  constexpr std::uint32_t kUnseen = std::numeric_limits<std::uint32_t>::max();
  DisjointSets sets(mesh.vertices.size());
  for (const Triangle& t : mesh.triangles) {
    sets.unite(t[0], t[1]);
    sets.unite(t[0], t[2]);
  }
  std::vector<std::uint32_t> number(mesh.vertices.size(), kUnseen), components;
  components.reserve(mesh.triangles.size());
  std::uint32_t next = 0;
  for (const Triangle& t : mesh.triangles) {
    std::uint32_t& component = number[sets.find(t[0])];
    if (component == kUnseen) component = next++;
    components.push_back(component);
  }
  return components;
}

MeshTopology analyze_topology(const TriangleMesh& mesh) {
  check_indices(mesh);
  MeshTopology topology;
  EdgeWalk walk = walk_edges(mesh, topology);
  const std::vector<std::uint32_t> fans = count_fans(mesh, walk.fans);
  for (std::size_t v = 0; v < fans.size(); ++v) {
    topology.unused_vertices += fans[v] == 0;
    topology.non_manifold_vertices += fans[v] > 1 || walk.on_bad_edge[v];
  }
  topology.degenerate_triangles = std::count_if(mesh.triangles.begin(), mesh.triangles.end(), is_degenerate);
  topology.components = count_components(mesh);
  const auto faces = static_cast<std::int64_t>(mesh.triangles.size()) - topology.degenerate_triangles;
  const auto vertices = static_cast<std::int64_t>(mesh.vertices.size()) - topology.unused_vertices;
  topology.euler_characteristic = vertices - walk.edges + faces;
  topology.closed = faces > 0 && topology.boundary_edges == 0;
  topology.manifold = faces > 0 && topology.non_manifold_edges == 0 && topology.non_manifold_vertices == 0;
  topology.oriented = topology.misoriented_edges == 0;
  if (topology.closed && topology.manifold && topology.oriented) {
    // chi = 2 - 2g for each component.
    topology.genus = topology.components - topology.euler_characteristic / 2;
  }
  return topology;
}

}  // namespace astrolith
