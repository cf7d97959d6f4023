#include "estimation/shape/target/surface_components.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "geometry/mesh_topology.h"

namespace astrolith {
namespace {

std::string counted_things(std::int64_t count, const std::string& thing) {
  return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
}

// About this many vertices of a fit's component vote for the nearest component of the target.
constexpr std::size_t kVotes = 100;

// A connected component of the fit's mesh.
struct FitComponent {
  double volume = 0.0;  // negative for a cavity
  Box box;
  std::vector<std::uint32_t> vertices;  // the corners of its triangles, with repetitions
};

double cone_volume(const TriangleMesh& mesh, const Triangle& t) {
  return dot(mesh.vertices[t[0]], cross(mesh.vertices[t[1]], mesh.vertices[t[2]])) / 6.0;
}

std::vector<FitComponent> find_components(const TriangleMesh& mesh) {
  const std::vector<std::uint32_t> triangle_component = triangle_components(mesh);
  std::vector<FitComponent> components;
  for (std::size_t t = 0; t < triangle_component.size(); ++t) {
    const std::size_t number = triangle_component[t];
    if (number >= components.size()) components.resize(number + 1);
    FitComponent& component = components[number];
    component.volume += cone_volume(mesh, mesh.triangles[t]);
    for (const std::uint32_t v : mesh.triangles[t]) {
      component.box.extend(mesh.vertices[v]);
      component.vertices.push_back(v);
    }
  }
  return components;
}

// (#components of the target) volumes; negative for the wall of a cavity.
std::vector<double> component_volumes(const TargetBody& target) {
  std::vector<double> volumes(static_cast<std::size_t>(target.components), 0.0);
  for (std::size_t t = 0; t < target.mesh.triangles.size(); ++t) {
    volumes[target.triangle_component[t]] += cone_volume(target.mesh, target.mesh.triangles[t]);
  }
  return volumes;
}

std::size_t nearest_component(const TargetBody& target, const TriangleMesh& fit,
                              const FitComponent& component) {
  std::vector<int> votes(static_cast<std::size_t>(target.components), 0);
  if (votes.size() == 1) return 0;
  const std::size_t stride = std::max<std::size_t>(1, component.vertices.size() / kVotes);
  for (std::size_t k = 0; k < component.vertices.size(); k += stride) {
    const ClosestPoint closest = target.tree.closest(fit.vertices[component.vertices[k]]);
    ++votes[target.triangle_component[closest.triangle]];
  }
  return static_cast<std::size_t>(std::max_element(votes.begin(), votes.end()) - votes.begin());
}

StrayComponent make_stray(const TriangleMesh& fit, const FitComponent& component) {
  StrayComponent stray{component.volume < 0.0, component.box.center(), 0.0};
  for (const std::uint32_t v : component.vertices) {
    stray.radius = std::max(stray.radius, norm(fit.vertices[v] - stray.center));
  }
  return stray;
}

}  // namespace

std::string PartsAndHandles::words() const {
  return counted_things(parts, "part") + " and " + counted_things(handles, "handle");
}

PartsAndHandles parts_and_handles(const TargetBody& target) {
  return {target.components, analyze_topology(target.mesh).genus};
}

PartsAndHandles parts_and_handles(const MeshTopology& topology) {
  return {topology.components, topology.genus};
}

ComponentComparison compare_components(const TargetBody& target, const TriangleMesh& fit) {
  const std::vector<double> wanted = component_volumes(target);
  std::vector<FitComponent> components = find_components(fit);
  std::stable_sort(components.begin(), components.end(), [](const FitComponent& a, const FitComponent& b) {
    return std::abs(a.volume) > std::abs(b.volume);
  });
  std::vector<bool> found(wanted.size(), false);
  ComponentComparison comparison;
  for (const FitComponent& component : components) {
    const std::size_t nearest = nearest_component(target, fit, component);
    const bool alike = (component.volume < 0.0) == (wanted[nearest] < 0.0);
    if (!alike || found[nearest]) {
      comparison.strays.push_back(make_stray(fit, component));
    } else {
      found[nearest] = true;
    }
  }
  comparison.missing = std::count(found.begin(), found.end(), false);
  return comparison;
}

}  // namespace astrolith
