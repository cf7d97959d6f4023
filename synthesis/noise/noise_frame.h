// The frame in which a noise counts its cells.
//
// Lattices and impulses belong to the body's frame, so that they are the same in every mesh of a body. Float
// coordinates of that frame hold cells up to 2^20 cells from its origin. A patch therefore evaluates fine
// noise at coordinates relative to its own centre. The cell of the centre has a 64-bit number, and the other
// cells are counted from it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "numerics/interval.h"

namespace astrolith {

// In a patch, noise with more of its finest lengths than this between the body's origin and the domain's
// border is evaluated in the frame of the patch. Up to here float coordinates of the body's frame keep eight
// bits within the finest length.
inline constexpr double kMostPreciseCells = 0x1p16;

// Doubles hold positions to 2^-13 of a cell up to this many cells from the body's origin.
inline constexpr double kFarthestCell = 0x1p40;

struct NoiseFrame {
  Box domain;          // points of interest, relative to `origin`, length units
  Vec3d origin{};      // in the body's frame, length units
  bool moved = false;  // whether points are relative to an origin of their own; false: origin is 0

  // The body's frame.
  NoiseFrame(const Box& body_domain) : domain(body_domain) {}
  // The frame of a patch.
  NoiseFrame(const Box& local_domain, const Vec3d& patch_origin)
      : domain(local_domain), origin(patch_origin), moved(true) {}

  // Cells are resolved if the quotient of this distance and their side is at most kLargestCell.
  double farthest() const { return farthest_distance(largest_coordinate(domain), origin); }
  // Returns farthest() of a frame with this origin and this largest coordinate, in any unit.
  static double farthest_distance(double largest, const Vec3d& origin) {
    return std::max(largest, largest_coordinate(Box{origin, origin}) * (kLargestCell / kFarthestCell));
  }
};

// The cell of a lattice that holds an origin, and the position of the origin within the cell. Both are in
// cells along the edges of the lattice.
struct OriginCell {
  std::int64_t x = 0, y = 0, z = 0;
  Vec3d rest;
};
// Expects |at| <= kFarthestCell.
inline OriginCell origin_cell(const Vec3d& at) {
  const Vec3d cell{std::floor(at.x), std::floor(at.y), std::floor(at.z)};
  return {static_cast<std::int64_t>(cell.x), static_cast<std::int64_t>(cell.y),
          static_cast<std::int64_t>(cell.z), at - cell};
}

// How fine a noise is, and what its frame could not hold of it.
struct NoiseDetail {
  double finest = std::numeric_limits<double>::infinity();  // shortest wave or narrowest cell, length units
  double left_out = 0.0;  // share of the layer's variance in parts that were left out, [0, 1]
};

}  // namespace astrolith
