// A fractal layer of the recipe (thesis algorithms 4 and 5): a sum of octaves of noise. It is evaluated at
// one point, over many points at once, and as bounds over boxes.
#pragma once

#include <cstdint>

#include "numerics/arrays.h"
#include "numerics/scalar_math.h"
#include "recipe/recipe.h"
#include "synthesis/noise/coordinate_warp.h"
#include "synthesis/noise/noise_traits.h"
#include "synthesis/noise/octave_bounds.h"

namespace astrolith {

// The argument of the noise along one axis, from the coordinate p of a point: scale clamp(p, low, high) +
// bias.
ASTROLITH_KERNEL float placed_coordinate(float p, float low, float high, float scale, float bias) {
  return math::fma(math::clamp(p, low, high), scale, bias);
}

struct FractalNoise {
  static constexpr NoiseTraits kTraits{.on_surface = false,
                                       .lifts = false,
                                       .has_heights = true,
                                       .bounded_by_box = true,
                                       .local_form = true,
                                       .lists = NoiseLists::kNone};

  Noise noise = Noise::kSimplex;
  bool warped = false;
  CoordinateWarp warp;
  Vec3f low, high;  // points outside are moved to the border, after the warp
  Vec3f scale, bias;
  ArrayRange<NoiseOctave> octaves;
  float gradient_modulation = 0.0f;
  double height_bound = 0.0;  // bound of |n(p)|, length units
  NoiseDetail detail;

  // Whether evaluate_local_heights() accepts this noise.
  bool has_local_form() const { return !warped; }
};

// `layer_index` is the layer's number in the recipe; layers of one seed are independent. The domain of the
// frame holds the surface; points outside it are moved to its border. Octaves too fine for float coordinates
// within the domain are left out (noise_octaves.h).
FractalNoise make_noise(const FractalLayer& layer, std::uint64_t seed, int layer_index,
                        const NoiseFrame& frame, ArrayStore& arrays);

// The height n(p), length units.
ASTROLITH_HD inline float height_at(const FractalNoise& n, const ArrayView& arrays, const Vec3f& at) {
  const Vec3f p = n.warped ? warped(n.warp, arrays, at) : at;
  const Vec3f q{placed_coordinate(p.x, n.low.x, n.high.x, n.scale.x, n.bias.x),
                placed_coordinate(p.y, n.low.y, n.high.y, n.scale.y, n.bias.y),
                placed_coordinate(p.z, n.low.z, n.high.z, n.scale.z, n.bias.z)};
  const NoiseOctave* octaves = arrays[n.octaves];
  ModulatedSum sum{};
  for (std::uint32_t o = 0; o < n.octaves.count; ++o) {
    if (n.gradient_modulation == 0.0f) {
      sum.value = with_octave(n.noise, octaves[o], q, sum.value);
    } else {
      sum = with_modulated_octave(n.noise, octaves[o], n.gradient_modulation, q, sum);
    }
  }
  return sum.value;
}

// Writes height[i] = n(p_i), length units. The loop is vectorised and gives the same bits as height_at.
void evaluate_heights(const FractalNoise& n, const ArrayView& arrays, int count, const float* x,
                      const float* y, const float* z, float* height);

// The noise relative to an origin: its n(p) is n(origin + p) of the given noise. Lattice cells are counted
// from the cell of the origin, so that the heights resolve the float steps of p. The points must lie within
// the domain, and has_local_form() must hold.
FractalNoise local_form(const FractalNoise& noise, const Vec3d& origin, ArrayStore& arrays);

// Writes height[i] = n(origin + (x, y, z)[i]). The bits are those of the local_form(), and so are the
// conditions.
void evaluate_local_heights(const FractalNoise& n, const ArrayView& arrays, const Vec3d& origin, int count,
                            const float* x, const float* y, const float* z, float* height);

// An interval that holds n(p) for every float point p of the box, length units.
ASTROLITH_HD inline Interval bound_heights(const FractalNoise& n, const ArrayView& arrays, const Box& box) {
  const Box p = n.warped ? warped_box(n.warp, arrays, box) : box;
  return bound_octaves(n.noise, arrays[n.octaves], n.octaves.count,
                       bound_placed(p, n.low, n.high, n.scale, n.bias), n.gradient_modulation != 0.0f);
}

}  // namespace astrolith
