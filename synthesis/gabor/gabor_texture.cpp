#include "synthesis/gabor/gabor_texture.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "numerics/portable_angles.h"
#include "synthesis/gabor/gabor_bands.h"
#include "synthesis/gabor/gabor_kernel.h"
#include "synthesis/gabor/gabor_plane_square.h"

namespace astrolith {
namespace {

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
