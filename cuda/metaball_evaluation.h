// The metaball body on a GPU: the signature of synthesis/metaball_body.h's evaluate_metaballs, and its bits.
#pragma once

#include <span>

#include "synthesis/metaball_body.h"

namespace astrolith {

// s(p) at points given as three arrays, into a fourth of the same size. The result has the bits of the CPU's.
// Throws WorkError, with CUDA's words, when the device fails or has too little memory; see probe_device().
void evaluate_metaballs_on_gpu(const PreparedMetaballs& metaballs, std::span<const float> x,
                               std::span<const float> y, std::span<const float> z, std::span<float> distance);

}  // namespace astrolith
