#include "synthesis/spot_noise.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "numerics/hash_random.h"
#include "synthesis/largest_coordinate.h"

namespace astrolith {
namespace {

constexpr double kLargestCell =
    1048576.0;                         // 2^20 cells from the origin: floats hold three bits within a cell
constexpr double kMostCells = 4096.0;  // drawn at once
constexpr double kClip = 2.0;          // of a sum of overlapping spots, in greatest kernels
constexpr double kSlack = 1e-5;        // relative, for the rounding of positions and kernels
constexpr std::uint32_t kCountStream = 0x636f756eu, kOccupiedStream = 0x6f636375u;

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

// For l = 0, 1, ..: the share of hashes below P(count <= l), as an integer threshold; up to where 2^-32 ends.
std::vector<std::uint32_t> poisson_thresholds(double mean) {
  std::vector<std::uint32_t> thresholds;
  double probability = std::exp(-mean), sum = probability;
  for (int l = 1; sum < 1.0 - 0x1p-32 && l < 1000; ++l) {
    thresholds.push_back(static_cast<std::uint32_t>(std::min(sum * 0x1p32, 0x1p32 - 1.0)));
    probability *= mean / l;
    if (l > mean && probability < 0x1p-33) break;
    sum += probability;
  }
  return thresholds;
}

// Squared distances from a point to a box, in units that differ from axis to axis.
struct Range {
  double nearest = 0.0, farthest = 0.0;
};
Range squared_distance(const SpotImpulse& p, const Box& box, const Vec3d& per_axis) {
  Range range;
  const auto add = [&](double c, double low, double high, double weight) {
    const double near = std::max({0.0, low - c, c - high}),
                 far = std::max(std::fabs(c - low), std::fabs(c - high));
    range.nearest += weight * near * near;
    range.farthest += weight * far * far;
  };
  add(p.x, box.min.x, box.max.x, per_axis.x);
  add(p.y, box.min.y, box.max.y, per_axis.y);
  add(p.z, box.min.z, box.max.z, per_axis.z);
  return range;
}

// Whether a spot of these half axes touches the box.
bool reaches(const SpotImpulse& impulse, const Vec3d& half, const Box& box) {
  const auto near = [](double c, double low, double high, double h) { return c >= low - h && c <= high + h; };
  return near(impulse.x, box.min.x, box.max.x, half.x) && near(impulse.y, box.min.y, box.max.y, half.y) &&
         near(impulse.z, box.min.z, box.max.z, half.z);
}

// For the rounding of float positions.
Box widened_by_rounding(const Box& box) { return widened(box, 2e-6 * largest_coordinate(box)); }

std::vector<SpotImpulse> those_reaching(const std::vector<SpotImpulse>& impulses, const Vec3d& half,
                                        const Box& box) {
  const Box wide = widened_by_rounding(box);
  std::vector<SpotImpulse> found;
  std::copy_if(impulses.begin(), impulses.end(), std::back_inserter(found),
               [&](const SpotImpulse& impulse) { return reaches(impulse, half, wide); });
  return found;
}

// K over squared distances, as spot_profile: one falls, the other rises to its ring and falls.
Interval bound_profile(const SpotKernel& k, const Range& q2) {
  const auto bowl = [&](double q) { return std::exp(-double{k.alpha} * q); };
  const auto ring = [&](double q) {
    const double log_ring = std::log(std::max(double{k.gamma} * q, 1e-38));
    return std::exp(-double{k.beta} * log_ring * log_ring);
  };
  const double at_ring = std::clamp(1.0 / double{k.gamma}, q2.nearest, q2.farthest);
  const Interval b{bowl(q2.farthest), bowl(q2.nearest)};
  const double g = k.gaussian, kappa = k.kappa;
  if (kappa == 0.0) return {std::min(g * b.low, g * b.high), std::max(g * b.low, g * b.high)};
  const Interval r{std::min(ring(q2.nearest), ring(q2.farthest)), ring(at_ring)};
  return {std::min(g * b.low, g * b.high) + std::min(kappa * r.low, kappa * r.high),
          std::max(g * b.low, g * b.high) + std::max(kappa * r.low, kappa * r.high)};
}

}  // namespace

SpotNoise::SpotNoise(const SpotLayer& layer, std::uint64_t seed, int layer_index, const Box& domain)
    : layer_(layer),
      domain_min_{static_cast<float>(domain.min.x), static_cast<float>(domain.min.y),
                  static_cast<float>(domain.min.z)},
      domain_max_{static_cast<float>(domain.max.x), static_cast<float>(domain.max.y),
                  static_cast<float>(domain.max.z)} {
  const std::uint32_t layer_seed = hash_seed(seed, static_cast<std::uint32_t>(layer_index));
  const Vec3d& v = layer.variances;
  for (int j = 0; j < layer.layers; ++j) {
    const double shrink = std::pow(layer.lacunarity, j);
    const double cell = layer.cell_size / shrink, unit = layer.size / shrink;
    if (!(largest_coordinate(domain) / cell <= kLargestCell)) break;
    const double amplitude = (layer.inverted ? 1.0 : -1.0) * layer.amplitude * std::pow(layer.gain, j);
    const double clip = kClip * std::fabs(amplitude) * (std::fabs(layer.gaussian) + std::fabs(layer.kappa));
    const SpotKernel kernel{static_cast<float>(1.0 / unit),  static_cast<float>(amplitude * layer.gaussian),
                            static_cast<float>(layer.alpha), static_cast<float>(amplitude * layer.kappa),
                            static_cast<float>(layer.beta),  static_cast<float>(layer.gamma),
                            static_cast<float>(1.0 / v.x),   static_cast<float>(1.0 / v.y),
                            static_cast<float>(1.0 / v.z),   static_cast<float>(layer.sigma)};
    const double half = unit * std::sqrt(layer.sigma) * (1.0 + kSlack);
    sizes_.push_back({kernel, hash_append(layer_seed, static_cast<std::uint32_t>(j)),
                      static_cast<float>(cell), static_cast<float>(clip),
                      half * Vec3d{std::sqrt(v.x), std::sqrt(v.y), std::sqrt(v.z)},
                      poisson_thresholds(layer.density * std::pow(shrink, layer.exponent - 2.0))});
    height_bound_ += clip * (1.0 + kSlack);
  }
}

double SpotNoise::Cells::count() const {
  return (double(last[0]) - first[0] + 1) * (double(last[1]) - first[1] + 1) *
         (double(last[2]) - first[2] + 1);
}

SpotNoise::Cells SpotNoise::cells_around(const Size& size, const Box& box) const {
  const double cell = size.cell, reach = layer_.reach + 1e-3;
  const auto first = [&](double low, double half) {
    return static_cast<int>(std::floor((low - half) / cell - reach));
  };
  const auto last = [&](double high, double half) {
    return static_cast<int>(std::floor((high + half) / cell + reach));
  };
  const Vec3d& h = size.support;
  return {{first(box.min.x, h.x), first(box.min.y, h.y), first(box.min.z, h.z)},
          {last(box.max.x, h.x), last(box.max.y, h.y), last(box.max.z, h.z)}};
}

void SpotNoise::draw_cell(const Size& size, int cx, int cy, int cz, const Box& box,
                          std::vector<SpotImpulse>& out) const {
  const std::uint32_t cell = hash_cell(size.seed, cx, cy, cz);
  const float occupied = unit_float(hash_append(cell, kOccupiedStream));
  if (!(static_cast<double>(occupied) < layer_.probability)) return;
  const std::uint32_t number = hash_append(cell, kCountStream);
  const float width = 1.0f + 2.0f * static_cast<float>(layer_.reach);
  const float least_weight = static_cast<float>(layer_.least_weight);
  for (std::uint32_t l = 0; l < size.least.size() && number >= size.least[l]; ++l) {
    const auto random = [&](std::uint32_t k) { return unit_float(hash_append(cell, 4 * l + k)); };
    const auto along = [&](int c, std::uint32_t k) {
      return size.cell * (static_cast<float>(c) + math::fma(width, random(k) - 0.5f, 0.5f));
    };
    const SpotImpulse impulse{along(cx, 0), along(cy, 1), along(cz, 2),
                              math::fma(1.0f - least_weight, random(3), least_weight)};
    if (reaches(impulse, size.support, box)) out.push_back(impulse);
  }
}

std::vector<SpotImpulse> SpotNoise::impulses_reaching(int j, const Box& box) const {
  const Size& size = sizes_[static_cast<std::size_t>(j)];
  const Box wide = widened_by_rounding(box);
  const Cells cells = cells_around(size, wide);
  std::vector<SpotImpulse> impulses;
  for (int z = cells.first[2]; z <= cells.last[2]; ++z) {
    for (int y = cells.first[1]; y <= cells.last[1]; ++y) {
      for (int x = cells.first[0]; x <= cells.last[0]; ++x) draw_cell(size, x, y, z, wide, impulses);
    }
  }
  return impulses;
}

SpotImpulses SpotNoise::draw(const Box& box) const {
  SpotImpulses impulses;
  for (int j = 0; j < num_sizes(); ++j) impulses.push_back(impulses_reaching(j, moved_into_domain(box)));
  return impulses;
}

std::shared_ptr<const SpotImpulses> SpotNoise::gather(const Box& box, const SpotImpulses* of_larger) const {
  const Box moved = moved_into_domain(box);
  const auto too_many = [&](const Size& size) { return cells_around(size, moved).count() > kMostCells; };
  if (of_larger == nullptr && std::any_of(sizes_.begin(), sizes_.end(), too_many)) return nullptr;
  if (of_larger == nullptr) return std::make_shared<const SpotImpulses>(draw(box));
  auto impulses = std::make_shared<SpotImpulses>(sizes_.size());
  for (std::size_t j = 0; j < sizes_.size(); ++j) {
    (*impulses)[j] = those_reaching((*of_larger)[j], sizes_[j].support, moved);
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
  for (std::size_t j = 0; j < sizes_.size(); ++j) {
    const Size& size = sizes_[j];
    std::fill(sum, sum + n, 0.0f);
    if (impulses == nullptr) {
      add_size(size, n, px, py, pz, sum);
    } else {
      const std::vector<SpotImpulse> near = those_reaching((*impulses)[j], size.support, points_box);
      add_spots(size.kernel, near.data(), near.size(), n, px, py, pz, sum);
    }
    for (int i = 0; i < n; ++i) height[i] += math::clamp(sum[i], -size.clip, size.clip);
  }
}

void SpotNoise::add_size(const Size& size, int n, const float* x, const float* y, const float* z,
                         float* height) const {
  Box box;
  for (int i = 0; i < n; ++i) box.extend({x[i], y[i], z[i]});
  if (n > 1 && cells_around(size, box).count() > kMostCells) {
    const int half = n / 2;
    add_size(size, half, x, y, z, height);
    add_size(size, n - half, x + half, y + half, z + half, height + half);
    return;
  }
  const int j = static_cast<int>(&size - sizes_.data());
  const std::vector<SpotImpulse> impulses = impulses_reaching(j, box);
  add_spots(size.kernel, impulses.data(), impulses.size(), n, x, y, z, height);
}

Interval SpotNoise::bound_size(const Size& size, const Box& box,
                               const std::vector<SpotImpulse>& impulses) const {
  const double clip = size.clip;
  const SpotKernel& k = size.kernel;
  const double scale_squared = double{k.scale} * double{k.scale};
  const Vec3d ones{scale_squared, scale_squared, scale_squared};
  const Vec3d shape = scale_squared * Vec3d{k.inverse_vx, k.inverse_vy, k.inverse_vz};
  Interval sum;
  for (const SpotImpulse& impulse : impulses) {
    const Range inside = squared_distance(impulse, box, shape);
    if (inside.nearest > double{k.sigma} * (1.0 + kSlack)) continue;
    const Range q2 = squared_distance(impulse, box, ones);
    Interval profile = bound_profile(k, {q2.nearest * (1.0 - kSlack), q2.farthest * (1.0 + kSlack)});
    if (inside.farthest > double{k.sigma} * (1.0 - kSlack)) {
      profile = {std::min(0.0, profile.low), std::max(0.0, profile.high)};
    }
    sum.low += static_cast<double>(impulse.weight) * profile.low;
    sum.high += static_cast<double>(impulse.weight) * profile.high;
  }
  return {std::clamp(sum.low, -clip, clip), std::clamp(sum.high, -clip, clip)};
}

Box SpotNoise::moved_into_domain(const Box& box) const {
  const auto inside = [&](const Vec3d& p) {
    return Vec3d{std::clamp(p.x, double{domain_min_.x}, double{domain_max_.x}),
                 std::clamp(p.y, double{domain_min_.y}, double{domain_max_.y}),
                 std::clamp(p.z, double{domain_min_.z}, double{domain_max_.z})};
  };
  return {inside(box.min), inside(box.max)};
}

Interval SpotNoise::bound_heights(const Box& box, const SpotImpulses* impulses) const {
  const Box moved = moved_into_domain(box);
  const double slack = 3.0 * kSlack * height_bound_;
  Interval sum{-slack, slack};
  for (std::size_t j = 0; j < sizes_.size(); ++j) {
    const Size& size = sizes_[j];
    const double clip = size.clip;
    Interval heights{-clip, clip};
    if (impulses != nullptr) {
      heights = bound_size(size, moved, (*impulses)[j]);
    } else if (cells_around(size, moved).count() <= kMostCells) {
      heights = bound_size(size, moved, impulses_reaching(static_cast<int>(j), moved));
    }
    sum.low += heights.low;
    sum.high += heights.high;
  }
  return sum;
}

}  // namespace astrolith
