#include "estimation/shape/target/outer_surface.h"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "geometry/mesh_measure.h"
#include "geometry/mesh_topology.h"
#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

// SurfaceTree takes the union of this many components at most.
constexpr std::size_t kMaxComponents = 64;

struct Component {
  TriangleMesh mesh;            // all vertices of the whole mesh, and the component's own triangles
  std::vector<Vec3d> vertices;  // the corners of its triangles, with repetitions
};

// Returns an empty list if there is one component, or if there are too many.
std::vector<Component> separate(const TriangleMesh& mesh, const std::vector<std::uint32_t>& component) {
  const std::size_t count = std::size_t{1} + *std::max_element(component.begin(), component.end());
  if (count < 2 || count > kMaxComponents) return {};
  std::vector<Component> components(count);
  for (Component& one : components) one.mesh.vertices = mesh.vertices;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Component& own = components[component[t]];
    own.mesh.triangles.push_back(mesh.triangles[t]);
    for (const std::uint32_t v : mesh.triangles[t]) own.vertices.push_back(mesh.vertices[v]);
  }
  return components;
}

bool reaches_into(const Component& component, const SurfaceTree& other) {
  return std::any_of(component.vertices.begin(), component.vertices.end(),
                     [&](const Vec3d& p) { return other.signed_distance(p) > 0.0; });
}

// (#components) the component of the union that each component of the mesh belongs to, numbered from 0.
std::vector<std::uint32_t> groups_of_union(const std::vector<Component>& components) {
  std::vector<std::uint32_t> group(components.size());
  std::iota(group.begin(), group.end(), 0u);
  for (std::size_t b = 0; b < components.size(); ++b) {
    const SurfaceTree tree(components[b].mesh);
    for (std::size_t a = 0; a < components.size(); ++a) {
      // std::replace takes references, so it needs copies: `group` changes while it runs.
      const std::uint32_t from = group[a], to = group[b];
      if (from != to && reaches_into(components[a], tree)) std::replace(group.begin(), group.end(), from, to);
    }
  }
  std::vector<std::uint32_t> names = group;
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  for (std::uint32_t& g : group) {
    g = static_cast<std::uint32_t>(std::lower_bound(names.begin(), names.end(), g) - names.begin());
  }
  return group;
}

std::int64_t count_of(const std::vector<std::uint32_t>& numbers) {
  return std::int64_t{1} + *std::max_element(numbers.begin(), numbers.end());
}

TriangleMesh without_buried(const TriangleMesh& mesh, const SurfaceTree& tree, double depth) {
  std::vector<char> buried(mesh.triangles.size());
  parallel_for(
      0, static_cast<std::int64_t>(buried.size()),
      [&](std::int64_t t) {
        const Triangle& v = mesh.triangles[static_cast<std::size_t>(t)];
        const Vec3d centroid =
            (mesh.vertices[v[0]] + mesh.vertices[v[1]] + mesh.vertices[v[2]]) * (1.0 / 3.0);
        buried[static_cast<std::size_t>(t)] = tree.signed_distance(centroid) > depth ? 1 : 0;
      },
      64);
  TriangleMesh outer{mesh.vertices, {}, {}};
  for (std::size_t t = 0; t < buried.size(); ++t) {
    if (buried[t] == 0) outer.triangles.push_back(mesh.triangles[t]);
  }
  return outer;
}

}  // namespace

OuterSurface outer_surface(const TriangleMesh& mesh, const SurfaceTree& tree, double depth) {
  std::vector<std::uint32_t> component_of_triangle = triangle_components(mesh);
  const std::vector<Component> components = separate(mesh, component_of_triangle);
  const bool solid = std::all_of(components.begin(), components.end(),
                                 [](const Component& one) { return volume(one.mesh) > 0.0; });
  if (components.empty() || !solid) {
    return {mesh, count_of(component_of_triangle), std::move(component_of_triangle)};
  }
  const std::vector<std::uint32_t> group = groups_of_union(components);
  for (std::uint32_t& component : component_of_triangle) component = group[component];
  return {without_buried(mesh, tree, depth), count_of(group), std::move(component_of_triangle)};
}

}  // namespace astrolith
