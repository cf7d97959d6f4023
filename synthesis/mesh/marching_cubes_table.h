// The triangles of marching cubes (Lorensen and Cline 1987) for all 256 sign patterns of a cell, generated
// rather than typed in, such that any mesh made with it is closed and 2-manifold:
//  - each face of a cell is crossed by segments that depend on the face's four signs alone (on an ambiguous
//    face the inside corners are separated), so the two cells at a face always agree;
//  - the segments of a cell close to loops, each edge vertex lying in exactly one;
//  - no diagonal of a loop's triangulation joins two vertices on one face of the cell, since the neighbour
//    might use that edge too and it would then carry four triangles.
#pragma once

#include <array>
#include <cstdint>

namespace astrolith {

// Corners are numbered 0 .. 7 with the bits of x (1), y (2) and z (4). Edges are numbered 4 axis + k: edge k
// of an axis starts at the corner whose other two bits, lower axis first, are the bits of k.
struct CellEdge {
  int axis;   // 0 .. 2: the direction it runs in
  int lower;  // corner where it starts
  int upper;  // corner where it ends: lower with the axis's bit set
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
  // Three edges a triangle, counter-clockwise seen from outside the body.
  std::array<std::uint8_t, 3 * kMaxCellTriangles> edges{};
};

// Index: bit c is set where corner c is inside.
using MarchingCubesTable = std::array<CellTriangles, 256>;
const MarchingCubesTable& marching_cubes_table();

}  // namespace astrolith
