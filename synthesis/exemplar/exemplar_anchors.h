// The anchors of an exemplar layer: a body-centred cubic lattice in space, whose points each hold a tangent
// frame and an offset into the image. The code that finds and weights the anchors of a point is plain and
// scalar, for loops and GPUs.
//
// Points y are counted in edges of the lattice's cubic cells. The lattice has the primitive vectors
// b1 = (-1, 1, 1) / 2, b2 = (1, -1, 1) / 2, b3 = (1, 1, -1) / 2, and y = q1 b1 + q2 b2 + q3 b3 with
// q = (y2 + y3, y1 + y3, y1 + y2). Within the cell floor(q), the order of the fractions f of q tells the
// point's tetrahedron, as in simplex noise. Its corners are 0, b of the largest fraction, that plus b of the
// next one, and b1 + b2 + b3. The barycentric weights are the differences of the sorted fractions.
#pragma once

#include <cstdint>
#include <string>

#include "numerics/arrays.h"
#include "numerics/interval.h"
#include "recipe/noise_layers.h"
#include "synthesis/noise/noise_frame.h"

namespace astrolith {

struct ExemplarGround;  // synthesis/exemplar/exemplar_ground.h

// The coordinates of a point in the image, in pixels, are (u, v) . (y - anchor) + offset.
struct ExemplarAnchor {
  float ux, uy, uz, offset_u;  // pixels per edge of a cubic cell
  float vx, vy, vz, offset_v;
};

// The most anchors of a layer: 64 MB.
inline constexpr double kMostExemplarAnchors = 0x1p21;

// The anchors of a box of cubic cells. Each cell has two: one at its lowest corner, one in its middle.
struct ExemplarLattice {
  Vec3f cells_per_length;  // along each axis
  Vec3f first;             // where the frame's origin lies in the cell that cells are counted from, in cells
  std::int32_t low[3] = {0, 0, 0};   // lowest cell of the box
  std::int32_t size[3] = {0, 0, 0};  // number of cells of the box along each axis
  ArrayRange<ExemplarAnchor> anchors;
};

// A point in its tetrahedron.
struct ExemplarPlace {
  float x, y, z;        // offset from the first corner, in edges of cubic cells
  float weight[4];      // of the corners, >= 0; sum 1
  std::int32_t anchor;  // number of the anchor at the first corner
  std::int32_t
      order;  // which of the fractions are below which: bit 0: f1 < f2, bit 1: f1 < f3, bit 2: f2 < f3
};

// The number of the anchor at the lattice point (i b1 + j b2 + k b3). A point outside the box has the number
// of an anchor at the border.
ASTROLITH_KERNEL std::int32_t anchor_number(const ExemplarLattice& l, std::int32_t i, std::int32_t j,
                                            std::int32_t k) {
  const std::int32_t x = j + k - i, y = i + k - j, z = i + j - k;  // in half edges: all even or all odd
  const auto cell = [&](std::int32_t half_edges, int axis) {
    const std::int32_t c = (half_edges >> 1) - l.low[axis];
    return c < 0 ? 0 : c < l.size[axis] ? c : l.size[axis] - 1;
  };
  return 2 * ((cell(z, 2) * l.size[1] + cell(y, 1)) * l.size[0] + cell(x, 0)) + (x & 1);
}

ASTROLITH_KERNEL ExemplarPlace exemplar_place(const ExemplarLattice& l, float px, float py, float pz) {
  const float x = math::fma(px, l.cells_per_length.x, l.first.x),
              y = math::fma(py, l.cells_per_length.y, l.first.y),
              z = math::fma(pz, l.cells_per_length.z, l.first.z);
  const float q1 = y + z, q2 = x + z, q3 = x + y;
  const float i = math::floor(q1), j = math::floor(q2), k = math::floor(q3);
  const float f1 = q1 - i, f2 = q2 - j, f3 = q3 - k;
  const float greatest = math::max(math::max(f1, f2), f3), least = math::min(math::min(f1, f2), f3);
  const float middle = math::max(math::min(f1, f2), math::min(math::max(f1, f2), f3));
  ExemplarPlace place;
  place.x = 0.5f * (f2 + f3 - f1);
  place.y = 0.5f * (f1 + f3 - f2);
  place.z = 0.5f * (f1 + f2 - f3);
  place.weight[0] = 1.0f - greatest;
  place.weight[1] = greatest - middle;
  place.weight[2] = middle - least;
  place.weight[3] = least;
  place.order = (f1 < f2 ? 1 : 0) | (f1 < f3 ? 2 : 0) | (f2 < f3 ? 4 : 0);
  place.anchor = anchor_number(l, static_cast<std::int32_t>(i), static_cast<std::int32_t>(j),
                               static_cast<std::int32_t>(k));
  return place;
}

// The corner of a tetrahedron: its offset from the first corner in half edges.
struct ExemplarCorner {
  std::int32_t x, y, z;
};
// Corner number c, 0 to 3, for an order of ExemplarPlace.
ASTROLITH_KERNEL ExemplarCorner exemplar_corner(int c, std::int32_t order) {
  // Bits of the lattice steps of the second and the third corner: 1 for b1, 2 for b2, 4 for b3.
  const bool below12 = (order & 1) != 0, below13 = (order & 2) != 0, below23 = (order & 4) != 0;
  const int second = !below12 && !below13 ? 1 : below12 && !below23 ? 2 : 4;
  const int left_out = below12 && below13 ? 1 : !below12 && below23 ? 2 : 4;  // the least fraction
  const int steps = c == 0 ? 0 : c == 1 ? second : c == 2 ? 7 & ~left_out : 7;
  const std::int32_t i = steps & 1, j = (steps >> 1) & 1, k = steps >> 2;
  return {j + k - i, i + k - j, i + j - k};
}

// The anchor at a corner of the tetrahedron whose first corner has the anchor number `first`. Its offsets are
// such that (u, v) are taken of the offset from the first corner.
ASTROLITH_KERNEL ExemplarAnchor anchor_at_corner(const ExemplarLattice& l, const ExemplarAnchor* anchors,
                                                 std::int32_t first, std::int32_t order, int c) {
  const ExemplarCorner corner = exemplar_corner(c, order);
  const std::int32_t half = first & 1, cell = first >> 1;
  const std::int32_t cx = cell % l.size[0], cy = cell / l.size[0] % l.size[1],
                     cz = cell / l.size[0] / l.size[1];
  const auto moved = [&](std::int32_t at, std::int32_t step, std::int32_t size) {
    const std::int32_t to = (2 * at + half + step) >> 1;
    return to < 0 ? 0 : to < size ? to : size - 1;
  };
  const std::int32_t number =
      2 * ((moved(cz, corner.z, l.size[2]) * l.size[1] + moved(cy, corner.y, l.size[1])) * l.size[0] +
           moved(cx, corner.x, l.size[0])) +
      ((half + corner.x) & 1);
  ExemplarAnchor a = anchors[number];
  const float x = -0.5f * static_cast<float>(corner.x), y = -0.5f * static_cast<float>(corner.y),
              z = -0.5f * static_cast<float>(corner.z);
  a.offset_u = math::fma(a.ux, x, math::fma(a.uy, y, math::fma(a.uz, z, a.offset_u)));
  a.offset_v = math::fma(a.vx, x, math::fma(a.vy, y, math::fma(a.vz, z, a.offset_v)));
  return a;
}

// The edge of a cubic cell for a spacing of anchors: two anchors lie in each cell.
double exemplar_edge(double anchor_spacing);
// The edge for a layer with pixels, length units.
double exemplar_edge(const ExemplarLayer& layer);

// How far beyond points the layer looks at the slopes below it: the farthest anchor of a point lies within an
// edge of it. Length units.
inline double reach_below(const ExemplarLayer& layer) { return 2.0 * exemplar_edge(layer); }

// The cells of a lattice that hold the anchors of all points of a frame.
struct ExemplarCells {
  ExemplarLattice lattice;             // without its anchors; empty where they are too many
  std::int64_t origin[3] = {0, 0, 0};  // number of the cell that cells are counted from
  double anchors = 0.0;                // their number; too many above kMostExemplarAnchors
};
// `edge` has the edges of a cubic cell along the axes, length units. Expects that origin_cell() can count
// the cells up to the frame's origin.
ExemplarCells exemplar_cells(const NoiseFrame& frame, const Vec3d& edge);

// The frames and offsets of the anchors on a body. An anchor has the tangent frame of the bare surface near
// it: u points east about +z, v south. Far from every metaball the frame is that of a sphere about the middle
// of the body. Where layers below make elevations, the frame is turned by the least angle to the slope of
// the layered surface, smoothed over half the spacing of anchors. `seed` is hash_seed() of the layer.
std::vector<ExemplarAnchor> anchors_on_body(const ExemplarLayer& layer, const ExemplarCells& cells,
                                            std::uint32_t seed, const ExemplarGround& ground);

// The frames and offsets of the anchors about a plane: u points along x, v along y. The cells repeat after
// `period` cells along x and y; 0: never.
std::vector<ExemplarAnchor> anchors_on_plane(const ExemplarLayer& layer, const ExemplarCells& cells,
                                             std::uint32_t seed, const int (&period)[2]);

}  // namespace astrolith
