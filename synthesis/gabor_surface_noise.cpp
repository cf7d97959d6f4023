#include "synthesis/gabor_surface_noise.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace astrolith {
namespace {

constexpr double kLargestCell =
    1048576.0;  // 2^20 cells from the origin: floats hold three bits within a cell

// On a flat patch an impulse beyond 1/a from the surface reaches none of it. Kernels that are small beside
// the body, to which it is nearly flat, leave out those beyond 1.25/a; s is true to first order only, so that
// large ones keep all.
constexpr double kSmallKernel = 1.0 / 128.0;  // 1/a over the domain's longest side
constexpr double kFarthestReach = 1.25;       // in units of 1/a

// From an impulse to the corner of its support, in units of 1/a.
const double kCornerReach = std::sqrt(2.0 * double{kGaborReach} * double{kGaborReach} +
                                      double{kGaborSlabReach} * double{kGaborSlabReach});

// Impulses are drawn for a group of points of bounded size, so that memory is. Where many points share the
// impulses of a cell, loops over points add them: impulses are handed down to halves of the group, each
// keeping what reaches it, since small groups waste fewer kernel evaluations on points out of reach (sizes in
// kernel reaches). Where few do, loops over the impulses of cells do. Either gives the same bits.
constexpr std::int64_t kMostCells = 1 << 17;
constexpr double kDensePoints = 32.0;
constexpr double kSmallestReaches = 0.4;
constexpr int kSmallestGroup = 32;  // points: two vectors of the widest machine

ASTROLITH_SIMD_CLONES void add_impulses(const GaborImpulse* impulses, std::size_t num_impulses,
                                        float amplitude, int n, const float* __restrict x,
                                        const float* __restrict y, const float* __restrict z,
                                        float* __restrict height) {
  for (std::size_t j = 0; j < num_impulses; ++j) {
    const GaborImpulse impulse = impulses[j];
#pragma omp simd
    for (int i = 0; i < n; ++i) {
      height[i] = math::fma(amplitude, gabor_kernel(impulse, x[i], y[i], z[i]), height[i]);
    }
  }
}

// Whether a kernel reaches the box, by the box's extents along the kernel's axes; never wrongly says no.
bool reaches(const GaborImpulse& k, const Vec3d& center, const Vec3d& half) {
  constexpr double kSlack = 1.0 + 1e-3;
  const double dx = center.x - double{k.x}, dy = center.y - double{k.y}, dz = center.z - double{k.z};
  const auto far = [&](double ax, double ay, double az, double reach) {
    const double spread = std::fabs(ax) * half.x + std::fabs(ay) * half.y + std::fabs(az) * half.z;
    return std::fabs(ax * dx + ay * dy + az * dz) > reach * kSlack + spread;
  };
  return !far(double{k.ux}, double{k.uy}, double{k.uz}, double{kGaborReach}) &&
         !far(double{k.vx}, double{k.vy}, double{k.vz}, double{kGaborReach}) &&
         !far(double{k.nx}, double{k.ny}, double{k.nz}, double{kGaborSlabReach});
}

double longest_side(const Box& box) {
  const Vec3d e = box.extent();
  return std::max({e.x, e.y, e.z});
}

Vec3f to_float(const Vec3d& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

}  // namespace

// A copy of the caller's points that may be reordered.
struct GaborSurfaceNoise::Points {
  std::vector<float> x, y, z, height;
  std::vector<int> index;

