// Oriented points for the tests of this folder.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/surface/mesh_sampling.h"
#include "tests/support/meshes.h"
#include "tests/support/points.h"

namespace astrolith::testing {

// Random surflets: positions in a unit cube and normals in all directions, which fill all bins.
inline SurfaceSamples random_surflets(int n, std::uint64_t seed) {
  CounterRandom random(seed);
  SurfaceSamples s;
  for (int i = 0; i < n; ++i) {
    s.points.push_back({random.uniform(), random.uniform(), random.uniform()});
    s.normals.push_back(random_direction(random));
  }
  return s;
}

// Rotates p by the quaternion (w, v) of unit length.
inline Vec3d rotated(double w, const Vec3d& v, const Vec3d& p) {
  const Vec3d t = 2.0 * cross(v, p);
  return p + w * t + cross(v, t);
}

}  // namespace astrolith::testing
