// A piece of a surface as heights over its mean plane.
#pragma once

#include <vector>

#include "geometry/surface/ground_axes.h"
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

// The plane goes through the centroid of the surface, across its mean normal. Where the surface lies over
// itself the highest height counts. Heights are multiplied by `scale`. side in [1, 16384], length > 0. Throws
// InputError for a mesh without area or whose normals cancel.
HeightMap height_map(const TriangleMesh& mesh, double length, int side, double scale);

// The map of a patch that was cut by a cube of these axes about the origin of the mesh, whose side is
// `length`: the map's square is the cube's. The plane goes through the height of the centroid.
HeightMap height_map(const TriangleMesh& mesh, const GroundAxes& axes, double length, int side, double scale);

}  // namespace astrolith
