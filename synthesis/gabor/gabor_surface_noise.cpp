#include "synthesis/gabor/gabor_surface_noise.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "numerics/interval.h"

namespace astrolith {
namespace {

// On a flat patch an impulse beyond 1/a from the surface reaches none of it. Kernels that are small beside
// the body, to which it is nearly flat, leave out those beyond 1.25/a; s is true to first order only, so that
// large ones keep all.
constexpr double kSmallKernel = 1.0 / 128.0;  // 1/a over the domain's longest side
constexpr double kFarthestReach = 1.25;       // in units of 1/a

// From an impulse to the corner of its support, in units of 1/a.
const double kCornerReach = std::sqrt(2.0 * double{kGaborReach} * double{kGaborReach} +
                                      double{kGaborSlabReach} * double{kGaborSlabReach});

double longest_side(const Box& box) {
  const Vec3d e = box.extent();
  return std::max({e.x, e.y, e.z});
}

}  // namespace

GaborSurfaceNoise::GaborSurfaceNoise(const GaborLayer& layer, std::uint64_t seed, int layer_index,
                                     const PreparedBody& body, const Box& domain)
    : domain_min_(to_float(domain.min)),
      domain_max_(to_float(domain.max)),
      clip_(static_cast<float>(kGaborClip * layer.height_rms)) {
  const double farthest =
      std::max({std::fabs(domain.min.x), std::fabs(domain.min.y), std::fabs(domain.min.z),
                std::fabs(domain.max.x), std::fabs(domain.max.y), std::fabs(domain.max.z)});
  for (GaborBand& band : gabor_bands(layer)) {
    const double a = band.a / layer.pixel_size;
    const double cell = kGaborSpaceCell / a;
    if (!(farthest / cell <= kLargestCell)) continue;
    const double cells_under_kernel = kGaborKernelArea * kGaborSlabThickness / std::pow(kGaborSpaceCell, 3);
    const int count =
        std::max(1, static_cast<int>(std::lround(layer.impulses_per_kernel / cells_under_kernel)));
    // Variance = density K^2/2 (integral of e^2)^2 (integral of W^2): a uniform phase contributes the 1/2.
    const double energy = kGaborProfileEnergy * kGaborProfileEnergy * kGaborSlabEnergy;
    const double density = count / std::pow(kGaborSpaceCell, 3);
    const double amplitude = layer.height_rms * std::sqrt(2.0 * band.variance_share / (density * energy));
    const std::uint32_t band_seed = gabor_band_seed(seed, layer_index, band.bandwidth);
    const double farthest_impulse = 1.0 / a < kSmallKernel * longest_side(domain)
                                        ? kFarthestReach / a
                                        : std::numeric_limits<double>::infinity();
    bands_.emplace_back(SurfaceBand{{band_seed, static_cast<float>(a), static_cast<float>(cell),
                                     static_cast<float>(kCornerReach / a), count,
                                     static_cast<float>(amplitude), static_cast<float>(farthest_impulse)},
                                    std::move(band)},
                        body);
  }
}

GaborSurfacePoints GaborSurfaceNoise::add_bands(int n, const float* x, const float* y, const float* z,
                                                bool with_slopes) const {
  std::vector<float> clamped(static_cast<std::size_t>(3 * n));
  float *px = clamped.data(), *py = px + n, *pz = py + n;
  for (int i = 0; i < n; ++i) {
    px[i] = math::clamp(x[i], domain_min_.x, domain_max_.x);
    py[i] = math::clamp(y[i], domain_min_.y, domain_max_.y);
    pz[i] = math::clamp(z[i], domain_min_.z, domain_max_.z);
  }
  GaborSurfacePoints points(n, px, py, pz, with_slopes);
  for (const GaborTiles& band : bands_) points.add_band(band);
  return points;
}

void GaborSurfaceNoise::evaluate(int n, const float* x, const float* y, const float* z, float* height) const {
  add_bands(n, x, y, z, false).store_heights(height);
  for (int i = 0; i < n; ++i) height[i] = math::clamp(height[i], -clip_, clip_);
}

void GaborSurfaceNoise::evaluate_tetrahedra(int n, const float* x, const float* y, const float* z,
                                            float* height) const {
  const auto count = static_cast<std::size_t>(n / 4);
  const auto center_of = [](const float* c) { return tetrahedron_center(c[0], c[1], c[2], c[3]); };
  std::vector<float> values(7 * count);
  float *cx = values.data(), *cy = cx + count, *cz = cy + count, *middle = cz + count, *sx = middle + count,
        *sy = sx + count, *sz = sy + count;
  for (std::size_t t = 0; t < count; ++t) {
    cx[t] = center_of(x + 4 * t);
    cy[t] = center_of(y + 4 * t);
    cz[t] = center_of(z + 4 * t);
  }
  const GaborSurfacePoints points = add_bands(n / 4, cx, cy, cz, true);
  points.store_heights(middle);
  points.store_slopes(sx, sy, sz);
  for (std::size_t i = 0; i < 4 * count; ++i) {
    const std::size_t t = i / 4;
    const GaborSample center{middle[t], {sx[t], sy[t], sz[t]}};
    height[i] = height_beside(center, x[i] - cx[t], y[i] - cy[t], z[i] - cz[t], clip_);
  }
}

// Rounded outwards.
PointBox GaborSurfaceNoise::in_domain(const Box& box) const {
  const auto below = [](double v, float low, float high) {
    return math::clamp(std::nextafterf(static_cast<float>(v), -INFINITY), low, high);
  };
  const auto above = [](double v, float low, float high) {
    return math::clamp(std::nextafterf(static_cast<float>(v), INFINITY), low, high);
  };
  const Vec3f &a = domain_min_, &b = domain_max_;
  return {{below(box.min.x, a.x, b.x), below(box.min.y, a.y, b.y), below(box.min.z, a.z, b.z)},
          {above(box.max.x, a.x, b.x), above(box.max.y, a.y, b.y), above(box.max.z, a.z, b.z)}};
}

std::vector<GaborImpulse> GaborSurfaceNoise::impulses(std::size_t band, const Box& box) const {
  return impulses_reaching(bands_[band], in_domain(box));
}

double GaborSurfaceNoise::cells(double side) const {
  double cells = 0.0;
  for (const GaborTiles& tiles : bands_) {
    const SurfaceBand& band = tiles.band();
    cells += std::pow((side + 2.0 * double{band.reach}) / double{band.cell} + 1.0, 3);
  }
  return cells;
}

}  // namespace astrolith
