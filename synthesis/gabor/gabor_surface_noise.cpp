#include "synthesis/gabor/gabor_surface_noise.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "numerics/interval.h"
#include "numerics/portable_double.h"
#include "synthesis/gabor/gabor_bands.h"
#include "synthesis/gabor/gabor_surface_points.h"
#include "synthesis/noise/points_in_domain.h"

namespace astrolith {
namespace {

// On a flat patch an impulse farther than 1/a from the surface reaches no point of the surface. A body is
// nearly flat beside small kernels: they leave out impulses that are a little farther. What they keep beyond
// 1/a allows for the curvature of the surface, which counts more for larger kernels, and for the rounding of
// distances to float, which counts more for smaller ones. For large kernels s is too inaccurate, since it is
// a distance to first order only. They keep all impulses.
constexpr double kSmallKernel = 1.0 / 128.0;               // 1/a over the domain's longest side
constexpr double kLeastMargin = 0.02, kMostMargin = 0.25;  // in units of 1/a

// The greatest first-order distance of an impulse from the surface, in units of 1/a, for kernels of a size
// 1/a over the domain's longest side.
double farthest_impulse(double size) {
  if (!(size < kSmallKernel)) return std::numeric_limits<double>::infinity();
  const double curvature = (kMostMargin - kLeastMargin) * (size / kSmallKernel), rounding = 0x1p-22 / size;
  return 1.0 + std::min(kLeastMargin + curvature + rounding, kMostMargin);
}

// The distance from an impulse to the rim of its support, in units of 1/a.
const double kRimReach = std::sqrt(double{kGaborDiscReach} * double{kGaborDiscReach} +
                                   double{kGaborSlabReach} * double{kGaborSlabReach});

// One bandwidth at the scale of a domain. The variance is density K^2/2 (integral of P^2) (integral of W^2);
// the factor 1/2 comes from the uniform phase.
SurfaceBand surface_band(const GaborLayer& layer, const GaborBand& band, std::uint32_t seed,
                         const Vec3d& origin, double body_side, ArrayStore& arrays) {
  const double a = band.a / layer.pixel_size;
  const double cells_under_kernel =
      kGaborKernelArea * kGaborSlabThickness / portable::whole_power(kGaborSpaceCell, 3);
  const int count =
      std::max(1, static_cast<int>(std::lround(layer.impulses_per_kernel / cells_under_kernel)));
  const double energy = kGaborDiscEnergy * kGaborSlabEnergy;
  const double density = count / portable::whole_power(kGaborSpaceCell, 3);
  const double amplitude = layer.height_rms * std::sqrt(2.0 * band.variance_share / (density * energy));
  const auto cell = static_cast<float>(kGaborSpaceCell / a);
  const OriginCell first = origin_cell(1.0 / double{cell} * origin);
  return {{seed,
           static_cast<float>(a),
           cell,
           static_cast<float>(kRimReach / a),
           count,
           static_cast<float>(amplitude),
           static_cast<float>(farthest_impulse(1.0 / (a * body_side)) / a),
           {first.x, first.y, first.z},
           to_float(-double{cell} * first.rest)},
          arrays.add(band.lobes)};
}

// The shortest wave or narrowest cell of a band, length units.
double finest_length(const GaborBand& band, double pixel_size) {
  double highest = 1.0 / kGaborSpaceCell;  // in units of a
  for (const GaborBand::Lobe& lobe : band.lobes) {
    highest = std::max({highest, std::fabs(double{lobe.frequency_x}), std::fabs(double{lobe.frequency_y})});
  }
  return pixel_size / (band.a * highest);
}

GaborSurfacePoints add_bands(const GaborSurfaceNoise& noise, const BodyGround& ground,
                             const GaborBrickCache* caches, int n, const float* x, const float* y,
                             const float* z, bool with_slopes) {
  const PointsInDomain p(noise.low, noise.high, n, x, y, z);
  GaborSurfacePoints points(n, p.x(), p.y(), p.z(), with_slopes);
  const SurfaceBand* bands = ground.arrays[noise.bands];
  for (std::uint32_t b = 0; b < noise.bands.count; ++b) points.add_band({bands[b], ground, caches[b]});
  return points;
}

}  // namespace

GaborSurfaceNoise make_noise(const GaborLayer& layer, std::uint64_t seed, int layer_index,
                             const NoiseFrame& frame, double body_side, ArrayStore& arrays) {
  GaborSurfaceNoise noise;
  noise.low = to_float(frame.domain.min);
  noise.high = to_float(frame.domain.max);
  noise.clip = static_cast<float>(kGaborClip * layer.height_rms);
  noise.height_bound = static_cast<double>(noise.clip);
  std::vector<SurfaceBand> bands;
  for (const GaborBand& band : gabor_bands(layer)) {
    const double cell = kGaborSpaceCell / (band.a / layer.pixel_size);
    noise.detail.finest = std::min(noise.detail.finest, finest_length(band, layer.pixel_size));
    if (!(frame.farthest() / cell <= kLargestCell)) {
      noise.detail.left_out += band.variance_share;
      continue;
    }
    bands.push_back(surface_band(layer, band, gabor_band_seed(seed, layer_index, band.bandwidth),
                                 frame.origin, body_side, arrays));
  }
  noise.bands = arrays.add(bands);
  return noise;
}

double count_cells(const GaborSurfaceNoise& noise, const ArrayView& arrays, double side) {
  double cells = 0.0;
  for (const SurfaceBand& band : arrays.span(noise.bands)) {
    cells += portable::whole_power((side + 2.0 * double{band.reach}) / double{band.cell} + 1.0, 3);
  }
  return cells;
}

double draws_at_a_point(const GaborSurfaceNoise& noise, const ArrayView& arrays) {
  double draws = 0.0;
  for (const SurfaceBand& band : arrays.span(noise.bands)) {
    const double across = 2.0 * double{band.reach} / double{band.cell} + 1.0;
    draws += band.impulses_per_cell * portable::whole_power(across, 3);
  }
  return draws;
}

void evaluate_heights(const GaborSurfaceNoise& noise, const BodyGround& ground, const GaborBrickCache* caches,
                      int n, const float* x, const float* y, const float* z, float* height) {
  add_bands(noise, ground, caches, n, x, y, z, false).store_heights(height);
  for (int i = 0; i < n; ++i) height[i] = math::clamp(height[i], -noise.clip, noise.clip);
}

void evaluate_tetrahedron_heights(const GaborSurfaceNoise& noise, const BodyGround& ground,
                                  const GaborBrickCache* caches, int n, const float* x, const float* y,
                                  const float* z, float* height) {
  const auto count = static_cast<std::size_t>(n / 4);
  const auto row_center = [](const float* c) { return tetrahedron_center(c[0], c[1], c[2], c[3]); };
  std::vector<float> values(7 * count);
  float *cx = values.data(), *cy = cx + count, *cz = cy + count, *middle = cz + count, *sx = middle + count,
        *sy = sx + count, *sz = sy + count;
  for (std::size_t t = 0; t < count; ++t) {
    cx[t] = row_center(x + 4 * t);
    cy[t] = row_center(y + 4 * t);
    cz[t] = row_center(z + 4 * t);
  }
  const GaborSurfacePoints points = add_bands(noise, ground, caches, n / 4, cx, cy, cz, true);
  points.store_heights(middle);
  points.store_slopes(sx, sy, sz);
  for (std::size_t i = 0; i < 4 * count; ++i) {
    const std::size_t t = i / 4;
    const GaborSample center{middle[t], {sx[t], sy[t], sz[t]}};
    height[i] = height_beside(center, x[i] - cx[t], y[i] - cy[t], z[i] - cz[t], noise.clip);
  }
}

}  // namespace astrolith
