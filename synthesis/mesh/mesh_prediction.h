// Predicts the size of a mesh before it is made. The surface is meshed at two low resolutions, and the counts
// are extrapolated as powers of the resolution N:
//
//   triangles ~ N^p, evaluations ~ N^q   with p and q from the two counts: 2 where the surface is smooth
//   working memory ~ N                   the mesher holds single layers of blocks
//
// Detail finer than the cells of the coarse meshes is not seen: a rough body ends with more triangles.
#pragma once

#include <algorithm>
#include <functional>

#include "synthesis/mesh/mesher.h"

namespace astrolith {

struct MeshPrediction {
  int resolution = 0;  // cells along the longest side, border included
  double triangles = 0.0;
  double evaluations = 0.0;    // evaluations of the field
  double working_bytes = 0.0;  // memory of the mesher alone, without its output
};

class MeshGrowth {
 public:
  // Makes two small meshes with `mesh`, which meshes the surface at a resolution. Throws what `mesh` throws.
  explicit MeshGrowth(const std::function<MeshStatistics(int resolution)>& mesh);

  // The prediction for a resolution.
  MeshPrediction at(int resolution) const;
  // The resolution whose number of triangles is nearest to `triangles`, or kMaxResolution when even that has
  // fewer. Throws WorkError when the small meshes are empty.
  int resolution_for(double triangles) const;
  // Wall-clock seconds at the pace of the finer of the two meshes. Large meshes are faster, so that this is
  // an upper estimate.
  double seconds(const MeshPrediction& mesh) const {
    return fine_seconds_ * mesh.evaluations / std::max(fine_.evaluations, 1.0);
  }

 private:
  MeshPrediction coarse_, fine_;
  double fine_seconds_ = 0.0;
};

}  // namespace astrolith
