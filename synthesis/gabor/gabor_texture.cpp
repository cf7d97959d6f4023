// The kernel is separable on a grid of pixels: with A = 2 pi f_x dx + phase and B = 2 pi f_y dy,
//
//   e(dx) e(dy) cos(A + B) = [e(dx) cos A] [e(dy) cos B] - [e(dx) sin A] [e(dy) sin B].
//
// An impulse therefore costs a few profile values for each column and row of a tile, and two fma for each
// pixel.
#include "synthesis/gabor/gabor_texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "numerics/parallel_for.h"
#include "synthesis/gabor/gabor_bands.h"
#include "synthesis/gabor/gabor_kernel.h"
#include "synthesis/gabor/gabor_tiling.h"

namespace astrolith {
namespace {

// The side, in pixels, of the square tile that one task makes. The heights of a tile stay in the first cache.
constexpr int kTile = 64;

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

// The factor that gives the periodic noise the variance of the endless noise.
double tiling_gain(const GaborLayer& layer, const TextureOptions& options) {
  if (options.period_width == 0 && options.period_height == 0) return 1.0;
  // A period far below the size of a kernel would need thousands of copies of the kernel at each pixel.
  constexpr double kCopies = 16.0;
  double largest = 0.0;
  for (const GaborBand& band : gabor_bands(layer)) largest = std::max(largest, 2.0 * kGaborReach / band.a);
  const bool tiny = kCopies * std::min(options.period_width, options.period_height) < largest;
  const double variance = tiny ? 0.0 : tiled_variance(layer, options.period_width, options.period_height);
  if (!(variance >= 0.5 && variance <= 2.0)) {
    throw InputError("texture size " + std::to_string(options.period_width) + "x" +
                     std::to_string(options.period_height) +
                     ": too small a period for this layer, whose lobes are narrower than the steps between "
                     "the frequencies that repeat; make the texture larger");
  }
  return 1.0 / std::sqrt(variance);
}

struct Tile {
  int x, y;  // first column and row
  std::array<float, kTile * kTile> height;
};

// The cosine and sine parts of the kernel along one axis of a tile, for the pixels begin .. end - 1.
struct AxisProfile {
  std::array<float, kTile> cosine, sine;
  int begin, end;
};

ASTROLITH_SIMD_CLONES void fill_profile(float offset, float a, float frequency, float phase, float amplitude,
                                        int begin, int end, float* __restrict cosine,
                                        float* __restrict sine) {
#pragma omp simd
  for (int i = begin; i < end; ++i) {
    const float u = a * (static_cast<float>(i) + offset);
    const float envelope = amplitude * gabor_profile(u);
    const float turns = math::fma(frequency, u, phase);
    cosine[i] = envelope * math::cos_turns(turns);
    sine[i] = envelope * math::sin_turns(turns);
  }
}

// Adds the kernel to the heights: the real part of the product of the column and row profiles.
ASTROLITH_SIMD_CLONES void add_product(const AxisProfile& columns, const AxisProfile& rows,
                                       float* __restrict height) {
  for (int y = rows.begin; y < rows.end; ++y) {
    const float c = rows.cosine[static_cast<std::size_t>(y)];
    const float s = -rows.sine[static_cast<std::size_t>(y)];
    float* row = height + y * kTile;
    const float* column_cosine = columns.cosine.data();
    const float* column_sine = columns.sine.data();
#pragma omp simd
    for (int x = columns.begin; x < columns.end; ++x) {
      row[x] = math::fma(s, column_sine[x], math::fma(c, column_cosine[x], row[x]));
    }
  }
}

// The range of pixels, counted from `first`, whose centres a kernel at `center` reaches. The range is widened
// to whole vectors: the profile is exactly 0 beyond its reach, and whole vectors cost less than remainders.
void set_range(const PlaneBand& band, double center, int first, AxisProfile& axis) {
  constexpr int kVector = 16;
  const double relative = center - 0.5 - first;
  const int begin = static_cast<int>(std::clamp(std::ceil(relative - band.reach), 0.0, double{kTile}));
  const int end = static_cast<int>(std::clamp(std::floor(relative + band.reach) + 1.0, 0.0, double{kTile}));
  const int width = (std::max(end - begin, 0) + kVector - 1) / kVector * kVector;
  axis.begin = std::min(begin, kTile - width);
  axis.end = axis.begin + width;
}

void add_impulse(const PlaneBand& band, std::uint32_t hash, int cell_x, int cell_y, Tile& tile) {
  const double x = (cell_x + static_cast<double>(unit_float(hash_append(hash, 0)))) * band.cell_x;
  const double y = (cell_y + static_cast<double>(unit_float(hash_append(hash, 1)))) * band.cell_y;
  AxisProfile columns, rows;
  set_range(band, x, tile.x, columns);
  set_range(band, y, tile.y, rows);
  if (columns.begin >= columns.end || rows.begin >= rows.end) return;
  const float phase = unit_float(hash_append(hash, 2));
  const GaborBand::Lobe& lobe = band.band.draw(unit_float(hash_append(hash, 3)));
  const float a = static_cast<float>(band.band.a);
  fill_profile(static_cast<float>(tile.x + 0.5 - x), a, lobe.frequency_x, phase, 1.0f, columns.begin,
               columns.end, columns.cosine.data(), columns.sine.data());
  fill_profile(static_cast<float>(tile.y + 0.5 - y), a, lobe.frequency_y, 0.0f, band.amplitude, rows.begin,
               rows.end, rows.cosine.data(), rows.sine.data());
  add_product(columns, rows, tile.height.data());
}

int wrapped(int cell, int wrap) { return wrap == 0 ? cell : ((cell % wrap) + wrap) % wrap; }

void add_band(const PlaneBand& band, Tile& tile) {
  const auto cell_of = [](double pixel, double side) { return static_cast<int>(std::floor(pixel / side)); };
  const int last_x = cell_of(tile.x + kTile + band.reach, band.cell_x);
  const int last_y = cell_of(tile.y + kTile + band.reach, band.cell_y);
  for (int cy = cell_of(tile.y - band.reach, band.cell_y); cy <= last_y; ++cy) {
    for (int cx = cell_of(tile.x - band.reach, band.cell_x); cx <= last_x; ++cx) {
      const std::uint32_t cell = hash_cell(band.seed, wrapped(cx, band.wrap_x), wrapped(cy, band.wrap_y), 0);
      for (int j = 0; j < band.impulses_per_cell; ++j) {
        add_impulse(band, hash_append(cell, static_cast<std::uint32_t>(j)), cx, cy, tile);
      }
    }
  }
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
  const double gain = tiling_gain(layer, options);
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

void store(const Tile& tile, int width, int height, float clip, std::vector<float>& texture) {
  const int columns = std::min(kTile, width - tile.x), rows = std::min(kTile, height - tile.y);
  for (int y = 0; y < rows; ++y) {
    const auto* row = &tile.height[static_cast<std::size_t>(y * kTile)];
    float* out = &texture[static_cast<std::size_t>(tile.y + y) * static_cast<std::size_t>(width) +
                          static_cast<std::size_t>(tile.x)];
    for (int x = 0; x < columns; ++x) out[x] = math::clamp(row[x], -clip, clip);
  }
}

}  // namespace

std::vector<float> synthesize_texture(const GaborLayer& layer, int width, int height,
                                      const TextureOptions& options, const Progress& progress) {
  if (width < 1 || height < 1) {
    throw InputError("texture size " + std::to_string(width) + "x" + std::to_string(height) +
                     ": must be at least 1x1");
  }
  const std::vector<PlaneBand> bands = plane_bands(layer, options);
  const float clip = static_cast<float>(kGaborClip * layer.height_rms);
  std::vector<float> texture(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  const int tiles_x = (width - 1) / kTile + 1, tiles_y = (height - 1) / kTile + 1;
  for (int ty = 0; ty < tiles_y; ++ty) {
    if (!report(progress, static_cast<double>(ty) / tiles_y, "texture")) return texture;
    parallel_for(0, tiles_x, [&](std::int64_t tx) {
      Tile tile{static_cast<int>(tx) * kTile, ty * kTile, {}};
      for (const PlaneBand& band : bands) add_band(band, tile);
      store(tile, width, height, clip, texture);
    });
  }
  report(progress, 1.0, "texture");
  return texture;
}

}  // namespace astrolith
