#include "synthesis/body/level_expansion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "numerics/interval.h"
#include "numerics/scalar_math.h"
#include "synthesis/body/metaball_bounds.h"

namespace astrolith {
namespace {

// The relative rounding of the float evaluation: of one kernel and its slope, with room to spare, and of each
// addition.
constexpr double kKernelEpsilon = 1e-5, kSumEpsilon = 6e-8;
// Beyond this share of the sum, kernels that end in the box and the constant floor leave no useful bound.
constexpr double kMostShare = 0.05;
// The largest exponent by which a weight may grow within the box. The exponential of floats ends at 88.
constexpr double kLargestGrowth = 40.0;

// The kernels of one kind of spheres around the centre of a box: one entry for each sphere.
struct KernelColumns {
  std::vector<float> value;       // exp k_i at the centre; 0 unless the support holds the whole box
  std::vector<float> edge;        // the largest exp k_i of a support that ends in the box, else 0
  std::vector<float> exponent;    // the largest k_i
  std::vector<float> vx, vy, vz;  // v_i
  std::vector<float> curvature;   // c_i
  std::vector<float> spread, weight;

  void resize(std::size_t n) {
    if (value.size() >= n) return;
    for (auto* v : {&value, &edge, &exponent, &vx, &vy, &vz, &curvature, &spread, &weight}) v->resize(n);
  }
};

ASTROLITH_SIMD_CLONES void expand_kernels(const MetaballParameters<float>& body,
                                          const MetaballSphere<float>* __restrict spheres, int n,
                                          const Vec3f& center, float radius, float* __restrict value,
                                          float* __restrict edge, float* __restrict exponent,
                                          float* __restrict vx, float* __restrict vy, float* __restrict vz,
                                          float* __restrict curvature) {
  const float m_a = body.m_a, m_b = body.m_b, x = center.x, y = center.y, z = center.z;
  const float inner = body.cutoff_squared * (1.0f - 1e-4f), outer = body.cutoff_squared * (1.0f + 1e-4f);
#pragma omp simd
  for (int i = 0; i < n; ++i) {
    const float inverse = math::abs(spheres[i].inverse_radius_squared);
    const float dx = x - spheres[i].center.x, dy = y - spheres[i].center.y, dz = z - spheres[i].center.z;
    const float squared = math::fma(dx, dx, math::fma(dy, dy, dz * dz));
    const float distance = math::sqrt(squared);
    const float near = math::max(distance - radius, 0.0f), far = distance + radius;
    const float nearest = near * near * inverse;
    const bool whole = far * far * inverse < inner;
    const float kernel =
        math::exp(math::min(math::fma(-m_b, whole ? squared * inverse : nearest, m_a), kLargestExponent));
    const float partly = nearest < outer ? kernel : 0.0f;
    const float slope = -2.0f * m_b * inverse;
    value[i] = whole ? kernel : 0.0f;
    edge[i] = whole ? 0.0f : partly;
    exponent[i] = math::fma(-m_b, nearest, m_a);
    vx[i] = slope * dx;
    vy[i] = slope * dy;
    vz[i] = slope * dz;
    curvature[i] = -slope;
  }
}

// Writes spread[i] = |v_i - a| + |c_i - e| R / 2.
ASTROLITH_SIMD_CLONES void take_spreads(int n, const Vec3f& a, float e, float radius,
                                        const float* __restrict vx, const float* __restrict vy,
                                        const float* __restrict vz, const float* __restrict curvature,
                                        float* __restrict spread) {
  const float ax = a.x, ay = a.y, az = a.z;
#pragma omp simd
  for (int i = 0; i < n; ++i) {
    const float x = vx[i] - ax, y = vy[i] - ay, z = vz[i] - az;
    spread[i] =
        math::sqrt(math::fma(x, x, math::fma(y, y, z * z))) + 0.5f * radius * math::abs(curvature[i] - e);
  }
}

// Writes bounds of exp k_i over the box, up to the factor that all kernels have in common: the mean of k_i
// over the sum is a.d - e |d|^2 / 2 everywhere, since a and e are weighted means of v_i and c_i, so that the
// sum of exp (k_i less this mean) is nowhere less than at the centre (Jensen).
ASTROLITH_SIMD_CLONES void grow_weights(int n, float radius, const float* __restrict value,
                                        const float* __restrict spread, float* __restrict weight) {
#pragma omp simd
  for (int i = 0; i < n; ++i) weight[i] = value[i] * math::exp(radius * spread[i]);
}

// The logarithm of a sum of kernels over a box, in terms of LevelExpansion.
struct LogSum {
  bool useful = true;
  double value = 0.0;  // at the centre
  Vec3d gradient;
  double below = 0.0, above = 0.0;  // factors of |d|^2
  double turn = 0.0;                // bound of the second derivatives
  double least = 0.0, most = 0.0;   // bounds of the sum over the box, without the kernels that end there
  double roughness = 0.0;           // mean of |grad k_i|, by which rounding errors scale
  double edge_share = 0.0;          // bound of the share of the kernels that end in the box
  double edge_slope = 0.0;          // bound of their |grad k_i|
};

// Bounds log(constant + sum of the kernels); the constant is 0 or 1.
LogSum expand_sum(const MetaballParameters<float>& body, std::span<const MetaballSphere<float>> spheres,
                  const Vec3f& center, double radius, double constant) {
  thread_local KernelColumns k;
  k.resize(spheres.size());
  const int n = static_cast<int>(spheres.size());
  const auto r = static_cast<float>(radius);
  expand_kernels(body, spheres.data(), n, center, r, k.value.data(), k.edge.data(), k.exponent.data(),
                 k.vx.data(), k.vy.data(), k.vz.data(), k.curvature.data());
  LogSum sum;
  double total = constant, curvature = 0.0, edges = 0.0, sharpest = 0.0;
  Vec3d weighted;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const double f = k.value[i];
    if (k.exponent[i] > kLargestExponent) sum.useful = false;
    if (k.edge[i] > 0.0f) {
      edges += k.edge[i];
      const Vec3d v{k.vx[i], k.vy[i], k.vz[i]};
      sum.edge_slope = std::max(sum.edge_slope, norm(v) + k.curvature[i] * radius);
    }
    if (!(f > 0.0)) continue;
    total += f;
    weighted += f * Vec3d{k.vx[i], k.vy[i], k.vz[i]};
    curvature += f * k.curvature[i];
    sharpest = std::max(sharpest, double{k.curvature[i]});
  }
  sum.useful = sum.useful && total > 0.0;
  if (!sum.useful) return sum;
  const Vec3d a = weighted * (1.0 / total);
  const double e = curvature / total, length = norm(a);
  take_spreads(n, to_float(a), static_cast<float>(e), r, k.vx.data(), k.vy.data(), k.vz.data(),
               k.curvature.data(), k.spread.data());
  const double constant_spread = length + 0.5 * radius * e;
  double mean_spread = constant * constant_spread;
  for (std::size_t i = 0; i < spheres.size(); ++i) mean_spread += double{k.value[i]} * k.spread[i];
  mean_spread /= total;
  grow_weights(n, r, k.value.data(), k.spread.data(), k.weight.data());
  // Bounds of the mean curvature and of the variance of the slopes. Beyond kLargestGrowth the weights say
  // nothing, and the largest curvature and deviation are the bounds.
  double bend = 0.0, variance = 0.0, widest = 0.0, growth = 0.0;
  const auto add = [&](double weight, double spread, double c) {
    const double deviation = spread + 0.5 * radius * std::fabs(c - e);  // at least |grad k_i - grad k_mean|
    bend += weight * c;
    variance += weight * deviation * deviation;
    widest = std::max(widest, deviation);
    growth = std::max(growth, radius * spread);
  };
  if (constant > 0.0) {
    add(constant * portable::exp(radius * constant_spread), constant_spread, 0.0);
  }
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    if (k.value[i] > 0.0f) add(k.weight[i], k.spread[i], k.curvature[i]);
  }
  if (growth > kLargestGrowth) bend = variance = std::numeric_limits<double>::infinity();
  constexpr double kUp = 1.0 + 1e-3;
  bend = std::min(bend / total, sharpest) * kUp;
  variance = std::min(variance / total, widest * widest) * kUp;
  sum.value = portable::log(total);
  sum.gradient = a;
  sum.below = 0.5 * bend;
  sum.above = 0.5 * variance;
  sum.turn = std::max(bend, variance);
  sum.roughness = length + mean_spread + sum.turn * radius;
  sum.least = total * portable::exp(-length * radius - sum.below * radius * radius);
  sum.most = total * portable::exp(std::min(length * radius + sum.above * radius * radius, 600.0));
  sum.edge_share = edges / sum.least;
  return sum;
}

}  // namespace

