// Renders a mesh under sunlight: orthographic rays (Embree), the reflectance of small bodies, soft shadows
// and a little fill light. The pixels are the same on every run and for any number of threads.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "numerics/progress.h"
#include "synthesis/picture/image_file.h"

namespace astrolith {

// The viewpoint: the direction from the body to the camera, and the direction that is up in the picture.
struct PreviewView {
  Vec3d from;
  Vec3d up;
};

// The views from +x, from +y, from above the +z pole, and obliquely, as readers of shape models expect them.
std::vector<PreviewView> standard_views();

// The standard views; of a patch of ground, which is open and faces one way, the view from above its mean
// plane and one obliquely.
std::vector<PreviewView> usual_views(const TriangleMesh& mesh);

// The view from a direction of any length above 0. North is up, or +y where the view is along the pole.
PreviewView view_from(const Vec3d& direction);

inline constexpr int kLeastPictureSide = 16, kMostPictureSide = 16384;  // pixels

struct PreviewOptions {
  int width = 1280, height = 960;  // kLeastPictureSide .. kMostPictureSide
  int oversampling = 3;            // rays along a pixel's side, 1 .. 16
  // Each view gets one tile, in rows. All tiles have one scale, chosen such that every view fits.
  std::vector<PreviewView> views = standard_views();
  // The direction towards the sun in the axes of each view (right, up, to the viewer), of any length.
  Vec3d sun{-0.75, 0.45, 0.55};
  double sun_radius_degrees = 1.5;  // angular radius of the sun's disk; 0 gives hard shadows
  double fill_light = 0.035;        // ratio of sky light to sunlight; 0 leaves shadows black, as in space
  // The linear-light albedo (sRGB components in [0, 1], colormap.h) at each vertex, or empty for neutral
  // grey.
  std::vector<Vec3<float>> vertex_colors;
  std::uint64_t seed = 1;  // decides where rays lie within pixels
};

// Shading is smooth: it uses mesh.normals where given, and otherwise normals averaged over triangles. Throws
// InputError for a mesh without triangles, with indices out of range or with positions that are not finite,
// and for options out of range. Throws WorkError when progress asks to stop.
RgbImage render_preview(const TriangleMesh& mesh, const PreviewOptions& options = {},
                        const Progress& progress = {});

}  // namespace astrolith
