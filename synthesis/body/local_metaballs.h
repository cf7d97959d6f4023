// The metaball body close to an origin of double precision, where float coordinates of the body's frame would
// not tell neighbouring points apart.
#pragma once

#include "synthesis/body/metaball_body.h"

namespace astrolith {

// evaluate_metaballs at the points origin + (x, y, z), in double precision but for its results: they keep
// their digits however close together the points lie beside the body's size. exp and log are the C library's
// here, whose last bit is no promise: one result in 10^8 may differ by a bit from library to library.
void evaluate_local_metaballs(const MetaballsView& metaballs, const Vec3d& origin, int n, const float* x,
                              const float* y, const float* z, float* distance, float* gradient_x,
                              float* gradient_y, float* gradient_z);

}  // namespace astrolith