std::optional<LevelExpansion> expand_level(const MetaballsView& metaballs, const Box& box) {
  const MetaballParameters<float>& body = metaballs.parameters;
  if (body.compact_kernel.kernel != Kernel::kGaussian) return {};
  const Vec3f center = to_float(box.center());
  const double farthest = largest_coordinate(box);
  const double radius = 0.5 * norm(box.extent()) + 1e-6 * farthest;
  const LogSum added = expand_sum(body, metaballs.adding(), center, radius, 0.0);
  if (!added.useful || added.edge_share > kMostShare) return {};
  const bool subtracts = !metaballs.subtractive().empty();
  LogSum subtracted;
  subtracted.least = subtracted.most = 1.0;
  if (subtracts) subtracted = expand_sum(body, metaballs.subtractive(), center, radius, 1.0);
  if (!subtracted.useful || subtracted.edge_share > kMostShare) return {};
  // A + floor is (P + floor (1 + N)) / (1 + N).
  const double floor_share = double{kKernelFloor} * (1.0 + kMostShare) * subtracted.most / added.least;
  if (floor_share > kMostShare) return {};

  const double inverse_m = body.inverse_m;
  const double shares = added.edge_share + subtracted.edge_share + floor_share;
  const double roughness = (added.roughness + subtracted.roughness) * inverse_m;
  const double level = (added.value - subtracted.value) * inverse_m - double{body.log_iso};
  const Vec3d gradient = inverse_m * (added.gradient - subtracted.gradient);
  const double kinds = subtracts ? 2.0 : 1.0;
  const double sum_rounding = kKernelEpsilon + kSumEpsilon * double(metaballs.spheres.size());
  const double rounding = kinds * (5e-5 + sum_rounding + 2e-6 * std::fabs(double{body.m_a})) * inverse_m +
                          (1e-6 * farthest + sum_rounding * radius) * roughness + 1e-6 * std::fabs(level);
  // A kernel that ends in the box changes the gradient by at most its share times the difference of slopes.
  const auto bent = [&](const LogSum& sum) {
    return sum.edge_share * (sum.edge_slope + sum.roughness) * inverse_m;
  };
  const auto to = [](double v) { return static_cast<float>(v); };
  return LevelExpansion{
      center,
      to(level),
      to_float(gradient),
      to((added.below + subtracted.above) * inverse_m),
      to((added.above + subtracted.below) * inverse_m),
      to(rounding + shares * inverse_m),
      to((added.turn + subtracted.turn) * inverse_m),
      to(sum_rounding * roughness + floor_share * roughness + bent(added) + bent(subtracted))};
}

