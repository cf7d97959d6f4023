// Gabor noise on a torus: a texture that repeats without a seam.
//
// The grid of cells closes on itself, so every kernel that leaves one side enters at the other and the noise
// is periodic, to float rounding, with the spectrum of the endless noise at the frequencies that fit into the
// period.
#pragma once

#include "recipe/recipe.h"

namespace astrolith {

// Covariance at lag tau, over that at 0, of the noise of kernels e(u) cos(2 pi f u + phase) along one axis
// (gabor_kernel.h), without the cosine. tau in units of 1/a; 0 beyond twice the reach.
double gabor_profile_correlation(double tau);

// Variance of a layer's noise on a torus of width x height pixels over that of the endless noise:
//   sum over the lobes of share * c(width, f_x) c(height, f_y),   c(n, f) = sum_j rho(a j n) cos(2 pi f j n)
// which is the mean of the spectrum over the torus's own frequencies. Close to 1 where lobes are wide beside
// 1/n; 0 where all lobes are narrow and lie between these frequencies.
double tiled_variance(const GaborLayer& layer, int width, int height);

}  // namespace astrolith
