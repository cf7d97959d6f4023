// The light of a whole body, as a telescope that does not resolve it sees it: by phase angle and over a
// rotation. With A the area of a facet, m its cosine of emission and r its reflectance as I/F,
//   S = sum over the facets that sun and viewer see of A m r,
// the area of a white disk that would be as bright. At 1 AU from the sun and the viewer the magnitude is
//   V = V_sun - 2.5 log10(S / (pi AU^2)),   V_sun = -26.76.
// A sphere of radius R at opposition has S = p pi R^2, with p its geometric albedo.
#pragma once

#include <vector>

#include "geometry/triangle_mesh.h"
#include "numerics/progress.h"
#include "synthesis/picture/reflectance.h"

namespace astrolith {

// Hapke's and ROLO's laws are I/F by themselves; the others are times the normal albedo, and at all phase
// angles alike.
struct DiskOptions {
  Reflectance reflectance;
  double normal_albedo = 0.1;  // (0, 1]
};

// S for directions of any length above 0 to the sun and to the viewer, squared length units. Facets are seen
// from their centroids. Throws what RayScene throws.
double disk_light(const TriangleMesh& mesh, const DiskOptions& options, const Vec3d& sun,
                  const Vec3d& viewer);

// The magnitude at 1 AU from the sun and the viewer for S in square metres; infinite for 0.
double reduced_magnitude(double square_metres);

// Viewer and sun in the equator of a body that turns about +z, the sun `phase` degrees west of the viewer.
struct PhasePoint {
  double phase = 0.0;  // degrees
  double light = 0.0;  // mean S over a rotation, squared length units
  double least = 0.0, greatest = 0.0;
};
inline constexpr int kTurnsOfRotation = 36;

// S over a rotation at each phase angle, in (0 .. 179) degrees. Throws WorkError when progress asks to stop.
std::vector<PhasePoint> phase_curve(const TriangleMesh& mesh, const DiskOptions& options,
                                    const std::vector<double>& phases, const Progress& progress = {});

// S at `steps` equal turns from longitude 0 below the viewer on, at one phase angle. The body turns
// eastwards.
std::vector<double> light_curve(const TriangleMesh& mesh, const DiskOptions& options, double phase, int steps,
                                const Progress& progress = {});

}  // namespace astrolith
