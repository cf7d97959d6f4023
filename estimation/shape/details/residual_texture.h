// What a base left of the measured surface, as a Gabor layer: detail learnt from the body itself.
//
// The heights of the target over the base, in square patches of tangent planes, are exemplars of one texture.
// Patches lie where the base is flat enough to be seen from its tangent plane, their axes as those of a Gabor
// layer on a surface: first east, then south. Each is detrended by a plane and tapered; not the patches but
// their periodograms are joined, by averaging.
#pragma once

#include <cstdint>
#include <optional>

#include "estimation/shape/target/target_body.h"
#include "numerics/progress.h"
#include "recipe/recipe.h"

namespace astrolith {

struct ResidualTextureOptions {
  int patches = 200;  // tried
  int side = 32;      // pixels, each half a facet's edge wide; >= 32
  std::uint64_t seed = 1;
};

struct ResidualTexture {
  GaborLayer layer;  // in the target's frame: lengths are fractions of the diagonal
  int patches = 0;   // that could be used
};

// `base` in the target's frame. Throws InputError when no patch is flat enough or the base leaves nothing.
ResidualTexture fit_residual_texture(const TargetBody& target, const MetaballBody& base,
                                     const ResidualTextureOptions& options, const Progress& progress = {});

}  // namespace astrolith
