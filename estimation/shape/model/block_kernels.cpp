#include "estimation/shape/model/block_kernels.h"

#include <algorithm>
#include <cmath>

#include "estimation/shape/model/metaball_model.h"
#include "numerics/host_device.h"

namespace astrolith {
namespace {

// What all metaballs of one kind, additive or subtractive, have in common at a point.
struct KindTerms {
  double weight;  // w_i over exp k_i
  Vec3d mean;     // G_i
};

class SignedTerms {
 public:
  explicit SignedTerms(const MetaballTotals<double>& totals)
      : added_(weighted_terms(totals.added, 1.0 / (totals.added.kernel + double{kKernelFloor}))),
        subtracted_(weighted_terms(totals.subtracted, 1.0 / (1.0 + totals.subtracted.kernel))) {
    subtracted_.weight *= -1.0;
  }

  const KindTerms& of(bool subtractive) const { return subtractive ? subtracted_ : added_; }
  Vec3d weighted_mean() const { return added_.mean - subtracted_.mean; }  // G

 private:
  static KindTerms weighted_terms(const MetaballSums<double>& sums, double weight) {
    return {weight, sums.weighted * weight};
  }

  KindTerms added_, subtracted_;
};

constexpr std::size_t kLanes = BlockKernels::kMostPoints;

// Kernels with smaller exponents lie far beyond their support.
constexpr double kLeastExponent = -60.0;

// e^x for |x| <= 60, within 1e-15 of itself. portable::exp has a conversion to integers that most processors
// cannot do for many numbers at once.
ASTROLITH_KERNEL double lane_exp(double x) {
  constexpr double kMagic = 6755399441055744.0;  // 1.5 * 2^52: the last bits of the sum are the integer
  const double shifted = x * 1.44269504088896340736 + kMagic;
  const double n = shifted - kMagic;
  const double r = (x - n * portable::kLn2High) - n * portable::kLn2Low;
  // Taylor coefficients 1/k!; |r| <= ln(2)/2 leaves a remainder below 2e-16.
  return portable::exp_series(1.0 / 479001600.0, r) *
         portable::from_bits((portable::to_bits(shifted) + 1023) << 52);
}

// The coordinates of a block's points.
struct LanePoints {
  const double *x, *y, *z;
};

// The kernels of one sphere at all points, which are added to the sums of its kind.
ASTROLITH_SIMD_CLONES void add_gaussian(const LanePoints& points, const MetaballSphere<double>& sphere,
                                        double sharpness, double cutoff_squared, double* __restrict kernels,
                                        double* __restrict sum, double* __restrict sum_x,
                                        double* __restrict sum_y, double* __restrict sum_z) {
  const double cx = sphere.center.x, cy = sphere.center.y, cz = sphere.center.z;
  const double v = std::fabs(sphere.inverse_radius_squared);
  const double *px = points.x, *py = points.y, *pz = points.z;
#pragma omp simd
  for (std::size_t j = 0; j < kLanes; ++j) {
    const double dx = px[j] - cx, dy = py[j] - cy, dz = pz[j] - cz;
    const double q = (dx * dx + dy * dy + dz * dz) * v;
    const double exponent = sharpness - sharpness * q;
    const double low = exponent > kLeastExponent ? exponent : kLeastExponent;
    const double within = low < double{kLargestExponent} ? low : double{kLargestExponent};
    const double power = lane_exp(within);
    const double kernel = q < cutoff_squared ? power : 0.0;
    const double weight = kernel * v;
    kernels[j] = kernel;
    sum[j] += kernel;
    sum_x[j] += weight * dx;
    sum_y[j] += weight * dy;
    sum_z[j] += weight * dz;
  }
}

// The slopes of all points as arrays. `weight` and `base` belong to one kind of spheres: w_i over exp k_i,
// and the slope by log A without G's share in it.
struct LaneSlopeView {
  const double *by_mean_x, *by_mean_y, *by_mean_z, *weight, *base;
};

// Adds sum_i (1 - q_i) dk_i of one sphere, the derivative by the sharpness.
ASTROLITH_SIMD_CLONES void add_by_sharpness(const LanePoints& points, const MetaballSphere<double>& sphere,
                                            const double* __restrict kernels, const LaneSlopeView& slopes,
                                            double* __restrict sum) {
  const double cx = sphere.center.x, cy = sphere.center.y, cz = sphere.center.z;
  const double v = std::fabs(sphere.inverse_radius_squared);
  const double *px = points.x, *py = points.y, *pz = points.z;
  const double *gx = slopes.by_mean_x, *gy = slopes.by_mean_y, *gz = slopes.by_mean_z;
  const double *kind_weight = slopes.weight, *base = slopes.base;
#pragma omp simd
  for (std::size_t j = 0; j < kLanes; ++j) {
    const double dx = px[j] - cx, dy = py[j] - cy, dz = pz[j] - cz;
    const double q = (dx * dx + dy * dy + dz * dz) * v;
    const double along = (gx[j] * dx + gy[j] * dy + gz[j] * dz) * v;
    sum[j] += (1.0 - q) * (kernels[j] * kind_weight[j]) * (base[j] + along);
  }
}

// The derivatives by the centre and the log radius of one sphere, `stride` numbers apart for each point.
ASTROLITH_SIMD_CLONES void write_by_sphere(const LanePoints& points, const MetaballSphere<double>& sphere,
                                           double sharpness, const double* __restrict kernels,
                                           const LaneSlopeView& slopes, std::size_t point_count,
                                           std::size_t stride, double* __restrict rows) {
  alignas(64) double by_x[kLanes], by_y[kLanes], by_z[kLanes], by_radius[kLanes];
  const double cx = sphere.center.x, cy = sphere.center.y, cz = sphere.center.z;
  const double v = std::fabs(sphere.inverse_radius_squared);
  const double *px = points.x, *py = points.y, *pz = points.z;
  const double *gx = slopes.by_mean_x, *gy = slopes.by_mean_y, *gz = slopes.by_mean_z;
  const double *kind_weight = slopes.weight, *base = slopes.base;
#pragma omp simd
  for (std::size_t j = 0; j < kLanes; ++j) {
    const double dx = px[j] - cx, dy = py[j] - cy, dz = pz[j] - cz;
    const double q = (dx * dx + dy * dy + dz * dz) * v;
    const double along = (gx[j] * dx + gy[j] * dy + gz[j] * dz) * v;
    const double weight = kernels[j] * kind_weight[j];
    const double twice_by_k = 2.0 * sharpness * weight * (base[j] + along);
    const double by_d = twice_by_k * v, by_g = weight * v;
    by_x[j] = dx * by_d - gx[j] * by_g;
    by_y[j] = dy * by_d - gy[j] * by_g;
    by_z[j] = dz * by_d - gz[j] * by_g;
    by_radius[j] = q * twice_by_k - 2.0 * weight * along;
  }
  for (std::size_t j = 0; j < point_count; ++j) {
    double* row = rows + j * stride;
    row[0] = by_x[j];
    row[1] = by_y[j];
    row[2] = by_z[j];
    row[3] = by_radius[j];
  }
}

}  // namespace

void BlockKernels::evaluate(const MetaballModel& model, const ModelEvaluation& evaluation,
                            std::span<const std::int32_t> spheres, std::span<const Vec3d> points) {
  points_ = points.size();
  sharpness_ = model.sharpness;
  for (std::size_t j = 0; j < kLanes; ++j) {
    const Vec3d& p = points[std::min(j, points_ - 1)];
    x_[j] = p.x;
    y_[j] = p.y;
    z_[j] = p.z;
  }
  spheres_.clear();
  for (const std::int32_t i : spheres)
    spheres_.push_back(make_kernel(model.spheres[static_cast<std::size_t>(i)]));
  kernels_.resize(spheres_.size());
  added_ = subtracted_ = {};
  for (std::size_t i = 0; i < spheres_.size(); ++i) {
    Sums& sums = spheres_[i].subtractive() ? subtracted_ : added_;
    add_gaussian({x_.data(), y_.data(), z_.data()}, spheres_[i], sharpness_, evaluation.cutoff_squared,
                 kernels_[i].data(), sums.kernel.data(), sums.x.data(), sums.y.data(), sums.z.data());
  }
}

MetaballTotals<double> BlockKernels::totals(std::size_t point) const {
  const auto at = [&](const Sums& sums) {
    return MetaballSums<double>{sums.kernel[point], {sums.x[point], sums.y[point], sums.z[point]}};
  };
  return {at(added_), at(subtracted_)};
}

double BlockKernels::share(std::size_t sphere, std::size_t point) const {
  const double sum = spheres_[sphere].subtractive() ? 1.0 + subtracted_.kernel[point]
                                                    : added_.kernel[point] + double{kKernelFloor};
  return kernels_[sphere][point] / sum;
}

double BlockKernels::largest_share(std::size_t sphere) const {
  double largest = 0.0;
  for (std::size_t j = 0; j < points_; ++j) largest = std::max(largest, share(sphere, j));
  return largest;
}

void BlockKernels::differentiate(std::span<const Slopes> slopes, const Columns& selected,
                                 SphereDerivatives* by_sphere, std::span<double> by_log_sharpness) const {
  alignas(64) Lanes mean_x{}, mean_y{}, mean_z{}, sum{};
  alignas(64) std::array<Lanes, 2> weight{}, base{};  // of additive and of subtractive spheres
  for (std::size_t j = 0; j < points_; ++j) {
    const SignedTerms terms(totals(j));
    const Vec3d& g = slopes[j].by_mean;
    mean_x[j] = g.x;
    mean_y[j] = g.y;
    mean_z[j] = g.z;
    for (const bool subtractive : {false, true}) {
      const KindTerms& kind = terms.of(subtractive);
      weight[subtractive][j] = kind.weight;
      base[subtractive][j] = slopes[j].by_log_sum - dot(g, kind.mean);
    }
  }
  const LanePoints points{x_.data(), y_.data(), z_.data()};
  const auto slope_view = [&](const MetaballSphere<double>& s) {
    const std::size_t kind = s.subtractive() ? 1 : 0;
    return LaneSlopeView{mean_x.data(), mean_y.data(), mean_z.data(), weight[kind].data(), base[kind].data()};
  };
  for (std::size_t i = 0; i < spheres_.size(); ++i) {
    add_by_sharpness(points, spheres_[i], kernels_[i].data(), slope_view(spheres_[i]), sum.data());
  }
  for (std::size_t j = 0; j < points_; ++j) {
    by_log_sharpness[j] = sharpness_ * (slopes[j].by_sharpness + sum[j]);
  }
  for (std::size_t k = 0; k < selected.spheres.size(); ++k) {
    const auto i = static_cast<std::size_t>(selected.spheres[k]);
    write_by_sphere(points, spheres_[i], sharpness_, kernels_[i].data(), slope_view(spheres_[i]), points_,
                    4 * selected.count, by_sphere[selected.columns[k]].data());
  }
}

double distance_with_slopes(const MetaballModel& model, const ModelEvaluation& evaluation,
                            const MetaballTotals<double>& totals, BlockKernels::Slopes& slopes) {
  const double s = metaball_distance(evaluation, totals.net()).distance;
  const Vec3d g = SignedTerms(totals).weighted_mean();
  const double n2 = 4.0 * squared_norm(g) + evaluation.gradient_floor;
  slopes = {1.0 / (model.sharpness * std::sqrt(n2)), g * (-4.0 * s / n2), -s / model.sharpness};
  return s;
}

double level_with_slopes(const MetaballModel& model, const MetaballTotals<double>& totals,
                         BlockKernels::Slopes& slopes) {
  const double level = model_level(model, totals.net().kernel);
  slopes = {1.0 / model.sharpness, {}, -level / model.sharpness};
  return level;
}

}  // namespace astrolith
