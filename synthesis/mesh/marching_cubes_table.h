// The triangles of marching cubes (Lorensen and Cline 1987) for all 256 sign patterns of a cell. The table is
// generated such that any mesh made with it is closed and 2-manifold:
// - Segments cross each face of a cell as the face's four signs alone demand. On an ambiguous face the inside
//   corners are separated. The two cells at a face therefore agree.
// - The segments of a cell close to loops, and each edge vertex lies in exactly one loop.
// - No diagonal in the triangulation of a loop joins two vertices on one face of the cell. The neighbour
//   might use that edge too, and the edge would then carry four triangles.
#pragma once

#include <array>
#include <cstdint>

namespace astrolith {

// Corners are numbered 0 .. 7 with the bits of x (1), y (2) and z (4). Edges are numbered 4 axis + k: edge k
// of an axis starts at the corner whose other two bits, lower axis first, are the bits of k.
struct CellEdge {
  int axis;   // direction of the edge, 0 .. 2
  int lower;  // corner where the edge starts
  int upper;  // corner where the edge ends: lower, with the bit of the axis set
};

constexpr CellEdge cell_edge(int edge) {
  const int axis = edge / 4;
  const int u = axis == 0 ? 1 : 0;
  const int v = axis == 2 ? 1 : 2;
  const int lower = ((edge & 1) << u) | (((edge >> 1) & 1) << v);
  return {axis, lower, lower | (1 << axis)};
}

inline constexpr int kMaxCellTriangles = 5;

struct CellTriangles {
  std::uint8_t count = 0;
  // Three edges for each triangle, counter-clockwise seen from outside the body.
  std::array<std::uint8_t, 3 * kMaxCellTriangles> edges{};
};

// The table is indexed by the signs of a cell: bit c is set where corner c is inside.
using MarchingCubesTable = std::array<CellTriangles, 256>;
const MarchingCubesTable& marching_cubes_table();

}  // namespace astrolith
