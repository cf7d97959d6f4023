#include "synthesis/gabor/gabor_texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>

#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "numerics/parallel_for.h"
#include "numerics/portable_angles.h"
#include "synthesis/gabor/gabor_bands.h"
#include "synthesis/gabor/gabor_kernel.h"

namespace astrolith {
namespace {

// A band on the plane. Lengths are in pixels.
struct PlaneBand {
  GaborBand band;
  std::uint32_t seed;
  double cell_x, cell_y;  // sides of a cell
  int wrap_x, wrap_y;     // cells in a period; 0: no period
  double reach;
  int impulses_per_cell;
  float amplitude;
};

// The side, in pixels, of the square that one task makes. The heights of a square stay in the first cache.
inline constexpr int kTextureSquare = 64;

struct TextureSquare {
  int x, y;  // first column and row
  std::array<float, std::size_t{kTextureSquare * kTextureSquare}> height;
};

// The kernel is separable on a grid of pixels: with A = 2 pi f_x dx + phase and B = 2 pi f_y dy,
//
//   e(dx) e(dy) cos(A + B) = [e(dx) cos A] [e(dy) cos B] - [e(dx) sin A] [e(dy) sin B].
//
// An impulse therefore costs a few profile values for each column and row of a square, and two fma for each
// pixel. The positions of many impulses are drawn at once, one in each lane of a vector. The profiles of a
// kernel fill whole vectors: as many lanes for its columns as for its rows.

// Impulses by the hash of their cell, the cell and their number in the cell; and what follows from these.
struct PlaneImpulses {
  static constexpr std::size_t kBatch = 256;  // impulses that are drawn at once
  std::size_t count = 0;
  std::array<std::uint32_t, kBatch> cell_hash, number;
  std::array<int, kBatch> cell_x, cell_y;

  std::array<float, kBatch> offset_x, offset_y;  // of the centre of the square's first pixel, pixels
  std::array<int, kBatch> begin_x, end_x, begin_y, end_y;  // the pixels that the kernel reaches
  std::array<float, kBatch> phase, lobe;                   // uniform in [0, 1)
};

// A uniform number in [0, 1) as unit_float() gives it.
ASTROLITH_KERNEL float to_unit(std::uint32_t hash) {
  return static_cast<float>(static_cast<std::int32_t>(hash >> 8)) * 0x1p-24f;
}

// Places the impulses along one axis: the pixels of the square, counted from `first`, whose centres the
// kernels reach.
ASTROLITH_SIMD_CLONES void place_along(std::size_t n, std::uint32_t axis, double side, double reach,
                                       int first, const std::uint32_t* __restrict cell_hash,
                                       const std::uint32_t* __restrict number, const int* __restrict cell,
                                       float* __restrict offset, int* __restrict begin, int* __restrict end) {
  const double center = first + 0.5, last = kTextureSquare;
#pragma omp simd
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t hash = hash_append(cell_hash[i], number[i]);
    const double at = (cell[i] + static_cast<double>(to_unit(hash_append(hash, axis)))) * side;
    const double low = __builtin_ceil(at - 0.5 - first - reach);
    const double high = __builtin_floor(at - 0.5 - first + reach) + 1.0;
    offset[i] = static_cast<float>(center - at);
    begin[i] = static_cast<int>(low < 0.0 ? 0.0 : low > last ? last : low);
    end[i] = static_cast<int>(high < 0.0 ? 0.0 : high > last ? last : high);
  }
}

ASTROLITH_SIMD_CLONES void draw_lobes(std::size_t n, const std::uint32_t* __restrict cell_hash,
                                      const std::uint32_t* __restrict number, float* __restrict phase,
                                      float* __restrict lobe) {
#pragma omp simd
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t hash = hash_append(cell_hash[i], number[i]);
    phase[i] = to_unit(hash_append(hash, 2));
    lobe[i] = to_unit(hash_append(hash, 3));
  }
}

// One impulse on a square.
struct PlaneImpulse {
  float a, amplitude;
  float offset_x, offset_y, frequency_x, frequency_y, phase;
  int begin_x, end_x, begin_y, end_y;
};

