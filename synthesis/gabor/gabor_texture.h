// A Gabor layer on a plane: a texture like the photo that the layer was fitted to, of any size.
#pragma once

#include <cstdint>
#include <vector>

#include "numerics/progress.h"
#include "recipe/recipe.h"

namespace astrolith {

struct TextureOptions {
  std::uint64_t seed = 1;
  int stream = 0;  // textures of one seed and different streams are independent
  // The texture repeats after this many pixels without a seam, up to float rounding; 0: never. Set both or
  // none.
  int period_width = 0;
  int period_height = 0;
};

// Heights at pixel centres, row-major (height x width), x to the right, y down; length units, mean 0,
// standard deviation layer.height_rms. The noise is stationary: a smaller texture is the top left part of a
// larger one. Each band has layer.impulses_per_kernel impulses under a kernel, rounded to a whole number of
// impulses in a cell.
//
// Throws InputError for a size below 1 x 1, and for a period that is too small for the layer. A period is too
// small if the lobes are so narrow that the frequencies which repeat hold less than half or more than twice
// of their variance. When `progress` asks to stop, the rows not yet made are 0.
std::vector<float> synthesize_texture(const GaborLayer& layer, int width, int height,
                                      const TextureOptions& options = {}, const Progress& progress = {});

// Gabor noise on a torus: a texture that repeats without a seam. The grid of cells is periodic, so that every
// kernel that leaves one side enters at the other side. The noise is periodic up to float rounding. At the
// frequencies that fit into the period it has the spectrum of the endless noise.

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
double torus_variance(const GaborLayer& layer, int width, int height);

}  // namespace astrolith
