#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "geometry/mesh_edges.h"
#include "geometry/mesh_topology.h"
#include "tasks/repair/mesh_repair_internal.h"

namespace astrolith {
namespace {

constexpr std::size_t kMostComponents = 64;

// Sorts the components into bodies, and counts those that overlap or lie inside others in `scene`. (#parts)
// the body of each, named by one of its components.
std::vector<std::uint32_t> sorted_into_bodies(const std::vector<SurfacePart>& parts, SceneBodies& scene) {
  std::vector<std::uint32_t> by_volume(parts.size());
  std::iota(by_volume.begin(), by_volume.end(), std::uint32_t{0});
  std::stable_sort(by_volume.begin(), by_volume.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::abs(parts[a].volume) > std::abs(parts[b].volume);
  });
  DisjointSets sets(parts.size());
  PartNesting nesting;
  for (std::size_t j = 1; j < by_volume.size(); ++j) {
    const SurfacePart& smaller = parts[by_volume[j]];
    bool overlaps = false, undecided = false;
    int around = 0;  // the winding number of all that lies around it
    for (std::size_t i = 0; i < std::min(j, kMostComponents); ++i) {
      const SurfacePart& larger = parts[by_volume[i]];
      if (!boxes_touch(larger.box, smaller.box)) continue;
      const bool unknown = j >= kMostComponents || nesting.spent();
      undecided = undecided || unknown;
      const double inside = unknown ? 0.0 : nesting.share_inside(smaller, larger);
      const bool within = inside == 1.0 && nesting.lies_inside(smaller, larger);
      const bool reaches = inside > 0.0 || (!unknown && nesting.share_inside(larger, smaller) > 0.0);
      if (unknown || reaches || nesting.spent()) sets.unite(by_volume[i], by_volume[j]);
      if (within) around += larger.volume > 0.0 ? 1 : -1;
      overlaps = overlaps || (reaches && !within);
    }
    undecided = undecided || nesting.spent();
    if (undecided) {
      ++scene.undecided;
    } else if (overlaps) {
      ++scene.overlapping;
    } else if (around > 0) {
      ++(smaller.volume > 0.0 ? scene.nested : scene.cavities);
    }
  }
  std::vector<std::uint32_t> body(parts.size());
  for (std::uint32_t c = 0; c < parts.size(); ++c) body[c] = sets.find(c);
  return body;
}

}  // namespace

SceneBodies find_bodies(TriangleMesh mesh) {
  const std::vector<std::uint32_t> number = triangle_components(mesh);
  SceneBodies scene;
  scene.largest = std::move(mesh);
  if (std::all_of(number.begin(), number.end(), [](std::uint32_t c) { return c == 0; })) return scene;
  const std::vector<SurfacePart> parts = split_parts(scene.largest, number);
  const std::vector<std::uint32_t> body = sorted_into_bodies(parts, scene);
  std::vector<double> volumes(parts.size(), 0.0);  // at the component that names the body
  double all = 0.0;
  for (std::size_t c = 0; c < parts.size(); ++c) {
    volumes[body[c]] += parts[c].volume;
    all += parts[c].volume;
  }
  scene.bodies = 0;
  for (std::uint32_t c = 0; c < parts.size(); ++c) scene.bodies += body[c] == c;
  if (scene.bodies == 1) return scene;
  const auto first =
      static_cast<std::uint32_t>(std::max_element(volumes.begin(), volumes.end()) - volumes.begin());
  scene.volume_share = volumes[first] / all;
  std::vector<Triangle> kept;
  for (std::size_t f = 0; f < number.size(); ++f) {
    if (body[number[f]] == first) kept.push_back(scene.largest.triangles[f]);
  }
  scene.largest.triangles = std::move(kept);
  return scene;
}

}  // namespace astrolith
