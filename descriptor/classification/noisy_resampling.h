// Resamples a shape as a scanner of limited resolution and accuracy would see it.
//
// Thesis 3.5 and 3.6.2 take Poisson-disk samples of 10 to 20 % of a model's vertices "with some random
// noise". They state neither the amount of noise nor the origin of the normals. Here independent Gaussian
// numbers move each point along x, y and z, and normals are fitted to the moved points alone. The result
// tells nothing else about the model than the side on which its outside lies.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace astrolith {

struct ResamplingOptions {
  double fewest = 0.1, most = 0.2;  // range of the number of points, as fractions of the vertices
  double noise = 0.005;             // standard deviation along each axis, fraction of the diagonal
  int normal_neighbours = 12;       // number of neighbours that a normal is fitted to
};

struct NoisyResampling {
  std::vector<Vec3d> points, normals;  // (n) each
  double fraction = 0;                 // n over the number of vertices
};

// The number of points is drawn uniformly from the range, and is at least 64. The result depends on the mesh,
// the options and the seed alone. Throws InputError for a mesh without area and for options out of range.
NoisyResampling noisy_resampling(const TriangleMesh& mesh, const ResamplingOptions& options,
                                 std::uint64_t seed);

}  // namespace astrolith
