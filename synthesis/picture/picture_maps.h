// What each pixel of a preview shows, as numbers: its distance from the camera and the surface's normal.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "numerics/progress.h"
#include "synthesis/picture/preview.h"

namespace astrolith {

// One ray a pixel, through its centre. Lengths and vectors are in the unit and frame of the mesh. The pixel
// in column x and row y, both from 0 at the top left, is on the picture plane at
//   q = corner + (x + 0.5) * pixel * right - (y + 0.5) * pixel * up
// with the corner, right and up of the pixel's view. The ray of an orthographic camera begins at q and runs
// along -from. The ray of a pinhole begins at `eye` and runs through q. It meets the surface at `depth`.
struct PictureMaps {
  static constexpr float kNoDepth = std::numeric_limits<float>::quiet_NaN();

  int width = 0, height = 0;
  std::vector<float> depth;       // (height x width) length of the ray; NaN where it meets nothing
  std::vector<float> normal;      // (height x width x 3) unit, towards the viewer; 0 where nothing is met
  std::vector<std::int8_t> view;  // (height x width) number of the view; -1 where a panel is left over
  std::vector<Vec3d> right, up, from;  // (#views) orthonormal; `from` points from the body to the viewer
  std::vector<Vec3d> corner;           // (#views) of the whole picture, in the picture plane
  std::vector<Vec3d> eye;              // (#views) the pinhole; NaN for an orthographic camera
  double pixel = 0.0;                  // side of a pixel in the picture plane

  bool shows_surface(std::size_t i) const { return depth[i] == depth[i]; }
  // The point of the surface that a pixel shows, by the equation above.
  Vec3d point(int x, int y) const;
};

// The maps of the picture that render_preview makes with these options. Normals are interpolated between
// vertices as the picture's are. Throws what render_preview throws.
PictureMaps render_maps(const TriangleMesh& mesh, const PreviewOptions& options,
                        const Progress& progress = {});

}  // namespace astrolith
