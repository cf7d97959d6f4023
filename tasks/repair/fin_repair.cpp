#include <utility>
#include <vector>

#include "geometry/mesh_edges.h"
#include "geometry/mesh_measure.h"
#include "tasks/repair/mesh_repair_internal.h"

namespace astrolith {
namespace {

constexpr double kLargestFin = 0.05, kLargestDebris = 0.01;  // shares of the area
constexpr int kFinRounds = 8;                                // a fin may stand on a fin

// Where a facet's patch is open, and where it hangs on an edge of more than two facets.
struct Patches {
  DisjointSets sets;
  std::vector<char> open, hangs;  // (#F) valid at each set's first facet
  std::vector<double> area;       // (#F) likewise
  double whole = 0.0;
};

Patches find_patches(const TriangleMesh& mesh, bool across_all_edges) {
  const std::size_t count = mesh.triangles.size();
  Patches patches{DisjointSets(count), std::vector<char>(count), std::vector<char>(count),
                  std::vector<double>(count), 0.0};
  const std::vector<TriangleSide> sides = sorted_sides(mesh);
  for_each_edge(sides, [&](std::span<const TriangleSide> edge) {
    if (edge.size() != 2 && !across_all_edges) return;
    for (const TriangleSide& side : edge.subspan(1)) patches.sets.unite(edge[0].triangle, side.triangle);
  });
  for_each_edge(sides, [&](std::span<const TriangleSide> edge) {
    for (const TriangleSide& side : edge) {
      if (edge.size() == 1) patches.open[patches.sets.find(side.triangle)] = 1;
      if (edge.size() > 2) patches.hangs[patches.sets.find(side.triangle)] = 1;
    }
  });
  for (std::uint32_t f = 0; f < count; ++f) {
    const double area = triangle_area(mesh, mesh.triangles[f]);
    patches.area[patches.sets.find(f)] += area;
    patches.whole += area;
  }
  return patches;
}

// Drops the facets for which drop(facet) holds and returns how many.
template <typename Drop>
std::int64_t drop_facets(WithoutFins& result, const Drop& drop) {
  std::vector<Triangle> kept;
  kept.reserve(result.mesh.triangles.size());
  for (std::uint32_t f = 0; f < result.mesh.triangles.size(); ++f) {
    const Triangle& triangle = result.mesh.triangles[f];
    if (drop(f)) {
      result.dropped_area += triangle_area(result.mesh, triangle);
    } else {
      kept.push_back(triangle);
    }
  }
  const auto dropped = static_cast<std::int64_t>(result.mesh.triangles.size() - kept.size());
  result.dropped_facets += dropped;
  result.mesh.triangles = std::move(kept);
  return dropped;
}

}  // namespace

WithoutFins without_fins(TriangleMesh mesh) {
  WithoutFins result{std::move(mesh)};
  for (int round = 0; round < kFinRounds; ++round) {
    Patches patches = find_patches(result.mesh, false);
    const auto is_fin = [&](std::uint32_t f) {
      const std::uint32_t p = patches.sets.find(f);
      return patches.open[p] != 0 && patches.hangs[p] != 0 && patches.area[p] <= kLargestFin * patches.whole;
    };
    if (drop_facets(result, is_fin) == 0) break;
  }
  return result;
}

WithoutFins without_debris(TriangleMesh mesh) {
  WithoutFins result{std::move(mesh)};
  Patches pieces = find_patches(result.mesh, true);
  drop_facets(result, [&](std::uint32_t f) {
    const std::uint32_t p = pieces.sets.find(f);
    return pieces.open[p] != 0 && pieces.area[p] <= kLargestDebris * pieces.whole;
  });
  return result;
}

}  // namespace astrolith
