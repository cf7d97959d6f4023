// How large a mesh will be, before it is made: it is made at two low resolutions, nothing is kept, and the
// counts are continued as powers of the resolution N:
//
//   triangles ~ N^p, evaluations ~ N^q   with p and q from the two counts: 2 where the surface is smooth
//   working memory ~ N                   the mesher holds single layers of blocks
//
// Detail finer than the coarse meshes' cells is not seen: a rough body ends with more triangles.
#pragma once

#include <algorithm>
#include <functional>

#include "synthesis/mesh/mesher.h"

namespace astrolith {

struct MeshPrediction {
  int resolution = 0;  // cells along the longest side, border included
  double triangles = 0.0;
  double evaluations = 0.0;    // of the field
  double working_bytes = 0.0;  // of the mesher; neither the output nor anything else is counted
};

class MeshGrowth {
 public:
  // Makes two small meshes. Throws what `mesh` throws.
  explicit MeshGrowth(const std::function<MeshStatistics(int resolution)>& mesh);

  MeshPrediction at(int resolution) const;
  // The resolution with the number of triangles nearest to the one asked for; the largest there is when even
  // that has fewer. Throws WorkError when the small meshes are empty.
  int resolution_for(double triangles) const;
  // Wall-clock seconds at the pace of the larger of the two, which is slower than a large mesh's: an upper
  // estimate.
  double seconds(const MeshPrediction& mesh) const {
    return fine_seconds_ * mesh.evaluations / std::max(fine_.evaluations, 1.0);
  }

 private:
  MeshPrediction coarse_, fine_;
  double fine_seconds_ = 0.0;
};

}  // namespace astrolith
