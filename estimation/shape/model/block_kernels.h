// The kernels of some of a model's metaballs at the points of a small block, and from them the sums, the
// shares and the derivatives of distances or levels. The innermost loops run over the points of the block, so
// that the compiler vectorises them. The equations are those of field_derivatives.h.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "estimation/shape/model/metaball_model.h"

namespace astrolith {

class BlockKernels {
 public:
  static constexpr std::size_t kMostPoints = 24;

  // Evaluates the kernels of `spheres` at 1 to kMostPoints points. `spheres` are indices of the model's
  // spheres. Those that are left out must not reach the points. The model must outlive this.
  void evaluate(const MetaballModel& model, const ModelEvaluation& evaluation,
                std::span<const std::int32_t> spheres, std::span<const Vec3d> points);

  // The sums at a point of the block.
  MetaballTotals<double> totals(std::size_t point) const;

  // The share of a sphere in the sum of its kind at a point: k / P for an additive metaball, k / (1 + N) for
  // a subtractive one. `sphere` is a place in the list of spheres.
  double share(std::size_t sphere, std::size_t point) const;
  // The largest of its shares at all points.
  double largest_share(std::size_t sphere) const;

  // How a function of the model depends on its values at one point: on log A and on G (field_derivatives.h),
  // with the sharpness fixed, and on the sharpness kappa with log A and G fixed.
  struct Slopes {
    double by_log_sum = 0.0;
    Vec3d by_mean;
    double by_sharpness = 0.0;

    void scale(double factor) {
      by_log_sum *= factor;
      by_mean *= factor;
      by_sharpness *= factor;
    }
  };

  // Some of the spheres, with the columns that their derivatives go to.
  struct Columns {
    std::span<const std::int32_t> spheres;  // places in the list of spheres
    std::span<const std::size_t> columns;
    std::size_t count;  // of all columns
  };

  // Writes the derivatives of functions with these slopes, one at each point; Gaussian kernels only. Row j of
  // `by_sphere` has the derivatives of point j by the selected spheres: by the centre and by the log radius.
  // Other columns stay as they are. `by_log_sharpness` has one derivative a point, and includes all spheres
  // of the list.
  void differentiate(std::span<const Slopes> slopes, const Columns& selected,
                     std::array<double, 4>* by_sphere, std::span<double> by_log_sharpness) const;

 private:
  using Lanes = std::array<double, kMostPoints>;
  struct Sums {
    alignas(64) Lanes kernel{}, x{}, y{}, z{};
  };

  void add_other_kernel(const ModelEvaluation& evaluation, std::size_t sphere, Sums& sums);

  alignas(64) Lanes x_{}, y_{}, z_{};
  Sums added_, subtracted_;
  double sharpness_ = 0.0;
  std::size_t points_ = 0;
  std::vector<MetaballSphere<double>> spheres_;
  std::vector<Lanes> kernels_;  // (#spheres)
};

// s at a point from its sums, as distance_with_derivatives() gives it, and its slopes; Gaussian kernels only.
double distance_with_slopes(const MetaballModel& model, const ModelEvaluation& evaluation,
                            const MetaballTotals<double>& totals, BlockKernels::Slopes& slopes);

// L at a point from its sums, as level_with_derivatives() gives it, and its slopes; Gaussian kernels only.
double level_with_slopes(const MetaballModel& model, const MetaballTotals<double>& totals,
                         BlockKernels::Slopes& slopes);

}  // namespace astrolith
