// Metaballs around an origin of double precision, for points so close together that float coordinates in the
// frame of the body could not tell them apart.
#pragma once

#include "synthesis/body/body_tables.h"
#include "synthesis/body/metaball_body.h"

namespace astrolith {

// s and grad L of metaballs at the point origin + p, computed in double precision.
ASTROLITH_HD inline SurfaceDistance<double> local_distance(const MetaballParameters<double>& body,
                                                           const MetaballSphere<float>* spheres,
                                                           std::uint32_t count, const Vec3d& origin,
                                                           const Vec3f& local) {
  const Vec3d p = origin + Vec3d{double{local.x}, double{local.y}, double{local.z}};
  MetaballTotals<double> totals;
  for (std::uint32_t i = 0; i < count; ++i) {
    const MetaballSphere<float>& s = spheres[i];
    const MetaballSphere<double> sphere{{double{s.center.x}, double{s.center.y}, double{s.center.z}},
                                        double{s.inverse_radius_squared}};
    accumulate_metaball(body, sphere, p, totals);
  }
  return metaball_distance(body, totals.net());
}

// evaluate_metaballs() at the points origin + (x, y, z), computed in double precision and rounded to float.
// Its digits do not depend on the ratio of the distance between points to the size of the body.
void evaluate_local_metaballs(const MetaballsView& metaballs, const Vec3d& origin, int n, const float* x,
                              const float* y, const float* z, float* distance, float* gradient_x,
                              float* gradient_y, float* gradient_z);

// The metaballs of a plain body, from the lists of those that reach a box.
inline MetaballsView plain_metaballs(const BodyTables& body, const ArrayView& arrays,
                                     const LeafLists& lists) {
  return {arrays[body.leaves][0].metaballs,
          {lists.spheres + lists.first[0], lists.first[1] - lists.first[0]}};
}

}  // namespace astrolith
