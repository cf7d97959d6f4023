// A shape as a scanner of limited resolution and accuracy would see it.
//
// Thesis 3.5 and 3.6.2: Poisson-disk samples of 10 to 20 % of a model's vertices "with some random noise".
// How much noise it does not say, nor where normals come from. Here each point is moved by independent
// Gaussian numbers along x, y and z, and normals are fitted to the moved points alone: whoever describes the
// result sees nothing of the model but the side on which its outside lies.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace astrolith {

struct ResamplingOptions {
  double fewest = 0.1, most = 0.2;  // points, drawn evenly between, as fractions of the vertices
  double noise = 0.005;             // standard deviation along each axis, of the bounding-box diagonal
  int normal_neighbours = 12;       // that a normal is fitted to
};

struct NoisyResampling {
  std::vector<Vec3d> points, normals;  // (n) each
  double fraction = 0;                 // n over the vertices
};

// Depends on mesh, options and seed alone; n is at least 64. Throws InputError for a mesh without area and
// for fractions or noise out of order.
NoisyResampling noisy_resampling(const TriangleMesh& mesh, const ResamplingOptions& options,
                                 std::uint64_t seed);

}  // namespace astrolith
