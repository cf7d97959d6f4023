// Coordinates displaced by fractal noise (thesis eq. 4.6): p + warp(p). Each axis is displaced by its own sum
// of octaves of simplex noise.
#pragma once

#include <cstdint>

#include "numerics/arrays.h"
#include "recipe/recipe.h"
#include "synthesis/noise/noise_frame.h"
#include "synthesis/noise/octave_bounds.h"

namespace astrolith {

// The displacement of one body or layer. Octaves too fine for the float coordinates of displaced points are
// left out.
struct CoordinateWarp {
  ArrayRange<NoiseOctave> octaves[3];  // displacements along x, y and z, length units
  Vec3f low, high;                     // a point outside is displaced as the nearest point inside
  double bound = 0.0;                  // largest displacement of a coordinate, length units
  // |p + warp(p) - q - warp(q)| <= lipschitz_bound |p - q|, in exact arithmetic.
  double lipschitz_bound = 1.0;
  NoiseDetail detail;
};

// `seed` is the seed of the layer or body whose coordinates are warped. The noises of the warp are
// independent of the noises made from that seed. The domain of the frame holds the displaced points p +
// warp(p) of interest. The octaves are stored in `arrays`.
CoordinateWarp make_coordinate_warp(const Warp& warp, std::uint32_t seed, const NoiseFrame& frame,
                                    ArrayStore& arrays);

// The displaced point p + warp(p), length units.
ASTROLITH_HD inline Vec3f warped(const CoordinateWarp& warp, const ArrayView& arrays, const Vec3f& p) {
  const Vec3f q{math::clamp(p.x, warp.low.x, warp.high.x), math::clamp(p.y, warp.low.y, warp.high.y),
                math::clamp(p.z, warp.low.z, warp.high.z)};
  const auto along = [&](const ArrayRange<NoiseOctave>& octaves, float coordinate) {
    const NoiseOctave* octave = arrays[octaves];
    for (std::uint32_t o = 0; o < octaves.count; ++o) {
      coordinate = with_octave(Noise::kSimplex, octave[o], q, coordinate);
    }
    return coordinate;
  };
  return {along(warp.octaves[0], p.x), along(warp.octaves[1], p.y), along(warp.octaves[2], p.z)};
}

// Writes (wx, wy, wz)[i] = p_i + warp(p_i) for n points. The output arrays overlap no other array.
void warp_points(const CoordinateWarp& warp, const ArrayView& arrays, int n, const float* x, const float* y,
                 const float* z, float* wx, float* wy, float* wz);

// A box that holds p + warp(p) for every float point p of `box`.
ASTROLITH_HD inline Box warped_box(const CoordinateWarp& warp, const ArrayView& arrays, const Box& box) {
  const Box inside = moved_into(box, warp.low, warp.high);
  const auto along = [&](const ArrayRange<NoiseOctave>& octaves) {
    return bound_octaves(Noise::kSimplex, arrays[octaves], octaves.count, inside, false);
  };
  return displaced_box(box, along(warp.octaves[0]), along(warp.octaves[1]), along(warp.octaves[2]),
                       warp.bound);
}

}  // namespace astrolith
