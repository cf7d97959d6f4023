// A closed surface through points that were measured: by lidar, or from photos.
#pragma once

#include <cstdint>
#include <string>

#include "geometry/triangle_mesh.h"
#include "numerics/progress.h"

namespace astrolith {

// A surface of which a larger share than this was seen by no point is a guess.
inline constexpr double kMostUnseen = 1.0 / 3.0;

// Lengths are those of the points.
struct PointSurface {
  TriangleMesh mesh;             // closed, wound outwards
  std::int64_t points = 0;       // that the surface rests on, those at one place counted once
  std::int64_t strays = 0;       // points far from all others, or far from a surface through their neighbours
  Vec3d stray;                   // the one of them that is farthest out
  double noise = 0.0;            // root mean square of the distances from the points to the surface
  double farthest_point = 0.0;   // greatest of these distances
  double farthest_ground = 0.0;  // greatest distance from a vertex of the surface to the nearest point
  double unseen_share = 0.0;     // of the ground that lies farther from points than they from one another
};

// Leaves out strays, smooths the points by as many neighbours as their noise asks for, estimates normals and
// takes the Poisson surface. Normals of the points only say which side is outwards. Throws InputError for
// fewer than 16 points, and where no closed surface goes through them.
PointSurface surface_through(const TriangleMesh& points, const std::string& name, const Progress& progress);

}  // namespace astrolith