// Adds a kernel that reaches at most kWidth columns and rows: the real part of the product of the column and
// row profiles. The profile is exactly 0 beyond its reach, so that the lanes around the kernel add nothing.
// Wide kernels go in blocks of sixteen lanes, without the blocks that the kernel does not reach.
template <int kWidth>
ASTROLITH_KERNEL void add_kernel(const PlaneImpulse& k, float* __restrict height) {
  constexpr int kBlock = std::min(kWidth, 16), kProfileBlock = std::min(2 * kWidth, 16);
  const int first_x = k.begin_x < kTextureSquare - kWidth ? k.begin_x : kTextureSquare - kWidth;
  const int first_y = k.begin_y < kTextureSquare - kWidth ? k.begin_y : kTextureSquare - kWidth;
  const int begin_x = k.begin_x - first_x, end_x = k.end_x - first_x;
  const int begin_y = kWidth + k.begin_y - first_y, end_y = kWidth + k.end_y - first_y;
  std::array<float, std::size_t{2 * kWidth}> cosine, sine;
  for (int block = 0; block < 2 * kWidth; block += kProfileBlock) {
    const bool in_columns = block < end_x && begin_x < block + kProfileBlock;
    if (!in_columns && !(block < end_y && begin_y < block + kProfileBlock)) continue;
#pragma omp simd
    for (int i = block; i < block + kProfileBlock; ++i) {
      const bool is_column = i < kWidth;
      const int pixel = i + (is_column ? first_x : first_y - kWidth);
      const float u = k.a * (static_cast<float>(pixel) + (is_column ? k.offset_x : k.offset_y));
      const float envelope = (is_column ? 1.0f : k.amplitude) * gabor_profile(u);
      const float turns = math::fma(is_column ? k.frequency_x : k.frequency_y, u, is_column ? k.phase : 0.0f);
      cosine[static_cast<std::size_t>(i)] = envelope * math::cos_turns(turns);
      sine[static_cast<std::size_t>(i)] = envelope * math::sin_turns(turns);
    }
  }
  const int first_block = begin_x / kBlock * kBlock;
  for (int y = begin_y; y < end_y; ++y) {
    const float c = cosine[static_cast<std::size_t>(y)], s = -sine[static_cast<std::size_t>(y)];
    float* row = height + (first_y + y - kWidth) * kTextureSquare + first_x;
    for (int block = first_block; block < end_x; block += kBlock) {
#pragma omp simd
      for (int x = block; x < block + kBlock; ++x) {
        const auto column = static_cast<std::size_t>(x);
        row[x] = math::fma(s, sine[column], math::fma(c, cosine[column], row[x]));
      }
    }
  }
}

// Adds the kernels of impulses that reach the square.
ASTROLITH_SIMD_CLONES void add_kernels(const PlaneImpulse* impulses, std::size_t n,
                                       float* __restrict height) {
  for (std::size_t i = 0; i < n; ++i) {
    const PlaneImpulse& k = impulses[i];
    const int width = k.end_x - k.begin_x, rows = k.end_y - k.begin_y, most = width > rows ? width : rows;
    if (most <= 4) {
      add_kernel<4>(k, height);
    } else if (most <= 8) {
      add_kernel<8>(k, height);
    } else if (most <= 16) {
      add_kernel<16>(k, height);
    } else if (most <= 32) {
      add_kernel<32>(k, height);
    } else {
      add_kernel<64>(k, height);
    }
  }
}

void add_impulses(const PlaneBand& band, PlaneImpulses& drawn, TextureSquare& square) {
  PlaneImpulses& d = drawn;
  const std::size_t n = d.count;
  place_along(n, 0, band.cell_x, band.reach, square.x, d.cell_hash.data(), d.number.data(), d.cell_x.data(),
              d.offset_x.data(), d.begin_x.data(), d.end_x.data());
  place_along(n, 1, band.cell_y, band.reach, square.y, d.cell_hash.data(), d.number.data(), d.cell_y.data(),
              d.offset_y.data(), d.begin_y.data(), d.end_y.data());
  draw_lobes(n, d.cell_hash.data(), d.number.data(), d.phase.data(), d.lobe.data());
  std::array<PlaneImpulse, PlaneImpulses::kBatch> reaching;
  std::size_t count = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (d.begin_x[i] >= d.end_x[i] || d.begin_y[i] >= d.end_y[i]) continue;
    const GaborBand::Lobe& lobe = band.band.draw(d.lobe[i]);
    reaching[count++] = {static_cast<float>(band.band.a),
                         band.amplitude,
                         d.offset_x[i],
                         d.offset_y[i],
                         lobe.frequency_x,
                         lobe.frequency_y,
                         d.phase[i],
                         d.begin_x[i],
                         d.end_x[i],
                         d.begin_y[i],
                         d.end_y[i]};
  }
  add_kernels(reaching.data(), count, square.height.data());
  d.count = 0;
}

