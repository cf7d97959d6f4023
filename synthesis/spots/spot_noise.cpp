#include "synthesis/spots/spot_noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <tuple>
#include <utility>

#include "numerics/hash_random.h"
#include "synthesis/spots/spot_bounds.h"

namespace astrolith {
namespace {

constexpr double kClip = 2.0;  // of a sum of overlapping spots, in greatest kernels
constexpr double kDegree = 3.14159265358979323846 / 180.0;

ASTROLITH_SIMD_CLONES void add_spots(const SpotKernel& spot_kernel, const SpotImpulse* impulses,
                                     std::size_t num_impulses, int n, const float* __restrict x,
                                     const float* __restrict y, const float* __restrict z,
                                     float* __restrict height) {
  const SpotKernel kernel = spot_kernel;
  for (std::size_t j = 0; j < num_impulses; ++j) {
    const SpotImpulse impulse = impulses[j];
#pragma omp simd
    for (int i = 0; i < n; ++i) height[i] += spot_height(kernel, impulse, x[i], y[i], z[i]);
  }
}

std::vector<SpotImpulse> those_reaching(const std::vector<SpotImpulse>& impulses, const Vec3d& half,
                                        const Box& box) {
  const Box wide = spot_box(box);
  std::vector<SpotImpulse> found;
  std::copy_if(impulses.begin(), impulses.end(), std::back_inserter(found),
               [&](const SpotImpulse& impulse) { return spot_reaches(impulse, half, wide); });
  return found;
}

// Of a part of a spot: R of its turns, then what takes length units to those of q.
using Rotation = std::array<Vec3d, 3>;  // columns

Rotation rotation(const Vec3d& degrees) {
  const auto turned = [](double angle, double& u, double& v) {
    const double c = std::cos(angle * kDegree), s = std::sin(angle * kDegree);
    std::tie(u, v) = std::pair{c * u - s * v, s * u + c * v};
  };
  Rotation columns{Vec3d{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (Vec3d& p : columns) {
    if (degrees.x != 0.0) turned(degrees.x, p.y, p.z);
    if (degrees.y != 0.0) turned(degrees.y, p.z, p.x);
    if (degrees.z != 0.0) turned(degrees.z, p.x, p.y);
  }
  return columns;
}

SpotKernel kernel_of(const SpotLayer& layer, const SpotPart& part, const Rotation& r, double unit,
                     double amplitude) {
  const auto scaled = [&](double c, double axis) { return static_cast<float>(c / (axis * unit)); };
  const Vec3d &a = part.axes, &v = layer.variances;
  return {scaled(r[0].x, a.x),
          scaled(r[0].y, a.x),
          scaled(r[0].z, a.x),
          scaled(r[1].x, a.y),
          scaled(r[1].y, a.y),
          scaled(r[1].z, a.y),
          scaled(r[2].x, a.z),
          scaled(r[2].y, a.z),
          scaled(r[2].z, a.z),
          static_cast<float>(part.weight * amplitude * layer.gaussian),
          static_cast<float>(layer.alpha),
          static_cast<float>(part.weight * amplitude * layer.kappa),
          static_cast<float>(layer.beta),
          static_cast<float>(layer.gamma),
          static_cast<float>(1.0 / v.x),
          static_cast<float>(1.0 / v.y),
          static_cast<float>(1.0 / v.z),
          static_cast<float>(layer.sigma)};
}

// Half the sides of the box around a part: of the ellipsoid q.V^-1 q = sigma.
Vec3d support_of(const SpotLayer& layer, const SpotPart& part, const Rotation& r, double unit) {
  const Vec3d &a = part.axes, &v = layer.variances;
  const auto side = [&](double x, double y, double z) {
    return std::sqrt(v.x * (a.x * x) * (a.x * x) + v.y * (a.y * y) * (a.y * y) + v.z * (a.z * z) * (a.z * z));
  };
  return unit * std::sqrt(layer.sigma) * (1.0 + kSpotSlack) *
         Vec3d{side(r[0].x, r[1].x, r[2].x), side(r[0].y, r[1].y, r[2].y), side(r[0].z, r[1].z, r[2].z)};
}

}  // namespace

SpotNoise::SpotNoise(const SpotLayer& layer, std::uint64_t seed, int layer_index, const Box& domain)
    : domain_min_(to_float(domain.min)), domain_max_(to_float(domain.max)) {
  const std::uint32_t layer_seed = hash_seed(seed, static_cast<std::uint32_t>(layer_index));
  for (int j = 0; j < layer.layers; ++j) {
    const double shrink = std::pow(layer.lacunarity, j);
    const double cell = layer.cell_size / shrink, unit = layer.size / shrink;
    if (!(largest_coordinate(domain) / (cell * least_height(layer.lattice)) <= kLargestCell)) break;
    const SpotLattice lattice =
        make_spot_lattice(layer, cell, layer.density * std::pow(shrink, layer.exponent - 2.0),
                          hash_append(layer_seed, static_cast<std::uint32_t>(j)), thresholds_);
    const double amplitude = (layer.inverted ? 1.0 : -1.0) * layer.amplitude * std::pow(layer.gain, j);
    if (layer.parts.empty()) add_kind(layer, {}, lattice, unit, amplitude);
    for (const SpotPart& part : layer.parts) add_kind(layer, part, lattice, unit, amplitude);
  }
}

void SpotNoise::add_kind(const SpotLayer& layer, const SpotPart& part, const SpotLattice& lattice,
                         double unit, double amplitude) {
  const Rotation turn = rotation(part.turn);
  const double clip =
      kClip * std::fabs(part.weight * amplitude) * (std::fabs(layer.gaussian) + std::fabs(layer.kappa));
  kinds_.push_back({kernel_of(layer, part, turn, unit, amplitude), lattice, unit * part.center,
                    support_of(layer, part, turn, unit), static_cast<float>(clip)});
  height_bound_ += clip * (1.0 + kSpotSlack);
}

std::vector<SpotImpulse> SpotNoise::impulses_reaching(int k, const Box& box) const {
  std::vector<SpotImpulse> impulses;
  for_each_spot(kinds_[static_cast<std::size_t>(k)], thresholds_.data(), box,
                [&](const SpotImpulse& impulse) { impulses.push_back(impulse); });
  return impulses;
}

SpotImpulses SpotNoise::draw(const Box& box) const {
  SpotImpulses impulses;
  for (int j = 0; j < num_kinds(); ++j)
    impulses.push_back(impulses_reaching(j, moved_into(box, domain_min_, domain_max_)));
  return impulses;
}

std::shared_ptr<const SpotImpulses> SpotNoise::gather(const Box& box, const SpotImpulses* of_larger) const {
  const Box moved = moved_into(box, domain_min_, domain_max_);
  const auto too_many = [&](const SpotKind& kind) {
    return spot_cells_around(kind, moved).count() > kMostSpotCells;
  };
  if (of_larger == nullptr && std::any_of(kinds_.begin(), kinds_.end(), too_many)) return nullptr;
  if (of_larger == nullptr) return std::make_shared<const SpotImpulses>(draw(box));
  auto impulses = std::make_shared<SpotImpulses>(kinds_.size());
  for (std::size_t j = 0; j < kinds_.size(); ++j) {
    (*impulses)[j] = those_reaching((*of_larger)[j], kinds_[j].support, moved);
  }
  return impulses;
}

void SpotNoise::evaluate(int n, const float* x, const float* y, const float* z, float* height,
                         const SpotImpulses* impulses) const {
  std::vector<float> points(static_cast<std::size_t>(4 * n));
  float *px = points.data(), *py = px + n, *pz = py + n, *sum = pz + n;
  for (int i = 0; i < n; ++i) {
    px[i] = math::clamp(x[i], domain_min_.x, domain_max_.x);
    py[i] = math::clamp(y[i], domain_min_.y, domain_max_.y);
    pz[i] = math::clamp(z[i], domain_min_.z, domain_max_.z);
  }
  std::fill(height, height + n, 0.0f);
  Box points_box;
  for (int i = 0; i < n; ++i) points_box.extend({px[i], py[i], pz[i]});
  for (std::size_t j = 0; j < kinds_.size(); ++j) {
    const SpotKind& kind = kinds_[j];
    std::fill(sum, sum + n, 0.0f);
    if (impulses == nullptr) {
      add_sum(kind, n, px, py, pz, sum);
    } else {
      const std::vector<SpotImpulse> near = those_reaching((*impulses)[j], kind.support, points_box);
      add_spots(kind.kernel, near.data(), near.size(), n, px, py, pz, sum);
    }
    for (int i = 0; i < n; ++i) height[i] += math::clamp(sum[i], -kind.clip, kind.clip);
  }
}

void SpotNoise::add_sum(const SpotKind& kind, int n, const float* x, const float* y, const float* z,
                        float* height) const {
  Box box;
  for (int i = 0; i < n; ++i) box.extend({x[i], y[i], z[i]});
  if (n > 1 && spot_cells_around(kind, box).count() > kMostSpotCells) {
    const int half = n / 2;
    add_sum(kind, half, x, y, z, height);
    add_sum(kind, n - half, x + half, y + half, z + half, height + half);
    return;
  }
  const int j = static_cast<int>(&kind - kinds_.data());
  const std::vector<SpotImpulse> impulses = impulses_reaching(j, box);
  add_spots(kind.kernel, impulses.data(), impulses.size(), n, x, y, z, height);
}

Interval SpotNoise::bound_heights(const Box& box, const SpotImpulses* impulses) const {
  const Box moved = moved_into(box, domain_min_, domain_max_);
  const double slack = 3.0 * kSpotSlack * height_bound_;
  Interval sum{-slack, slack};
  for (std::size_t k = 0; k < kinds_.size(); ++k) {
    if (impulses == nullptr) {
      sum = plus(sum, bound_drawn_spots(kinds_[k], thresholds_.data(), moved));
      continue;
    }
    SpotSumBound bound{kinds_[k], moved};
    for (const SpotImpulse& impulse : (*impulses)[k]) bound.add(impulse);
    sum = plus(sum, bound.clipped());
  }
  return sum;
}

}  // namespace astrolith
