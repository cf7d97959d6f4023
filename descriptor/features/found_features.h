// Craters and boulders of a mesh, found one by one.
//
//   const FoundFeatures found = find_features(mesh, {});
//   for (const FoundFeature& f : found.features) ...   // the surest first
//
// Blobs of the surface's scale space (scale_space.h) say where one may lie; a bowl with a rim, or a dome, is
// fitted to each (crater_fit_internal.h). What the fit is like gives the confidence, and of several fits to
// one landform the surest stays.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "descriptor/features/scale_space.h"
#include "geometry/triangle_mesh.h"
#include "numerics/progress.h"

namespace astrolith {

struct FeatureOptions {
  // The points that the surface is evened to, which decide the edge: landforms of 6 edges and more are found.
  // 0: the mesh's own resolution, own_points(). 500 to 1,000,000 else.
  std::int64_t points = 0;
  bool boulders = false;  // large boulders too, for as long again
  double least_confidence = 0.1;
  std::uint64_t seed = 1;
};

struct FoundFeature {
  BlobSign sign = BlobSign::hollow;  // hollow: a crater; bump: a boulder
  Vec3d place;                       // the floor's or dome's middle, on the surface
  Vec3d center;                      // of the rim's circle, at the height of the ground around
  Vec3d normal;                      // unit, of the ground around
  double diameter = 0.0;             // of the rim, or of the dome; the mesh's unit
  double depth = 0.0;                // below the ground around; of a boulder its height above
  double rim_height = 0.0;           // above the ground around; 0 of a boulder
  // (depth + rim height) / (diameter / 5), at most 1. Fresh simple craters are a fifth as deep as wide (Pike
  // 1977), on small bodies somewhat less. 0 of a boulder.
  double freshness = 0.0;
  double completeness = 0.0;  // share of eight sectors whose rim stands above the ground outside
  double confidence = 0.0;    // the probability that it is one, by bodies whose craters are known
};

struct FoundFeatures {
  std::vector<FoundFeature> features;  // by falling confidence
  std::int64_t points = 0;             // that the surface was evened to
  double edge = 0.0;                   // their mean edge, the mesh's unit
  double area = 0.0;                   // of the mesh
};

// Works on open meshes too. The result depends on mesh, options and seed alone. Takes some seven processor
// seconds for 50,000 points, in proportion to them. Throws InputError "features: ..." for points out of range
// and a mesh without area or with fewer than 1,000 triangles, and WorkError when progress asks to stop.
FoundFeatures find_features(const TriangleMesh& mesh, const FeatureOptions& options,
                            const Progress& progress = {});

inline constexpr double kLeastFound = 6.0;        // edges
inline constexpr double kFreshDepth = 1.0 / 5.0;  // rim to floor over diameter

}  // namespace astrolith
