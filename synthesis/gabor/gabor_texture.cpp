#include "synthesis/gabor/gabor_texture.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "synthesis/gabor/gabor_bands.h"
#include "synthesis/gabor/gabor_kernel.h"
#include "synthesis/gabor/gabor_plane_tile.h"
#include "synthesis/gabor/gabor_tiling.h"

namespace astrolith {
namespace {

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

void store(const TextureTile& tile, int width, int height, float clip, std::vector<float>& texture) {
  const int columns = std::min(kTextureTile, width - tile.x), rows = std::min(kTextureTile, height - tile.y);
  for (int y = 0; y < rows; ++y) {
    const auto* row = &tile.height[static_cast<std::size_t>(y * kTextureTile)];
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
  const int tiles_x = (width - 1) / kTextureTile + 1, tiles_y = (height - 1) / kTextureTile + 1;
  for (int ty = 0; ty < tiles_y; ++ty) {
    if (!report(progress, static_cast<double>(ty) / tiles_y, "texture")) return texture;
    parallel_for(0, tiles_x, [&](std::int64_t tx) {
      TextureTile tile{static_cast<int>(tx) * kTextureTile, ty * kTextureTile, {}};
      for (const PlaneBand& band : bands) add_band(band, tile);
      store(tile, width, height, clip, texture);
    });
  }
  report(progress, 1.0, "texture");
  return texture;
}

}  // namespace astrolith