int wrapped(int cell, int wrap) { return wrap == 0 ? cell : ((cell % wrap) + wrap) % wrap; }

// Adds the noise of a band to the heights of a square.
void add_band(const PlaneBand& band, TextureSquare& square) {
  const auto cell_at = [](double pixel, double side) { return static_cast<int>(std::floor(pixel / side)); };
  const int last_x = cell_at(square.x + kTextureSquare + band.reach, band.cell_x);
  const int last_y = cell_at(square.y + kTextureSquare + band.reach, band.cell_y);
  PlaneImpulses drawn;
  for (int cy = cell_at(square.y - band.reach, band.cell_y); cy <= last_y; ++cy) {
    for (int cx = cell_at(square.x - band.reach, band.cell_x); cx <= last_x; ++cx) {
      const std::uint32_t cell = hash_cell(band.seed, wrapped(cx, band.wrap_x), wrapped(cy, band.wrap_y), 0);
      for (int j = 0; j < band.impulses_per_cell; ++j) {
        const std::size_t i = drawn.count++;
        drawn.cell_hash[i] = cell;
        drawn.number[i] = static_cast<std::uint32_t>(j);
        drawn.cell_x[i] = cx;
        drawn.cell_y[i] = cy;
        if (drawn.count == PlaneImpulses::kBatch) add_impulses(band, drawn, square);
      }
    }
  }
  add_impulses(band, drawn, square);
}

// c(n, f) of torus_variance(). `frequency` is f / a, and `period` is n in units of 1/a.
double periodic_sum(double period, double frequency) {
  double sum = 1.0;
  for (int j = 1; j * period < 2.0 * static_cast<double>(kGaborReach); ++j) {
    const double tau = j * period;
    sum += 2.0 * gabor_profile_correlation(tau) * portable::cos(2.0 * std::numbers::pi * frequency * tau);
  }
  return sum;
}

// The factor that gives the periodic noise the variance of the endless noise.
double torus_gain(const GaborLayer& layer, const TextureOptions& options) {
  if (options.period_width == 0 && options.period_height == 0) return 1.0;
  // A period far below the size of a kernel would need thousands of copies of the kernel at each pixel.
  constexpr double kCopies = 16.0;
  double largest = 0.0;
  for (const GaborBand& band : gabor_bands(layer)) largest = std::max(largest, 2.0 * kGaborReach / band.a);
  const bool tiny = kCopies * std::min(options.period_width, options.period_height) < largest;
  const double variance = tiny ? 0.0 : torus_variance(layer, options.period_width, options.period_height);
  if (!(variance >= 0.5 && variance <= 2.0)) {
    throw InputError("texture size " + std::to_string(options.period_width) + "x" +
                     std::to_string(options.period_height) +
                     ": too small a period for this layer, whose lobes are narrower than the steps between "
                     "the frequencies that repeat; make the texture larger");
  }
  return 1.0 / std::sqrt(variance);
}

// Sets the side of the cells near its ideal value, such that a whole number of cells fits into the period.
void set_cells(const TextureOptions& options, PlaneBand& band) {
  const double ideal = kGaborPlaneCell / band.band.a;
  const auto set = [ideal](int period, double& side, int& wrap) {
    wrap = period == 0 ? 0 : std::max(1, static_cast<int>(std::lround(period / ideal)));
    side = period == 0 ? ideal : static_cast<double>(period) / wrap;
  };
  set(options.period_width, band.cell_x, band.wrap_x);
  set(options.period_height, band.cell_y, band.wrap_y);
}

// The number of impulses in a cell. A period smaller than a kernel has as many impulses as there are
// elsewhere under one kernel: with fewer the noise would not be Gaussian.
int count_impulses(const GaborLayer& layer, const PlaneBand& band) {
  const double area = band.cell_x * band.cell_y * band.band.a * band.band.a;  // in units of 1/a^2
  const double wanted = layer.impulses_per_kernel * area / kGaborKernelArea;
  const double cells = static_cast<double>(band.wrap_x) * band.wrap_y;
  const double least = cells > 0.0 ? std::ceil(layer.impulses_per_kernel / cells) : 1.0;
  return static_cast<int>(std::max(least, std::round(wanted)));
}

