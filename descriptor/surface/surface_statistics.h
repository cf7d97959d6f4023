// What a surface is like from place to place: how rough it is at each scale, whether bumps or pits stand out,
// how steep it is, and how far regions differ.
//
//   SurfaceStatisticsOptions options;
//   options.points = common_points(measured, fitted);
//   const SurfaceStatistics a = surface_statistics(measured, options);
//   const SurfaceStatistics b = surface_statistics(fitted, options);
//   const RealismVerdict verdict = judge_realism(a, b, {});   // descriptor/surface/realism.h
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "descriptor/surface/height_bands.h"
#include "descriptor/surface/regions.h"
#include "descriptor/surface/surface_quantity.h"
#include "geometry/triangle_mesh.h"
#include "numerics/progress.h"

namespace astrolith {

struct LocalStatistic {
  SurfaceQuantity quantity;
  double radius = 0.0;         // edges; 0 for what has none
  std::vector<double> values;  // (#places)
};

// The rms difference of height between a place and the points at a distance, over the quadric of the largest
// radius that 40 regions hold.
struct RoughnessAtLag {
  double lag = 0.0;         // edges
  double difference = 0.0;  // the mesh's unit
};

struct SurfaceStatisticsOptions {
  // The points that the surface is evened to; they decide the edge, in which the radii count: 3, 6, 12, 24.
  // 0: the mesh's own resolution, own_points(). 500 to 60,000 else.
  std::int64_t points = 0;
  std::int64_t places = 3000;   // of the points, at random; 100 to 20,000
  double rotation_hours = 0.0;  // about +z, for slopes; 0 = at rest
  double density = 2000.0;      // kg / m^3, of a body that turns
  std::uint64_t seed = 1;
};

struct SurfaceStatistics {
  std::int64_t points = 0;   // that the surface was evened to
  double edge = 0.0;         // mean edge of the evened surface, the mesh's unit
  double body_radius = 0.0;  // edges; of the sphere of equal area
  std::vector<Vec3d> places;
  std::vector<LocalStatistic> local;  // of each radius those that have one; then the others
  std::vector<RoughnessAtLag> lags;
  HeightBands heights;
  Regions regions;             // of the places, with the covariance of roughness within the first radius
  std::int64_t undefined = 0;  // places left out, around which the points determine no quadric
  std::vector<std::string> remarks;  // what could not be measured, for people

  const LocalStatistic* find(SurfaceQuantity quantity, double radius) const;
};

// The vertices of a closed mesh of as many facets, within 500 to 60,000.
std::int64_t own_points(const TriangleMesh& mesh);
// The points at which two meshes are sampled alike: those of the coarser one.
std::int64_t common_points(const TriangleMesh& a, const TriangleMesh& b);

// Whether 40 regions of a body are no smaller than the discs of a radius, so that they count as independent;
// both in edges.
bool regions_hold(double radius, double body_radius);
// Whether 100 discs of a radius find room on a body, so that two surfaces of one kind seldom differ by more
// than .13.
bool body_holds_discs(double radius, double body_radius);

// Measures a mesh. Radii above .6 of body_radius are left out with a remark. Slopes need a closed mesh. The
// result depends on mesh, options and seed alone. Memory is in proportion to the points, and time too: about
// two processor seconds for 25,000. Throws InputError "surface statistics: ..." for options out of range, a
// mesh without area, or one with fewer than 1,000 triangles, and WorkError when progress asks to stop.
SurfaceStatistics surface_statistics(const TriangleMesh& mesh, const SurfaceStatisticsOptions& options,
                                     const Progress& progress = {});

}  // namespace astrolith
