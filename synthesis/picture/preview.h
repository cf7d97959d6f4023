// Renders a mesh under sunlight: rays of orthographic cameras or pinholes (Embree), the reflectance of small
// bodies, soft shadows and ambient light. The pixels are the same on every run and for any number of threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "numerics/progress.h"
#include "synthesis/picture/camera.h"
#include "synthesis/picture/figure.h"
#include "synthesis/picture/image_file.h"
#include "synthesis/picture/picture_marks.h"
#include "synthesis/picture/reflectance.h"

namespace astrolith {

inline constexpr int kLeastPictureSide = 16, kMostPictureSide = 16384;  // pixels

// The direction towards the sun, of any length above 0: in the axes of each view (right, up, to the viewer),
// or in those of the mesh.
struct Sunlight {
  Vec3d direction{-0.75, 0.45, 0.55};
  bool in_mesh_axes = false;
};

// The sun of a view by its phase angle, between the directions to the sun and to the viewer, 0 .. 180
// degrees, and by its azimuth in the picture, degrees counter-clockwise from up.
Sunlight sun_at_phase(double phase_degrees, double azimuth_degrees);

// What maps show at a place of the mesh, instead of its normals and colours.
struct MappedPlace {
  Vec3<float> normal;                                // unit length, in the axes of the mesh
  std::optional<Vec3<float>> albedo = std::nullopt;  // linear light; absent: that of the mesh
  float open = 1.0f;                                 // share of the sky that is open: of the ambient light
};
// The place in a triangle has the weights u and v of the second and the third corner. Called by many threads.
using SurfaceMaps = std::function<MappedPlace(std::uint32_t triangle, float u, float v)>;

struct PreviewOptions {
  int width = 1280, height = 960;  // kLeastPictureSide .. kMostPictureSide
  PictureMarks marks;              // none, unless asked for; the views take the rest of the height
  // Samples along a pixel's side where neighbouring pixels differ, 1 .. 16. Even ground takes one sample.
  int oversampling = 3;
  // Each view gets one panel, in rows. All orthographic panels have one scale, chosen such that every view
  // fits.
  std::vector<Camera> views = standard_views();
  Sunlight sun;
  double sun_radius_degrees = 1.5;  // angular radius of the sun's disk; 0 gives hard shadows
  // Ratio of the light from everywhere, brightest from behind the viewer, to sunlight. 0 leaves shadows
  // black, as in space.
  double ambient = 0.1;
  Reflectance reflectance;  // times the albedo
  // The linear-light albedo (sRGB components in [0, 1], colormap.h) at each vertex, or empty for neutral
  // grey.
  std::vector<Vec3<float>> vertex_colors;
  // Whether colours stand for numbers: they are nearly those of the bar then, with a faint relief and without
  // shadows.
  bool colors_are_values = false;
  SurfaceMaps maps;  // none: the mesh as it is
  // Whether the picture is also kept as I/F: the law itself in place of what is pictured of it, times the
  // albedo, without ambient light.
  bool keep_radiance = false;
  Vec3<float> background{0.0030f, 0.0034f, 0.0048f};  // linear-light sRGB
  bool transparent = false;                           // no background
  std::uint64_t seed = 1;                             // decides where samples lie within pixels
};

struct RenderedPicture {
  RgbaImage16 image;            // without its marks
  std::vector<float> radiance;  // (height x width x 3) I/F, 0 beside the mesh; empty where it is not kept
  std::vector<std::size_t> empty_views;  // those whose pixels, seen in their middles, all miss the mesh
  Figure marks;                          // a point is a pixel

  // The picture with its marks.
  RgbaImage16 marked() &&;
};

// Writes a page of vectors, .svg or .pdf, that has the picture in it: two of its pixels are a point of 1/72
// inch. Throws as Figure does.
void write_page(const RenderedPicture& picture, const std::filesystem::path& file);

// The linear light of the mesh's own colours, for PreviewOptions::vertex_colors; empty where it has none.
std::vector<Vec3<float>> linear_colors(const TriangleMesh& mesh);

// Shading is smooth: it uses mesh.normals where given, and otherwise normals averaged over triangles. Throws
// InputError for a mesh without triangles, with indices out of range or with positions that are not finite,
// for options out of range and for a camera inside the mesh. Throws WorkError when progress asks to stop.
RenderedPicture render_picture(const TriangleMesh& mesh, const PreviewOptions& options = {},
                               const Progress& progress = {});

// The places of the pinholes among the views, in lengths of the mesh. Throws InputError for a mesh and
// options that render_picture refuses, but for a camera inside the mesh.
std::vector<Vec3d> pinhole_places(const TriangleMesh& mesh, const PreviewOptions& options);

// Throws the InputError of a camera that stands inside the body, with what to do.
[[noreturn]] void fail_inside();

// Throws InputError where render_picture would refuse a camera inside the mesh.
void require_cameras_outside(const TriangleMesh& mesh, const PreviewOptions& options);

// The picture in 8 bits, without its transparency.
RgbImage render_preview(const TriangleMesh& mesh, const PreviewOptions& options = {},
                        const Progress& progress = {});

}  // namespace astrolith
