// One octave of a fractal sum at one point, and bounds of the sums over boxes. The loops over points and the
// threads of a GPU call these functions.
#pragma once

#include <span>

#include "numerics/interval.h"
#include "synthesis/noise/block_noise.h"
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
    case Noise::kWorleyF2MinusF1:
      return with_octave<worley_f2_minus_f1>(o, p.x, p.y, p.z, sum);
    default:
      return with_octave<block_noise>(o, p.x, p.y, p.z, sum);
  }
}
ASTROLITH_HD inline ModulatedSum with_modulated_octave(Noise noise, const NoiseOctave& o, float modulation,
                                                       const Vec3f& p, const ModulatedSum& sum) {
  return noise == Noise::kPerlin
             ? with_modulated_octave<perlin_with_gradient>(o, modulation, p.x, p.y, p.z, sum)
             : with_modulated_octave<simplex_with_gradient>(o, modulation, p.x, p.y, p.z, sum);
}

// The range of a noise and its Lipschitz bound, per unit of the argument. A search over all positions and
// gradients found the largest slopes 6.960 (simplex) and 3.619 (Perlin). A distance, as in Worley noise, has
// the Lipschitz constant 1; no face of a block is steeper than the nearest.
struct NoiseRange {
  double low, high, slope;
};
ASTROLITH_HD inline NoiseRange noise_range(Noise noise) {
  constexpr double kF1 = kWorleyMeanF1, kF2 = kWorleyMeanF2, kSlope = 1.0 / kWorleyFarthest;
  switch (noise) {
    case Noise::kSimplex:
      return {-1.0, 1.0, 7.0};
    case Noise::kPerlin:
      return {-1.0, 1.0, 3.65};
    case Noise::kWorleyF1:
      return {-kF1, 1.0 - kF1, kSlope};
    case Noise::kWorleyF2:
      return {-kF2, 1.0 - kF2, kSlope};
    case Noise::kWorleyF2MinusF1:
      return {kF1 - kF2, 1.0 + kF1 - kF2, 2.0 * kSlope};
    default:
      return {0.0, 1.0, kBlockHeight};
  }
}

// An interval that holds one octave's noise, without its amplitude, for every point of the box. If the box is
// small beside the features of the noise, the value at the centre and the Lipschitz bound are tighter than
// the range.
ASTROLITH_HD inline Interval bound_noise(Noise noise, const NoiseOctave& octave, const Box& box) {
  const NoiseRange range = noise_range(noise);
  const double f = static_cast<double>(octave.frequency);
  const double rounding = 1e-6 * f * largest_coordinate(box);  // error of a float coordinate, cells
  const double spread = range.slope * (0.5 * f * norm(box.extent()) + rounding) + 1e-5;
  if (spread >= 1.0) return {range.low, range.high};
  const Vec3d c = f * box.center() + Vec3d{octave.offset.x, octave.offset.y, octave.offset.z};
  const Vec3f at = to_float(c);
  const NoiseOctave unit{1.0f, 1.0f, 1.0f, octave.seed, {}};
  const double value = static_cast<double>(with_octave(noise, unit, at, 0.0f));
  return {std::max(range.low, value - spread), std::min(range.high, value + spread)};
}

// An interval that holds the sum, modulated or not, for every float point of the box; length units.
ASTROLITH_HD inline Interval bound_octaves(Noise noise, const NoiseOctave* octaves, std::uint32_t count,
                                           const Box& box, bool modulated) {
  Interval sum;
  for (std::uint32_t o = 0; o < count; ++o) {
    Interval values = bound_noise(noise, octaves[o], box);
    if (modulated) values = {std::min(0.0, values.low), std::max(0.0, values.high)};
    const double a = static_cast<double>(octaves[o].amplitude), slack = 1e-5 * std::fabs(a);
    sum = plus(sum, plus(scaled(a, values), {-slack, slack}));
  }
  return sum;
}

// The image of the coordinates low .. high under placed_coordinate() (fractal_noise.h), and of a box.
ASTROLITH_HD inline Interval bound_placed(double low, double high, float domain_low, float domain_high,
                                          float scale, float bias) {
  const double a = clamped(low, double{domain_low}, double{domain_high}),
               b = clamped(high, double{domain_low}, double{domain_high});
  const Interval s = scaled(double{scale}, {a, b});
  return {s.low + double{bias}, s.high + double{bias}};
}
ASTROLITH_HD inline Box bound_placed(const Box& p, const Vec3f& low, const Vec3f& high, const Vec3f& scale,
                                     const Vec3f& bias) {
  const Interval x = bound_placed(p.min.x, p.max.x, low.x, high.x, scale.x, bias.x);
  const Interval y = bound_placed(p.min.y, p.max.y, low.y, high.y, scale.y, bias.y);
  const Interval z = bound_placed(p.min.z, p.max.z, low.z, high.z, scale.z, bias.z);
  return {{x.low, y.low, z.low}, {x.high, y.high, z.high}};
}

// A box that holds the displaced points of `box`. The intervals bound the displacements along each axis;
// `farthest` bounds the displacement of every coordinate. All in length units.
ASTROLITH_HD inline Box displaced_box(const Box& box, const Interval& dx, const Interval& dy,
                                      const Interval& dz, double farthest) {
  const double rounding = 1e-6 * (largest_coordinate(box) + farthest);
  const Vec3d margin{rounding, rounding, rounding};
  return {box.min + Vec3d{dx.low, dy.low, dz.low} - margin,
          box.max + Vec3d{dx.high, dy.high, dz.high} + margin};
}

}  // namespace astrolith
