#include "synthesis/mesh/marching_cubes_table.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <vector>

namespace astrolith {
namespace {

constexpr int kNoEdge = -1;

bool is_inside(int signs, int corner) { return ((signs >> corner) & 1) != 0; }

// The four corners of a face, counter-clockwise seen from outside the cell. Faces are numbered 2 axis + (0
// low, 1 high).
std::array<int, 4> face_corners(int face) {
  const int axis = face / 2;
  const bool high = face % 2 != 0;
  const int u = 1 << ((axis + 1) % 3);
  const int v = 1 << ((axis + 2) % 3);
  const int base = high ? 1 << axis : 0;
  if (high) return {base, base | u, base | u | v, base | v};
  return {base, base | v, base | u | v, base | u};
}

int edge_between(int corner_a, int corner_b) {
  for (int edge = 0; edge < 12; ++edge) {
    const CellEdge e = cell_edge(edge);
    if ((e.lower == corner_a && e.upper == corner_b) || (e.lower == corner_b && e.upper == corner_a)) {
      return edge;
    }
  }
  throw std::logic_error("corners do not share an edge");
}

// next[e] is the edge that follows e on its loop, with the inside on the left seen from outside the body. The
// face rule: each run of inside corners round a face is cut off by a segment of its own.
std::array<int, 12> link_segments(int signs) {
  std::array<int, 12> next;
  next.fill(kNoEdge);
  for (int face = 0; face < 6; ++face) {
    const std::array<int, 4> corners = face_corners(face);
    for (unsigned i = 0; i < 4; ++i) {
      const int entered = corners[(i + 1) % 4];
      if (is_inside(signs, corners[i]) || !is_inside(signs, entered)) continue;
      unsigned last = i + 1;
      while (is_inside(signs, corners[(last + 1) % 4])) ++last;
      const int way_in = edge_between(corners[i], entered);
      const int way_out = edge_between(corners[last % 4], corners[(last + 1) % 4]);
      next[static_cast<unsigned>(way_in)] = way_out;
    }
  }
  return next;
}

bool on_face(int edge, int face) {
  const CellEdge e = cell_edge(edge);
  const int axis = face / 2;
  return e.axis != axis && ((e.lower >> axis) & 1) == face % 2;
}

bool share_a_face(int edge_a, int edge_b) {
  for (int face = 0; face < 6; ++face) {
    if (on_face(edge_a, face) && on_face(edge_b, face)) return true;
  }
  return false;
}

// The squared distance between the midpoints of two edges, in half cells. The triangulation keeps it small.
int squared_distance(int edge_a, int edge_b) {
  int sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto position = [axis](const CellEdge& e) {
      return ((e.lower >> axis) & 1) + ((e.upper >> axis) & 1);
    };
    const int d = position(cell_edge(edge_a)) - position(cell_edge(edge_b));
    sum += d * d;
  }
  return sum;
}

// The triangulation of a loop with the least sum of squared diagonals among those without a diagonal in a
// face of the cell, by dynamic programming over sub-polygons (Klincsek 1980).
class LoopTriangulation {
 public:
  explicit LoopTriangulation(const std::vector<int>& loop)
      : loop_(loop), cost_(loop.size() * loop.size(), 0), apex_(loop.size() * loop.size(), 0) {
    for (std::size_t span = 2; span < loop.size(); ++span) {
      for (std::size_t i = 0; i + span < loop.size(); ++i) choose_apex(i, i + span);
    }
    if (cost_[loop.size() - 1] >= kForbidden) throw std::logic_error("a loop cannot be triangulated");
  }

  void append_to(CellTriangles& cell) const { append(0, loop_.size() - 1, cell); }

 private:
  static constexpr int kForbidden = 1 << 20;

  void choose_apex(std::size_t i, std::size_t j) {
    int best = std::numeric_limits<int>::max();
    for (std::size_t k = i + 1; k < j; ++k) {
      const int cost = cost_[i * loop_.size() + k] + cost_[k * loop_.size() + j];
      if (cost < best) {
        best = cost;
        apex_[i * loop_.size() + j] = k;
      }
    }
    const bool is_side = i == 0 && j == loop_.size() - 1;
    cost_[i * loop_.size() + j] =
        std::min(kForbidden, best + (is_side ? 0 : diagonal_cost(loop_[i], loop_[j])));
  }

  static int diagonal_cost(int edge_a, int edge_b) {
    return share_a_face(edge_a, edge_b) ? kForbidden : squared_distance(edge_a, edge_b);
  }

  void append(std::size_t i, std::size_t j, CellTriangles& cell) const {
    if (j < i + 2) return;
    const std::size_t k = apex_[i * loop_.size() + j];
    const unsigned first = 3u * cell.count;
    if (first + 3 > cell.edges.size()) throw std::logic_error("too many triangles in a cell");
    cell.edges[first] = static_cast<std::uint8_t>(loop_[i]);
    cell.edges[first + 1] = static_cast<std::uint8_t>(loop_[k]);
    cell.edges[first + 2] = static_cast<std::uint8_t>(loop_[j]);
    ++cell.count;
    append(i, k, cell);
    append(k, j, cell);
  }

  const std::vector<int>& loop_;
  std::vector<int> cost_;          // (n x n) least cost of the sub-polygon i .. j
  std::vector<std::size_t> apex_;  // (n x n) third corner of the triangle on the diagonal i, j
};

CellTriangles triangulate_cell(int signs) {
  CellTriangles cell;
  const std::array<int, 12> next = link_segments(signs);
  std::array<bool, 12> used{};
  for (int start = 0; start < 12; ++start) {
    if (next[static_cast<unsigned>(start)] == kNoEdge || used[static_cast<unsigned>(start)]) continue;
    std::vector<int> loop;
    for (int edge = start; !used[static_cast<unsigned>(edge)]; edge = next[static_cast<unsigned>(edge)]) {
      used[static_cast<unsigned>(edge)] = true;
      loop.push_back(edge);
    }
    LoopTriangulation(loop).append_to(cell);
  }
  return cell;
}

}  // namespace

const MarchingCubesTable& marching_cubes_table() {
  static const MarchingCubesTable table = [] {
    MarchingCubesTable cells;
    for (int signs = 0; signs < 256; ++signs) cells[static_cast<unsigned>(signs)] = triangulate_cell(signs);
    return cells;
  }();
  return table;
}

}  // namespace astrolith
