// First-order signed distance and level of a metaball model at one point, with exact derivatives by every
// sphere and by the sharpness: the rows of the fit's Jacobian. Other kernels than the Gaussian are in
// compact_kernel_derivatives_internal.h.
//
// With u_i = (p - c_i) / r_i^2, q_i = |p - c_i|^2 / r_i^2, w = softmax(k) and G = sum_i w_i u_i,
//   L = Lambda / kappa,  Lambda = log sum_i exp k_i,      s = L / N,  N = sqrt(4 |G|^2 + floor)
//   dLambda = w_i dk_i,   dG = w_i dk_i (u_i - G) + w_i du_i,   ds = dL / N - s (4 G . dG) / N^2
// where  dk_i/dc_i = 2 kappa u_i,  dk_i/dlog r_i = 2 kappa q_i,  dk_i/dkappa = 1 - q_i,
//        du_i/dc_i = -1 / r_i^2,   du_i/dlog r_i = -2 u_i.
// The sums carry the kernel floor of synthesis/body/metaballs.h; the cut-off counts as constant.
// Where spheres take away, Lambda = log P - log(1 + N), and theirs are the weights -exp k_j / (1 + N). Then
//   dG = w_i dk_i (u_i - G_i) + w_i du_i
// where the floor is small beside A, with G_i the mean of u over the kind of sphere i: sum exp k u / P, or
// sum exp k u / (1 + N).
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "estimation/shape/model/metaball_model.h"

namespace astrolith {

// Derivatives by one sphere: centre (3) and log radius.
using SphereDerivatives = std::array<double, 4>;

// s(p): positive inside, length units. `neighbours` are the spheres that may reach p. Where `by_sphere`
// (as long as neighbours) is not empty it and `by_log_sharpness` receive derivatives.
double distance_with_derivatives(const MetaballModel& model, const ModelEvaluation& parameters,
                                 std::span<const std::int32_t> neighbours, const Vec3d& p,
                                 std::span<SphereDerivatives> by_sphere, double* by_log_sharpness);

// L(p): 1 at the centre of a lone sphere, 0 on the surface, negative outside; without unit. Well behaved
// where the gradient vanishes, unlike s.
double level_with_derivatives(const MetaballModel& model, const ModelEvaluation& parameters,
                              std::span<const std::int32_t> neighbours, const Vec3d& p,
                              std::span<SphereDerivatives> by_sphere, double* by_log_sharpness);

}  // namespace astrolith
