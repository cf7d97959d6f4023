#include "geometry/orient_faces.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "geometry/mesh_edges.h"
#include "geometry/mesh_measure.h"
#include "geometry/mesh_parts.h"

namespace astrolith {
namespace {

// The face across one side of a face, or kNone, and whether the two faces are wound alike.
struct Neighbour {
  static constexpr std::uint32_t kNone = 0xffffffff;
  std::uint32_t face = kNone;
  bool alike = true;
};

struct Components {
  std::vector<std::uint32_t> number;  // (#F) from 0, in the order of their first faces
  std::vector<double> border;         // length of the edges with an odd number of faces
};

void turn(Triangle& t) { std::swap(t[1], t[2]); }

// Winds the faces that can be reached from `seed` alike, and numbers their component.
void wind_alike(TriangleMesh& mesh, const std::vector<std::array<Neighbour, 3>>& adjacent, std::uint32_t seed,
                std::uint32_t component, std::vector<std::uint32_t>& number) {
  std::vector<std::uint32_t> faces{seed};
  std::vector<bool> turned{false};
  number[seed] = component;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    for (const Neighbour& n : adjacent[faces[i]]) {
      if (n.face == Neighbour::kNone || number[n.face] != Neighbour::kNone) continue;
      number[n.face] = component;
      faces.push_back(n.face);
      turned.push_back(turned[i] == n.alike);
    }
  }
  const auto many = static_cast<std::size_t>(std::count(turned.begin(), turned.end(), true));
  const bool as_the_others = 2 * many > faces.size();
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (turned[i] != as_the_others) turn(mesh.triangles[faces[i]]);
  }
}

Components wind_components(TriangleMesh& mesh) {
  std::vector<std::array<Neighbour, 3>> adjacent(mesh.triangles.size());
  const std::vector<TriangleSide> sides = sorted_sides(mesh);
  for_each_edge(sides, [&](std::span<const TriangleSide> edge) {
    if (edge.size() != 2) return;
    const bool alike = edge[0].forward != edge[1].forward;
    adjacent[edge[0].triangle][edge[0].corner] = {edge[1].triangle, alike};
    adjacent[edge[1].triangle][edge[1].corner] = {edge[0].triangle, alike};
  });
  Components components{std::vector<std::uint32_t>(mesh.triangles.size(), Neighbour::kNone), {}};
  std::uint32_t count = 0;
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    if (components.number[f] == Neighbour::kNone) {
      wind_alike(mesh, adjacent, f, count++, components.number);
    }
  }
  components.border.assign(count, 0.0);
  for_each_edge(sides, [&](std::span<const TriangleSide> edge) {
    if (edge.size() % 2 == 0) return;
    const double length = norm(mesh.vertices[edge[0].low] - mesh.vertices[edge[0].high]);
    for (const TriangleSide& side : edge) components.border[components.number[side.triangle]] += length;
  });
  return components;
}

// (#parts) the outermost part around each, or the part itself. Where finding out would take too long, a part
// in the box of the largest belongs to that.
std::vector<std::size_t> outermost(const std::vector<MeshPart>& parts) {
  std::vector<std::size_t> by_volume(parts.size());
  std::iota(by_volume.begin(), by_volume.end(), std::size_t{0});
  std::stable_sort(by_volume.begin(), by_volume.end(), [&](std::size_t a, std::size_t b) {
    return std::abs(parts[a].volume) > std::abs(parts[b].volume);
  });
  std::vector<std::size_t> around(parts.size());
  PartNesting nesting;
  const std::size_t largest = by_volume.front();
  for (std::size_t i = 0; i < by_volume.size(); ++i) {
    const std::size_t inner = by_volume[i];
    around[inner] = inner;
    for (std::size_t j = 0; j < i && around[inner] == inner && !nesting.spent(); ++j) {
      if (nesting.lies_inside(parts[inner], parts[by_volume[j]])) around[inner] = around[by_volume[j]];
    }
    if (nesting.spent() && box_holds(parts[largest].box, parts[inner].box)) around[inner] = largest;
  }
  return around;
}

}  // namespace

TriangleMesh orient_faces(TriangleMesh mesh) {
  if (mesh.triangles.empty()) return mesh;
  const Components components = wind_components(mesh);
  const std::vector<MeshPart> parts = parts_of(mesh, components.number);
  std::vector<char> inside_out(parts.size());
  bool any = false;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const double border = components.border[p];
    const bool has_inside = border == 0.0 || border * border < 0.5 * surface_area(parts[p].mesh);
    inside_out[p] = has_inside && parts[p].volume < 0.0 ? 1 : 0;
    any = any || inside_out[p] != 0;
  }
  if (!any) return mesh;
  const std::vector<std::size_t> around = outermost(parts);
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    if (inside_out[around[components.number[f]]] != 0) turn(mesh.triangles[f]);
  }
  return mesh;
}

}  // namespace astrolith
