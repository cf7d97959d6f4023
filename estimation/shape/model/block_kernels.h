// The kernels of some of a model's metaballs at the points of a small block, and from them the sums, the
// shares and the derivatives of distances or levels: the rows of the fit's Jacobian. The innermost loops run
// over the points of the block, so that the compiler vectorises them.
//
// With u_i = (p - c_i) / r_i^2, q_i = |p - c_i|^2 / r_i^2, w = softmax(k) and G = sum_i w_i u_i,
//   L = Lambda / kappa,  Lambda = log sum_i exp k_i,      s = L / N,  N = sqrt(4 |G|^2 + floor)
//   dLambda = w_i dk_i,   dG = w_i dk_i (u_i - G) + w_i du_i,   ds = dL / N - s (4 G . dG) / N^2
// where  dk_i/dc_i = 2 kappa u_i,  dk_i/dlog r_i = 2 kappa q_i,  dk_i/dkappa = 1 - q_i,
//        du_i/dc_i = -1 / r_i^2,   du_i/dlog r_i = -2 u_i.
// The sums carry the kernel floor of synthesis/body/metaballs.h. The derivatives treat the cut-off as
// constant. With subtractive metaballs, Lambda = log P - log(1 + N). A subtractive metaball j has the weight
// w_j = -exp k_j / (1 + N), and
//   dG = w_i dk_i (u_i - G_i) + w_i du_i
// where G_i is the mean of u over the metaballs of the same kind as i: sum exp k u / P for additive ones, and
// sum exp k u / (1 + N) for subtractive ones. This holds where the floor is small beside A = P / (1 + N).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "estimation/shape/model/metaball_model.h"

namespace astrolith {

// Derivatives by the parameters of one sphere: its centre (3), then the logarithm of its radius.
using SphereDerivatives = std::array<double, 4>;

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

  // How a function of the model depends on its values at one point: on log A and on G, with
  // the sharpness fixed, and on the sharpness kappa with log A and G fixed.
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

  // Writes the derivatives of functions with these slopes, one at each point. Row j of
  // `by_sphere` has the derivatives of point j by the selected spheres: by the centre and by the log radius.
  // Other columns stay as they are. `by_log_sharpness` has one derivative a point, and includes all spheres
  // of the list.
  void differentiate(std::span<const Slopes> slopes, const Columns& selected, SphereDerivatives* by_sphere,
                     std::span<double> by_log_sharpness) const;

 private:
  using Lanes = std::array<double, kMostPoints>;
  struct Sums {
    alignas(64) Lanes kernel{}, x{}, y{}, z{};
  };

  alignas(64) Lanes x_{}, y_{}, z_{};
  Sums added_, subtracted_;
  double sharpness_ = 0.0;
  std::size_t points_ = 0;
  std::vector<MetaballSphere<double>> spheres_;
  std::vector<Lanes> kernels_;  // (#spheres)
};

// s at a point from its sums, in length units, positive inside, and its slopes.
double distance_with_slopes(const MetaballModel& model, const ModelEvaluation& evaluation,
                            const MetaballTotals<double>& totals, BlockKernels::Slopes& slopes);

// L at a point from its sums, and its slopes. L has no unit: it is 0 on the surface, negative outside, and 1
// at the centre of a lone metaball. Unlike s, it is smooth where the gradient vanishes.
double level_with_slopes(const MetaballModel& model, const MetaballTotals<double>& totals,
                         BlockKernels::Slopes& slopes);

}  // namespace astrolith
