// Fits a Gabor layer to the residual of a base: detail learnt from the body itself.
//
// The heights of the target over the base in square patches of tangent planes are exemplars of one texture.
// Patches lie where the base is nearly flat. Their axes are those of a Gabor layer on a surface: first east,
// then south. Each patch is detrended by a plane and tapered, and the periodograms of all patches are
// averaged.
#pragma once

#include <cstdint>
#include <optional>

#include "estimation/shape/target/target_body.h"
#include "numerics/progress.h"
#include "recipe/recipe.h"

namespace astrolith {

struct ResidualTextureOptions {
  int patches = 200;  // number of places that are tried, > 0
  int side = 32;      // of a patch in pixels, each half a facet's edge wide; >= 32
  std::uint64_t seed = 1;
};

struct ResidualTexture {
  GaborLayer layer;  // in the target's frame: lengths are fractions of the diagonal
  int patches = 0;   // number of patches that were flat enough
};

// `base` is in the target's frame. Throws InputError if no patch is flat enough, or if the base leaves no
// residual.
ResidualTexture fit_residual_texture(const TargetBody& target, const MetaballBody& base,
                                     const ResidualTextureOptions& options, const Progress& progress = {});

}  // namespace astrolith
