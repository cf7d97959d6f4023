// A fractal layer of the recipe, ready for evaluation over many points (thesis algorithms 4 and 5).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "numerics/scalar_math.h"
#include "recipe/recipe.h"
#include "synthesis/noise/coordinate_warp.h"
#include "synthesis/noise/noise_octaves.h"

namespace astrolith {

// A coordinate of the noise from one of space.
ASTROLITH_KERNEL float placed_coordinate(float p, float low, float high, float scale, float bias) {
  return math::fma(math::clamp(p, low, high), scale, bias);
}

class FractalNoise {
 public:
  // `layer_index` is the layer's number in the recipe: layers of one seed are independent. Points outside
  // `domain`, where no surface is, are moved to its border; octaves too fine for float coordinates within it
  // are left out (noise_octaves.h).
  FractalNoise(const FractalLayer& layer, std::uint64_t seed, int layer_index, const Box& domain);

  // height[i] = n(p_i), length units.
  void evaluate(int n, const float* x, const float* y, const float* z, float* height) const;

  // The same at the points origin + (x, y, z) to the digits of x, y and z: cells of the lattices are counted
  // from the origin's. Expects points within the domain, and a layer that has this form: one without a warp.
  void evaluate_near(const Vec3d& origin, int n, const float* x, const float* y, const float* z,
                     float* height) const;
  bool has_near_form() const { return !warp_; }

  // |n(p)| never exceeds this.
  double height_bound() const { return height_bound_; }

  // n(p) at every float point of a box.
  Interval bound_heights(const Box& box) const;

  // What it is made of. The warp may be null.
  struct Parts {
    Noise noise;
    const CoordinateWarp* warp;
    Vec3f scale, bias, domain_min, domain_max;
    std::span<const NoiseOctave> octaves;
    float gradient_modulation;
  };
  Parts parts() const {
    return {noise_,   warp_ ? &*warp_ : nullptr, scale_, bias_, domain_min_, domain_max_,
            octaves_, gradient_modulation_};
  }

 private:
  void evaluate_chunk(int n, const float* x, const float* y, const float* z, float* height) const;
  // The sum over octaves at coordinates of the noise.
  void add_octaves(const std::vector<NoiseOctave>& octaves, int n, const float* x, const float* y,
                   const float* z, float* height) const;

  Noise noise_;
  std::optional<CoordinateWarp> warp_;
  Vec3f scale_, bias_, domain_min_, domain_max_;
  std::vector<NoiseOctave> octaves_;
  double height_bound_ = 0.0;
  float gradient_modulation_;
};

}  // namespace astrolith
