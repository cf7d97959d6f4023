// First-order signed distance s and level L of a metaball model at one point, with exact derivatives by every
// sphere and by the sharpness: the rows of the fit's Jacobian. The equations below are for the Gaussian. The
// other kernels are in compact_kernel_derivatives_internal.h.
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

#include "estimation/shape/model/metaball_model.h"

namespace astrolith {

// Derivatives by the parameters of one sphere: its centre (3), then the logarithm of its radius.
using SphereDerivatives = std::array<double, 4>;

// Returns s(p) in length units, positive inside. `neighbours` are the spheres that may reach p. `by_sphere`
// is empty or as long as `neighbours`. If it is not empty, it and `by_log_sharpness` receive the derivatives.
double distance_with_derivatives(const MetaballModel& model, const ModelEvaluation& parameters,
                                 std::span<const std::int32_t> neighbours, const Vec3d& p,
                                 std::span<SphereDerivatives> by_sphere, double* by_log_sharpness);

// Returns L(p), which has no unit: 0 on the surface, negative outside, and 1 at the centre of a lone Gaussian
// metaball. Unlike s, it is smooth where the gradient vanishes.
double level_with_derivatives(const MetaballModel& model, const ModelEvaluation& parameters,
                              std::span<const std::int32_t> neighbours, const Vec3d& p,
                              std::span<SphereDerivatives> by_sphere, double* by_log_sharpness);

}  // namespace astrolith
