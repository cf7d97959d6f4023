// One octave of a fractal sum at one point. The loops over points and the threads of a GPU call these
// functions.
#pragma once

#include "synthesis/noise/noise_octaves.h"
#include "synthesis/noise/perlin_noise.h"
#include "synthesis/noise/simplex_noise.h"
#include "synthesis/noise/worley_noise.h"

namespace astrolith {

// Returns sum + amplitude noise(frequency p + offset), for a noise known at compile time.
template <auto noise>
ASTROLITH_KERNEL float with_octave(const NoiseOctave& o, float x, float y, float z, float sum) {
  return math::fma(o.amplitude,
                   noise(math::fma(o.frequency, x, o.offset.x), math::fma(o.frequency, y, o.offset.y),
                         math::fma(o.frequency, z, o.offset.z), o.seed),
                   sum);
}

// A sum of octaves and its slope.
struct ModulatedSum {
  float value;
  Vec3f slope;
};

// Adds amplitude noise / (1 + modulation |slope|^2) to the value of the sum. `slope` is the slope of the sum
// with this octave included.
template <auto noise>
ASTROLITH_KERNEL ModulatedSum with_modulated_octave(const NoiseOctave& o, float modulation, float x, float y,
                                                    float z, const ModulatedSum& sum) {
  const NoiseSample s = noise(math::fma(o.frequency, x, o.offset.x), math::fma(o.frequency, y, o.offset.y),
                              math::fma(o.frequency, z, o.offset.z), o.seed);
  const Vec3f d{math::fma(o.slope, s.gradient.x, sum.slope.x), math::fma(o.slope, s.gradient.y, sum.slope.y),
                math::fma(o.slope, s.gradient.z, sum.slope.z)};
  const float steepness = math::fma(d.x, d.x, math::fma(d.y, d.y, d.z * d.z));
  return {sum.value + o.amplitude * s.value / math::fma(modulation, steepness, 1.0f), d};
}

// The functions above for a noise known at run time. Only simplex and Perlin noise can be modulated.
ASTROLITH_HD inline float with_octave(Noise noise, const NoiseOctave& o, const Vec3f& p, float sum) {
  switch (noise) {
    case Noise::kSimplex:
      return with_octave<simplex_noise>(o, p.x, p.y, p.z, sum);
    case Noise::kPerlin:
      return with_octave<perlin_noise>(o, p.x, p.y, p.z, sum);
    case Noise::kWorleyF1:
      return with_octave<worley_f1>(o, p.x, p.y, p.z, sum);
    case Noise::kWorleyF2:
      return with_octave<worley_f2>(o, p.x, p.y, p.z, sum);
    default:
      return with_octave<worley_f2_minus_f1>(o, p.x, p.y, p.z, sum);
  }
}
ASTROLITH_HD inline ModulatedSum with_modulated_octave(Noise noise, const NoiseOctave& o, float modulation,
                                                       const Vec3f& p, const ModulatedSum& sum) {
  return noise == Noise::kPerlin
             ? with_modulated_octave<perlin_with_gradient>(o, modulation, p.x, p.y, p.z, sum)
             : with_modulated_octave<simplex_with_gradient>(o, modulation, p.x, p.y, p.z, sum);
}

}  // namespace astrolith