ExpansionBounds bound_expansion(const LevelExpansion& e, const MetaballParameters<float>& body,
                                const Box& box) {
  const Vec3d center{e.center.x, e.center.y, e.center.z}, g{e.gradient.x, e.gradient.y, e.gradient.z};
  const double margin = 1e-6 * largest_coordinate(box);
  const Vec3d reach{farthest_offset(center.x, box.min.x, box.max.x) + margin,
                    farthest_offset(center.y, box.min.y, box.max.y) + margin,
                    farthest_offset(center.z, box.min.z, box.max.z) + margin};
  const double linear = std::fabs(g.x) * reach.x + std::fabs(g.y) * reach.y + std::fabs(g.z) * reach.z;
  const double squared = squared_norm(reach), radius = std::sqrt(squared), slope = norm(g);
  const double low = double{e.below} * squared + double{e.slack},
               high = double{e.above} * squared + double{e.slack};
  const double turn = double{e.turn} * radius + double{e.turn_slack};
  const double floor = body.gradient_floor, flattest = std::max(slope - turn, 0.0);
  return {
      {double{e.level} - linear - low, double{e.level} + linear + high, metaball_divisor(body, slope + turn)},
      std::sqrt(flattest * flattest + floor) * (1.0 - kDistanceSlack),
      low + high < 0.3 * linear};
}

// With q = grad L / (|grad L|^2 + floor), a step is L q. At the centre q is q0, and the linear part of a
// step, (level + gradient.d) q0, takes from d what lies along the gradient. The rest of it is at most
//
//   |L - level - gradient.d| |q| + |level + gradient.d| |q - q0|,    |q - q0| <= |grad L - gradient| max
//   |q|^2.
Box projected_box(const LevelExpansion& e, const ExpansionBounds& bounds,
                  const MetaballParameters<float>& body, const Box& box, double longest_step) {
  const double margin = 1e-6 * largest_coordinate(box), divisor = bounds.divisor_min;
  const Vec3d center{e.center.x, e.center.y, e.center.z}, g{e.gradient.x, e.gradient.y, e.gradient.z};
  const Vec3d half = 0.5 * box.extent() + Vec3d{margin, margin, margin};
  const Vec3d q0 = g * (1.0 / (squared_norm(g) + double{body.gradient_floor}));
  const double squared = squared_norm(half),
               turn = double{e.turn} * std::sqrt(squared) + double{e.turn_slack};
  const double bend = double{std::max(e.below, e.above)} * squared + double{e.slack};
  const double farthest =
      std::max(std::fabs(bounds.interval.level_min), std::fabs(bounds.interval.level_max));
  const double level = std::min(farthest, longest_step * bounds.interval.gradient_max) + bend;
  const double rest = (bend + level * turn / divisor) / divisor + 2.0 * margin;
  const auto reach = [&](const Vec3d& row) {  // of a coordinate of d - (gradient.d) q0
    return std::fabs(row.x) * half.x + std::fabs(row.y) * half.y + std::fabs(row.z) * half.z + rest;
  };
  const Vec3d middle = center - double{e.level} * q0;
  const Vec3d wide{reach(Vec3d{1.0, 0.0, 0.0} - q0.x * g), reach(Vec3d{0.0, 1.0, 0.0} - q0.y * g),
                   reach(Vec3d{0.0, 0.0, 1.0} - q0.z * g)};
  const Box linear{middle - wide, middle + wide};
  const Box near = widened(box, std::min(farthest / divisor, longest_step) + 2.0 * margin);
  return boxes_touch(linear, near) ? common_part(linear, near) : near;
}

}  // namespace astrolith
