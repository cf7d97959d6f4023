#include "synthesis/noise/noise_octaves.h"

#include <algorithm>
#include <cmath>

#include "numerics/hash_random.h"
#include "synthesis/noise/octave_bounds.h"

namespace astrolith {
namespace {

constexpr double kSteepestOctave = 1e12;  // keeps the squares of slopes finite in a float

// Each noise has its own loop: a choice inside the loop would keep it from vectorising.
template <auto noise>
ASTROLITH_SIMD_CLONES void add_noise(const NoiseOctave& octave, int n, const float* __restrict x,
                                     const float* __restrict y, const float* __restrict z,
                                     float* __restrict sum) {
  const NoiseOctave o = octave;
#pragma omp simd
  for (int i = 0; i < n; ++i) sum[i] = with_octave<noise>(o, x[i], y[i], z[i], sum[i]);
}

template <auto noise>
ASTROLITH_SIMD_CLONES void add_modulated_noise(const NoiseOctave& octave, float modulation, int n,
                                               const float* __restrict x, const float* __restrict y,
                                               const float* __restrict z, float* __restrict dx,
                                               float* __restrict dy, float* __restrict dz,
                                               float* __restrict sum) {
  const NoiseOctave o = octave;
#pragma omp simd
  for (int i = 0; i < n; ++i) {
    const ModulatedSum s =
        with_modulated_octave<noise>(o, modulation, x[i], y[i], z[i], {sum[i], {dx[i], dy[i], dz[i]}});
    dx[i] = s.slope.x;
    dy[i] = s.slope.y;
    dz[i] = s.slope.z;
    sum[i] = s.value;
  }
}

}  // namespace

std::vector<NoiseOctave> make_octaves(double frequency, double amplitude, int count, double gain,
                                      double lacunarity, const OctaveSeeds& seeds, double farthest) {
  std::vector<NoiseOctave> octaves;
  double slope = 1.0;
  for (int o = 0; o < count; ++o) {
    if (!(frequency * farthest <= kLargestCell)) break;
    const std::uint32_t stream = seeds.first_stream + static_cast<std::uint32_t>(o) * seeds.stream_step;
    octaves.push_back({static_cast<float>(frequency),
                       static_cast<float>(amplitude),
                       static_cast<float>(std::min(slope, kSteepestOctave)),
                       hash_append(seeds.seed, stream),
                       {}});
    frequency *= lacunarity;
    amplitude *= gain;
    slope *= lacunarity * gain;
  }
  return octaves;
}

std::vector<NoiseOctave> local_octaves(Noise noise, std::span<const NoiseOctave> octaves_at_origin,
                                       const Vec3d& q) {
  std::vector<NoiseOctave> octaves(octaves_at_origin.begin(), octaves_at_origin.end());
  for (NoiseOctave& o : octaves) {
    const Vec3d at = static_cast<double>(o.frequency) * q;
    Vec3d cell{std::floor(at.x), std::floor(at.y), std::floor(at.z)};
    Vec3d lattice = cell;
    if (noise == Noise::kSimplex) {
      // The simplex lattice is skewed by a third of the sum of the coordinates. This third must be a whole
      // number.
      cell.z -= std::fmod(std::fmod(cell.x + cell.y + cell.z, 3.0) + 3.0, 3.0);
      const double skew = (cell.x + cell.y + cell.z) / 3.0;
      lattice = cell + Vec3d{skew, skew, skew};
    }
    const Vec3d rest = at - cell;
    o.offset = to_float(rest);
    o.seed += lattice_step(static_cast<std::int64_t>(lattice.x), static_cast<std::int64_t>(lattice.y),
                           static_cast<std::int64_t>(lattice.z));
  }
  return octaves;
}

double share_left_out(std::size_t kept, int count, double gain) {
  double left = 0.0, total = 0.0, power = 1.0;
  for (std::size_t o = 0; o < static_cast<std::size_t>(count); ++o, power *= gain * gain) {
    total += power;
    if (o >= kept) left += power;
  }
  return left / total;
}

double sum_bound(std::span<const NoiseOctave> octaves) {
  double bound = 0.0;
  for (const NoiseOctave& o : octaves) bound += std::fabs(static_cast<double>(o.amplitude));
  return bound;
}

double slope_bound(Noise noise, std::span<const NoiseOctave> octaves) {
  double bound = 0.0;
  for (const NoiseOctave& o : octaves) {
    bound += noise_range(noise).slope *
             std::fabs(static_cast<double>(o.amplitude) * static_cast<double>(o.frequency));
  }
  return bound;
}

void add_octave(Noise noise, const NoiseOctave& octave, int n, const float* x, const float* y, const float* z,
                float* sum) {
  switch (noise) {
    case Noise::kSimplex:
      return add_noise<simplex_noise>(octave, n, x, y, z, sum);
    case Noise::kPerlin:
      return add_noise<perlin_noise>(octave, n, x, y, z, sum);
    case Noise::kWorleyF1:
      return add_noise<worley_f1>(octave, n, x, y, z, sum);
    case Noise::kWorleyF2:
      return add_noise<worley_f2>(octave, n, x, y, z, sum);
    case Noise::kWorleyF2MinusF1:
      return add_noise<worley_f2_minus_f1>(octave, n, x, y, z, sum);
    case Noise::kWorleyBlocks:
      return add_noise<block_noise>(octave, n, x, y, z, sum);
  }
}

void add_modulated_octave(Noise noise, const NoiseOctave& octave, float modulation, int n, const float* x,
                          const float* y, const float* z, float* slope_x, float* slope_y, float* slope_z,
                          float* sum) {
  const auto add = noise == Noise::kPerlin ? add_modulated_noise<perlin_with_gradient>
                                           : add_modulated_noise<simplex_with_gradient>;
  add(octave, modulation, n, x, y, z, slope_x, slope_y, slope_z, sum);
}

}  // namespace astrolith
