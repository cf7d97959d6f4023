// Metaballs around an origin of double precision, for points so close together that float coordinates in the
// frame of the body could not tell them apart.
#pragma once

#include "synthesis/body/body_tables.h"
#include "synthesis/body/metaball_body.h"

namespace astrolith {

// evaluate_metaballs() at the points origin + (x, y, z), computed in double precision and rounded to float.
// Its digits do not depend on the ratio of the distance between points to the size of the body.
void evaluate_local_metaballs(const MetaballsView& metaballs, const Vec3d& origin, int n, const float* x,
                              const float* y, const float* z, float* distance, float* gradient_x,
                              float* gradient_y, float* gradient_z);

// The metaballs of a plain body, from the lists of those that reach a box.
inline MetaballsView metaballs_of_plain(const BodyTables& body, const ArrayView& arrays,
                                        const LeafLists& lists) {
  return {arrays[body.leaves][0].metaballs,
          {lists.spheres + lists.first[0], lists.first[1] - lists.first[0]}};
}

}  // namespace astrolith
