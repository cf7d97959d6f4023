// The edges of triangles that need not be a surface, each with the facets that share it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <span>
#include <tuple>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace astrolith {

// The side of a facet from its corner `corner` to the next one.
struct FacetSide {
  std::uint32_t low, high;  // the vertices, low < high
  std::uint32_t facet;
  std::uint32_t corner;  // 0 .. 2
};

// Sorted by vertices, then by facet. No facet may name a vertex twice.
inline std::vector<FacetSide> sorted_facet_sides(const TriangleMesh& mesh) {
  std::vector<FacetSide> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.triangles[f][k], b = mesh.triangles[f][(k + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), f, k});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const FacetSide& a, const FacetSide& b) {
    return std::tie(a.low, a.high, a.facet) < std::tie(b.low, b.high, b.facet);
  });
  return sides;
}

// Calls visit(sides of one edge) for every edge.
template <typename Visit>
void for_each_soup_edge(const std::vector<FacetSide>& sides, const Visit& visit) {
  for (std::size_t i = 0, j = 0; i < sides.size(); i = j) {
    while (j < sides.size() && sides[j].low == sides[i].low && sides[j].high == sides[i].high) ++j;
    visit(std::span<const FacetSide>(sides).subspan(i, j - i));
  }
}

// Sets of facets that are joined one by one.
class FacetSets {
 public:
  explicit FacetSets(std::size_t facets) : parent_(facets) {
    std::iota(parent_.begin(), parent_.end(), std::uint32_t{0});
  }
  std::uint32_t find(std::uint32_t f) {
    while (parent_[f] != f) f = parent_[f] = parent_[parent_[f]];
    return f;
  }
  void unite(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace astrolith