  double coordinate(int axis, int i) const {
    const std::vector<float>& c = axis == 0 ? x : axis == 1 ? y : z;
    return static_cast<double>(c[static_cast<std::size_t>(i)]);
  }
  void swap(int i, int j) {
    const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
    for (std::vector<float>* c : {&x, &y, &z, &height}) std::swap((*c)[a], (*c)[b]);
    std::swap(index[a], index[b]);
  }
  Box bounds(int begin, int end) const {
    Box box;
    for (int i = begin; i < end; ++i) box.extend({coordinate(0, i), coordinate(1, i), coordinate(2, i)});
    return box;
  }
  // Moves the points of one half of their box to the front; returns where the others begin, or `begin` when
  // all points are in one place.
  int halve(int begin, int end, const Box& box) {
    const Vec3d e = box.extent(), c = box.center();
    const int axis = e.x >= e.y && e.x >= e.z ? 0 : e.y >= e.z ? 1 : 2;
    const double border = axis == 0 ? c.x : axis == 1 ? c.y : c.z;
    int middle = begin;
    for (int i = begin; i < end; ++i) {
      if (coordinate(axis, i) < border) swap(i, middle++);
    }
    return middle == end ? begin : middle;
  }
};

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
    bands_.emplace_back(SurfaceBand{std::move(band), band_seed, static_cast<float>(a),
                                    static_cast<float>(cell), static_cast<float>(kCornerReach / a), count,
                                    static_cast<float>(amplitude), static_cast<float>(farthest_impulse)},
                        body);
  }
}

void GaborSurfaceNoise::evaluate(int n, const float* x, const float* y, const float* z, float* height) const {
  Points points;
  const auto clamped = [n](const float* c, float low, float high) {
    std::vector<float> copy(c, c + n);
    for (float& v : copy) v = math::clamp(v, low, high);
    return copy;
  };
  points.x = clamped(x, domain_min_.x, domain_max_.x);
  points.y = clamped(y, domain_min_.y, domain_max_.y);
  points.z = clamped(z, domain_min_.z, domain_max_.z);
  points.height.assign(static_cast<std::size_t>(n), 0.0f);
  for (int i = 0; i < n; ++i) points.index.push_back(i);
  for (const GaborTiles& band : bands_) add_band(band, points, 0, n);
  for (std::size_t i = 0; i < points.index.size(); ++i) {
    height[points.index[i]] = math::clamp(points.height[i], -clip_, clip_);
  }
}

namespace {

std::vector<GaborImpulse> reaching(const std::vector<GaborImpulse>& impulses, const Box& box) {
  const Vec3d center = box.center(), half = 0.5 * box.extent();
  std::vector<GaborImpulse> kept;
  for (const GaborImpulse& impulse : impulses) {
    if (reaches(impulse, center, half)) kept.push_back(impulse);
  }
  return kept;
}

}  // namespace

void GaborSurfaceNoise::add_band(const GaborTiles& tiles, Points& points, int begin, int end) const {
  if (begin == end) return;
  const SurfaceBand& band = tiles.band();
  const Box box = points.bounds(begin, end);
  const int middle = cells_around(band, box).cells() > kMostCells ? points.halve(begin, end, box) : begin;
  if (middle != begin) {
    add_band(tiles, points, begin, middle);
    add_band(tiles, points, middle, end);
    return;
  }
  const auto first = static_cast<std::size_t>(begin);
  const GaborImpulses impulses(tiles, end - begin, &points.x[first], &points.y[first], &points.z[first]);
  if (impulses.points_per_cell() < kDensePoints) {
    impulses.add_by_cells(&points.height[first]);
  } else {
    add_group(band, impulses.all(), points, begin, end);
  }
}

void GaborSurfaceNoise::add_group(const SurfaceBand& band, const std::vector<GaborImpulse>& impulses,
                                  Points& points, int begin, int end) const {
  const Box box = points.bounds(begin, end);
  const std::vector<GaborImpulse> near = reaching(impulses, box);
  const bool divisible =
      end - begin > kSmallestGroup && longest_side(box) > kSmallestReaches * double{band.reach};
  const int middle = divisible ? points.halve(begin, end, box) : begin;
  if (middle == begin) {
    const auto first = static_cast<std::size_t>(begin);
    add_impulses(near.data(), near.size(), band.amplitude, end - begin, &points.x[first], &points.y[first],
                 &points.z[first], &points.height[first]);
  } else {
    add_group(band, near, points, begin, middle);
    add_group(band, near, points, middle, end);
  }
}

}  // namespace astrolith
