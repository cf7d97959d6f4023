// The places of an evened surface where it is most hollow or most bulging at some scale.
#pragma once

#include <cstdint>
#include <vector>

#include "descriptor/surface/evened_surface.h"
#include "descriptor/surface/smoothing_step.h"
#include "numerics/progress.h"

namespace astrolith {

// A place where a crater or a boulder may lie.
struct SurfaceBlob {
  std::uint32_t point = 0;  // of the evened surface
  Vec3d normal;             // unit, of the surface smoothed to the scale
  double scale = 0.0;       // s, the mesh's unit
};

enum class BlobSign { hollow, bump };

// Blobs of the scale space of a surface (Lindeberg, "Feature detection with automatic scale selection", IJCV
// 1998), which here is the smoothed surface X(s) itself:
//   D(s) = n(1.25 s) . (X(s) - X(1.25 s)) / s,
// negative in a hollow and without a unit. s runs from .8 edges to .3 radii of the sphere of equal area, a
// factor of about 1.25 apart. A blob is a point where |D - mean of D| is above .002, is the greatest within
// 1.5 s, and is at least .9 times its values at both neighbouring scales. A bowl of radius a answers most at
// s of about .3 a. Ordered by scale and then by point. Throws WorkError when progress asks to stop.
std::vector<SurfaceBlob> surface_blobs(const EvenedSurface& even, const SmoothingStep& step, BlobSign sign,
                                       const Progress& progress = {});

inline constexpr double kBlobPerRadius = 0.3;  // s over the radius of the bowl that answers most

}  // namespace astrolith
