// A picture of a mesh under sunlight: orthographic rays (Embree), the reflectance of small bodies, soft
// shadows and a little fill light, the same pixels on every run and for any thread count.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "numerics/progress.h"
#include "synthesis/picture/image_file.h"

namespace astrolith {

// Where a view looks from: a direction from the body to the camera, and which way is up in the picture.
struct PreviewView {
  Vec3d from;
  Vec3d up;
};

// From +x, from +y, from above the +z pole, and obliquely: what a reader of shape models expects.
std::vector<PreviewView> standard_views();

struct PreviewOptions {
  int width = 1280;      // pixels, 16 .. 16384
  int height = 960;      // pixels, 16 .. 16384
  int oversampling = 3;  // rays along a pixel's side, 1 .. 16
  // One tile each, in rows; all tiles have one scale, chosen so that every view fits.
  std::vector<PreviewView> views = standard_views();
  // Towards the sun, in each view's own axes (right, up, to the viewer); any length.
  Vec3d sun{-0.75, 0.45, 0.55};
  double sun_radius_degrees = 1.5;  // half the angle of the sun's disk: 0 = hard shadows
  double fill_light = 0.035;        // sky light over sunlight; 0 leaves shadows black, as in space
  // Linear-light albedo (sRGB components in [0, 1]) at each vertex, or empty for neutral grey; see
  // colormap.h.
  std::vector<Vec3<float>> vertex_colors;
  std::uint64_t seed = 1;  // of the positions of rays within pixels
};

// Smooth shading uses mesh.normals where given, else normals averaged over triangles. Throws InputError for a
// mesh without triangles, with indices out of range or positions that are not finite, and for options out of
// range; WorkError when progress asks to stop.
RgbImage render_preview(const TriangleMesh& mesh, const PreviewOptions& options = {},
                        const Progress& progress = {});

}  // namespace astrolith
