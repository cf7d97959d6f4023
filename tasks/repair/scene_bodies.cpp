#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "geometry/mesh_edges.h"
#include "geometry/mesh_measure.h"
#include "geometry/mesh_topology.h"
#include "geometry/surface/winding_number.h"
#include "tasks/repair/scene_bodies_internal.h"

namespace astrolith {
namespace {

constexpr std::size_t kMostComponents = 64;
// Vertices of one component that are looked for in another.
constexpr std::size_t kMostVertices = 64;
// Solid angles of triangles that are summed in all. Components whose boxes touch count for one body after it.
constexpr double kMostAngles = 5e7;

struct Component {
  TriangleMesh mesh;  // all vertices of the scene's mesh that it uses
  Box box;
  double volume = 0.0;
};

std::vector<Component> components_of(const TriangleMesh& mesh, const std::vector<std::uint32_t>& number) {
  std::vector<Component> components(1 + *std::max_element(number.begin(), number.end()));
  constexpr std::uint32_t kUnseen = 0xffffffff;
  std::vector<std::uint32_t> place(mesh.vertices.size(), kUnseen);
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    Component& component = components[number[f]];
    Triangle triangle = mesh.triangles[f];
    for (std::uint32_t& v : triangle) {
      if (place[v] == kUnseen) {
        place[v] = static_cast<std::uint32_t>(component.mesh.vertices.size());
        component.mesh.vertices.push_back(mesh.vertices[v]);
        component.box.extend(mesh.vertices[v]);
      }
      v = place[v];
    }
    component.mesh.triangles.push_back(triangle);
  }
  for (Component& component : components) component.volume = volume(component.mesh);
  return components;
}

// Whether vertices of `a` lie inside `b`, by some of those in the part that both boxes share.
bool reaches_into(const Component& a, const Component& b, double& angles_left) {
  const Box common = common_part(a.box, b.box);
  std::vector<Vec3d> near;
  for (const Vec3d& p : a.mesh.vertices) {
    if (boxes_touch(common, {p, p})) near.push_back(p);
  }
  const std::size_t step = near.size() / kMostVertices + 1;
  for (std::size_t i = 0; i < near.size(); i += step) {
    angles_left -= static_cast<double>(b.mesh.triangles.size());
    if (angles_left < 0.0) return true;
    if (std::abs(winding_number(b.mesh, near[i])) > 0.5) return true;
  }
  return false;
}

// (#components) the body of each component, named by one of its components.
std::vector<std::uint32_t> bodies_of(const std::vector<Component>& components) {
  std::vector<std::uint32_t> by_volume(components.size());
  std::iota(by_volume.begin(), by_volume.end(), std::uint32_t{0});
  std::stable_sort(by_volume.begin(), by_volume.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::abs(components[a].volume) > std::abs(components[b].volume);
  });
  DisjointSets sets(components.size());
  double angles_left = kMostAngles;
  for (std::size_t i = 0; i < std::min(by_volume.size(), kMostComponents); ++i) {
    for (std::size_t j = i + 1; j < by_volume.size(); ++j) {
      const Component &a = components[by_volume[i]], &b = components[by_volume[j]];
      if (!boxes_touch(a.box, b.box) || sets.find(by_volume[i]) == sets.find(by_volume[j])) continue;
      if (j >= kMostComponents || reaches_into(b, a, angles_left) || reaches_into(a, b, angles_left)) {
        sets.unite(by_volume[i], by_volume[j]);
      }
    }
  }
  std::vector<std::uint32_t> body(components.size());
  for (std::uint32_t c = 0; c < components.size(); ++c) body[c] = sets.find(c);
  return body;
}

}  // namespace

LargestBody largest_body(TriangleMesh mesh) {
  const std::vector<std::uint32_t> number = triangle_components(mesh);
  if (std::all_of(number.begin(), number.end(), [](std::uint32_t c) { return c == 0; })) {
    return {std::move(mesh)};
  }
  const std::vector<Component> components = components_of(mesh, number);
  const std::vector<std::uint32_t> body = bodies_of(components);
  std::vector<double> volumes(components.size(), 0.0);  // at the component that names the body
  double all = 0.0;
  for (std::size_t c = 0; c < components.size(); ++c) {
    volumes[body[c]] += components[c].volume;
    all += components[c].volume;
  }
  LargestBody largest{std::move(mesh)};
  largest.bodies = 0;
  for (std::uint32_t c = 0; c < components.size(); ++c) largest.bodies += body[c] == c;
  if (largest.bodies == 1) return largest;
  const auto first =
      static_cast<std::uint32_t>(std::max_element(volumes.begin(), volumes.end()) - volumes.begin());
  largest.volume_share = volumes[first] / all;
  std::vector<Triangle> kept;
  for (std::size_t f = 0; f < number.size(); ++f) {
    if (body[number[f]] == first) kept.push_back(largest.mesh.triangles[f]);
  }
  largest.mesh.triangles = std::move(kept);
  return largest;
}

}  // namespace astrolith
