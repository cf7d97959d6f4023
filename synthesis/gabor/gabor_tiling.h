// Gabor noise on a torus: a texture that repeats without a seam.
//
// The grid of cells is periodic, so that every kernel that leaves one side enters at the other side. The
// noise is periodic up to float rounding. At the frequencies that fit into the period it has the spectrum of
// the endless noise.
#pragma once

#include "recipe/recipe.h"

namespace astrolith {

// The covariance at lag tau over the covariance at lag 0 for the noise of kernels e(u) cos(2 pi f u + phase)
// along one axis (gabor_kernel.h), without its cosine factor. tau is in units of 1/a. The result is 0 beyond
// twice the reach.
double gabor_profile_correlation(double tau);

// The variance of the noise of a layer on a torus of width x height pixels, over the variance of the endless
// noise:
//
//   sum over the lobes of share * c(width, f_x) c(height, f_y),   c(n, f) = sum_j rho(a j n) cos(2 pi f j n)
//
// It equals the mean of the spectrum over the frequencies that fit into the period. It is close to 1 where
// the lobes are wide beside 1/n, and 0 where all lobes are narrow and lie between these frequencies.
double tiled_variance(const GaborLayer& layer, int width, int height);

}  // namespace astrolith
