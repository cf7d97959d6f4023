// The edges of a triangle mesh as a sorted array, and disjoint sets: the tools for counting topology.
#pragma once

#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace astrolith {

// One side of one triangle. Sides of the same edge have the same low and high vertex.
struct TriangleSide {
  std::uint32_t low, high;  // low < high
  std::uint32_t triangle;
  std::uint8_t corner;  // first corner: the side runs from corner to corner + 1
  bool forward;         // the side starts at low

  bool same_edge(const TriangleSide& o) const { return low == o.low && high == o.high; }
  std::uint32_t low_corner() const { return 3 * triangle + (forward ? corner : (corner + 1u) % 3); }
  std::uint32_t high_corner() const { return 3 * triangle + (forward ? (corner + 1u) % 3 : corner); }
};

inline bool is_degenerate(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

// Throws InputError for a triangle that names a vertex which does not exist.
void check_indices(const TriangleMesh& mesh);

// The sides of all triangles that name three different vertices, sorted by edge and then by triangle.
std::vector<TriangleSide> sorted_sides(const TriangleMesh& mesh);

// Calls visit(span of the sides of one edge) for each edge in order.
template <typename Visit>
void for_each_edge(const std::vector<TriangleSide>& sides, const Visit& visit) {
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end].same_edge(sides[begin])) ++end;
    visit(std::span<const TriangleSide>(&sides[begin], end - begin));
  }
}

// Union-find with path halving; the smallest member represents its set.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), 0u); }
  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void unite(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    if (a < b) parent_[b] = a;
    if (b < a) parent_[a] = b;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace astrolith
