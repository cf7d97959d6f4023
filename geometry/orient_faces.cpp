#include "geometry/orient_faces.h"

#include <cstdint>
#include <utility>

#include "geometry/mesh_edges.h"

namespace astrolith {
namespace {

// The face across one side of a face, or kNone, and whether the two faces are wound alike.
struct Neighbour {
  static constexpr std::uint32_t kNone = 0xffffffff;
  std::uint32_t face = kNone;
  bool alike = true;
};

std::vector<std::array<Neighbour, 3>> neighbours(const TriangleMesh& mesh) {
  std::vector<std::array<Neighbour, 3>> result(mesh.triangles.size());
  for_each_edge(sorted_sides(mesh), [&](std::span<const TriangleSide> edge) {
    if (edge.size() != 2) return;
    const bool alike = edge[0].forward != edge[1].forward;
    result[edge[0].triangle][edge[0].corner] = {edge[1].triangle, alike};
    result[edge[1].triangle][edge[1].corner] = {edge[0].triangle, alike};
  });
  return result;
}

// Six times the signed volume of the cone from the origin over a face.
double cone_volume(const TriangleMesh& mesh, const Vec3d& origin, const Triangle& t) {
  const auto corner = [&](int k) { return mesh.vertices[t[static_cast<std::size_t>(k)]] - origin; };
  return dot(corner(0), cross(corner(1), corner(2)));
}

// Extends `component` from its first face to all faces reached across shared edges. Marks in `flipped` the
// faces to be reversed, and returns six times the signed volume of the component after these reversals.
double wind_alike(const TriangleMesh& mesh, const std::vector<std::array<Neighbour, 3>>& adjacent,
                  const Vec3d& origin, std::vector<std::uint32_t>& component,
                  std::vector<std::uint8_t>& visited, std::vector<std::uint8_t>& flipped) {
  double volume = 0.0;
  for (std::size_t i = 0; i < component.size(); ++i) {  // component grows on the way
    const std::uint32_t face = component[i];
    const double cone = cone_volume(mesh, origin, mesh.triangles[face]);
    volume += flipped[face] != 0 ? -cone : cone;
    for (const Neighbour& n : adjacent[face]) {
      if (n.face == Neighbour::kNone || visited[n.face] != 0) continue;
      visited[n.face] = 1;
      flipped[n.face] = n.alike ? flipped[face] : !flipped[face];
      component.push_back(n.face);
    }
  }
  return volume;
}

}  // namespace

TriangleMesh orient_faces(TriangleMesh mesh) {
  const auto adjacent = neighbours(mesh);
  // The volume of an open component depends on the apex of its cones: the centre of the bounding box.
  const Vec3d origin = mesh.bounds().center();
  std::vector<std::uint8_t> visited(mesh.triangles.size(), 0), flipped(mesh.triangles.size(), 0);
  std::vector<std::uint32_t> component;
  for (std::uint32_t seed = 0; seed < mesh.triangles.size(); ++seed) {
    if (visited[seed] != 0) continue;
    visited[seed] = 1;
    component.assign(1, seed);
    const bool inside_out = wind_alike(mesh, adjacent, origin, component, visited, flipped) < 0.0;
    for (const std::uint32_t face : component) {
      Triangle& t = mesh.triangles[face];
      if ((flipped[face] != 0) != inside_out) std::swap(t[1], t[2]);
    }
  }
  return mesh;
}

}  // namespace astrolith
