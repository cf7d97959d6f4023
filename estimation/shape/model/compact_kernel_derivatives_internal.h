// The functions of field_derivatives.h for kernels other than the Gaussian. Arguments, units and results are
// as there.
//
// With K_i = K(q_i), D_i = -K'(q_i), C_i = K''(q_i), u_i = (p - c_i) / r_i^2, q_i = |p - c_i|^2 / r_i^2,
//   L = sum_i K_i - 1,    g = grad L = -2 sum_i D_i u_i,    s = L / N,  N = sqrt(|g|^2 + floor)
//   ds = dL / N - s (g . dg) / N^2
//   dK_i/dc_i = 2 D_i u_i,             dK_i/dlog r_i = 2 D_i q_i
//   dg_i/dc_i = 2 D_i / r_i^2 - 4 C_i u_i u_i',    dg_i/dlog r_i = 4 (D_i - C_i q_i) u_i
// and the derivatives by the tension a are, with K(q) = h (k(x q) - e) and x' = d log x / da, h' = d log h /
// da, e' = de/da,
//   dK_i/da = h' K_i - x' D_i q_i - h e',          dg_i/da = -2 ((h' + x') D_i - x' C_i q_i) u_i.
#pragma once

#include <cstdint>
#include <span>

#include "estimation/shape/model/field_derivatives.h"

namespace astrolith {

double compact_distance(const MetaballModel& model, const ModelEvaluation& parameters,
                        std::span<const std::int32_t> neighbours, const Vec3d& p,
                        std::span<SphereDerivatives> by_sphere, double* by_log_sharpness);

double compact_level(const MetaballModel& model, const ModelEvaluation& parameters,
                     std::span<const std::int32_t> neighbours, const Vec3d& p,
                     std::span<SphereDerivatives> by_sphere, double* by_log_sharpness);

}  // namespace astrolith