std::vector<PlaneBand> plane_bands(const GaborLayer& layer, const TextureOptions& options) {
  const double gain = torus_gain(layer, options);
  std::vector<PlaneBand> bands;
  for (GaborBand& band : gabor_bands(layer)) {
    PlaneBand plane{std::move(band), 0, 0.0, 0.0, 0, 0, 0.0, 0, 0.0f};
    const GaborBand& b = plane.band;
    plane.seed = gabor_band_seed(options.seed, options.stream, b.bandwidth);
    plane.reach = static_cast<double>(kGaborReach) / b.a;
    set_cells(options, plane);
    plane.impulses_per_cell = count_impulses(layer, plane);
    // The variance is density K^2/2 (integral of e^2)^2; the factor 1/2 comes from the uniform phase.
    const double energy = kGaborProfileEnergy / b.a;
    const double density = plane.impulses_per_cell / (plane.cell_x * plane.cell_y);
    plane.amplitude =
        static_cast<float>(gain * layer.height_rms * std::sqrt(2.0 * b.variance_share / density) / energy);
    bands.push_back(std::move(plane));
  }
  return bands;
}

void store(const TextureSquare& square, int width, int height, float clip, std::vector<float>& texture) {
  const int columns = std::min(kTextureSquare, width - square.x),
            rows = std::min(kTextureSquare, height - square.y);
  for (int y = 0; y < rows; ++y) {
    const auto* row = &square.height[static_cast<std::size_t>(y * kTextureSquare)];
    float* out = &texture[static_cast<std::size_t>(square.y + y) * static_cast<std::size_t>(width) +
                          static_cast<std::size_t>(square.x)];
    for (int x = 0; x < columns; ++x) out[x] = math::clamp(row[x], -clip, clip);
  }
}

}  // namespace

double gabor_profile_correlation(double tau) {
  constexpr int kSteps = 256;
  const double reach = static_cast<double>(kGaborReach);
  const double begin = tau - reach;  // both profiles are nonzero between begin and reach
  if (!(begin < reach)) return 0.0;
  const double step = (reach - begin) / kSteps;
  double sum = 0.0;  // trapezoidal rule; values and slopes are 0 at both ends
  for (int i = 1; i < kSteps; ++i) {
    const double u = begin + i * step;
    sum += static_cast<double>(gabor_profile(static_cast<float>(u))) *
           static_cast<double>(gabor_profile(static_cast<float>(u - tau)));
  }
  return sum * step / kGaborProfileEnergy;
}

double torus_variance(const GaborLayer& layer, int width, int height) {
  double total = 0.0;
  for (const GaborBand& band : gabor_bands(layer)) {
    double before = 0.0;
    for (const GaborBand::Lobe& lobe : band.lobes) {
      const double share = band.variance_share * (static_cast<double>(lobe.cumulative) - before);
      before = static_cast<double>(lobe.cumulative);
      total += share * periodic_sum(band.a * width, static_cast<double>(lobe.frequency_x)) *
               periodic_sum(band.a * height, static_cast<double>(lobe.frequency_y));
    }
  }
  return total;
}

std::vector<float> synthesize_texture(const GaborLayer& layer, int width, int height,
                                      const TextureOptions& options, const Progress& progress) {
  if (width < 1 || height < 1) {
    throw InputError("texture size " + std::to_string(width) + "x" + std::to_string(height) +
                     ": must be at least 1x1");
  }
  const std::vector<PlaneBand> bands = plane_bands(layer, options);
  const float clip = static_cast<float>(kGaborClip * layer.height_rms);
  std::vector<float> texture(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  const int squares_x = (width - 1) / kTextureSquare + 1, squares_y = (height - 1) / kTextureSquare + 1;
  for (int ty = 0; ty < squares_y; ++ty) {
    if (!report(progress, static_cast<double>(ty) / squares_y, "texture")) return texture;
    parallel_for(0, squares_x, [&](std::int64_t tx) {
      TextureSquare square{static_cast<int>(tx) * kTextureSquare, ty * kTextureSquare, {}};
      for (const PlaneBand& band : bands) add_band(band, square);
      store(square, width, height, clip, texture);
    });
  }
  report(progress, 1.0, "texture");
  return texture;
}

}  // namespace astrolith
