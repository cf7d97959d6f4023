// A piece of a surface as heights over a plane, and the plane that fits the ground best around each pixel.
#pragma once

#include <vector>

#include "geometry/surface/ground_plane.h"
#include "geometry/triangle_mesh.h"

namespace astrolith {

// Pixel (column i, row j), the top row first, lies at
//   origin + ((i + 1/2) - side / 2) pixel right + (side / 2 - (j + 1/2)) pixel ahead + height up.
struct HeightMap {
  int side = 0;                // pixels along each side
  double pixel = 0.0;          // length units
  Vec3d origin;                // in the mesh's frame
  Vec3d right, ahead, up;      // GroundAxes
  std::vector<float> heights;  // (side x side) length units times `scale`; NaN where there is no surface
};

// The map's square has sides of this length > 0 about the plane's origin. Where the surface lies over itself
// the highest height counts. Heights are multiplied by `scale`. side in [1, 16384].
HeightMap height_map(const TriangleMesh& mesh, const GroundPlane& plane, double length, int side,
                     double scale);

// All three are NaN where the square leaves the map or holds a pixel without height.
struct FootprintPlane {
  float along_right = 0.0f, along_ahead = 0.0f;  // rise of the plane, height units for a length unit
  float rms = 0.0f;                              // of the heights about the plane, height units
};

// (side x side) the plane of least squares through the (2 half + 1)^2 heights about each pixel. half >= 1.
std::vector<FootprintPlane> footprint_planes(const HeightMap& map, int half);

}  // namespace astrolith
