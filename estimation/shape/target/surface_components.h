// The parts of a fit's surface beside those of its target: which the target has not, and which are missing.
//
// A closed piece of the fit's mesh belongs to the part of the target that is nearest to most of its vertices,
// walls of bodies and of cavities apart. Of the pieces that belong to one part the largest is that part, and
// the others are strays: islands in the air and cavities inside. A part without a piece was lost, or joined
// to another.
#pragma once

#include <cstdint>
#include <vector>

#include "estimation/shape/target/target_body.h"
#include "geometry/triangle_mesh.h"

namespace astrolith {

struct StrayPart {
  bool cavity;    // the fit's surface looks inwards there
  Vec3d center;   // of its box
  double radius;  // of the ball about center that holds its vertices
};

struct PartsComparison {
  std::vector<StrayPart> strays;
  std::int64_t missing = 0;

  std::int64_t wrong() const { return missing + static_cast<std::int64_t>(strays.size()); }
};

// `fit` is closed and oriented, in the target's frame.
PartsComparison compare_parts(const TargetBody& target, const TriangleMesh& fit);

}  // namespace astrolith
