// The rays of a picture: which view a pixel shows, where its ray begins, and the normals of what it hits.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "synthesis/picture/preview.h"
#include "synthesis/picture/ray_scene_internal.h"

namespace astrolith {

// Throws InputError for options out of range.
void check_preview_options(const PreviewOptions& options, const TriangleMesh& mesh);

// An orthographic camera in the unit ball of a scene. Its rays begin on the plane at kCameraDistance from the
// ball's centre and run along -to_viewer.
struct PreviewCamera {
  Vec3d right, up, from;  // orthonormal
  Vec3f to_viewer;        // `from` in single precision
  // The centre and the half sides of the body's box in the picture plane.
  double center_x = 0, center_y = 0, half_width = 0, half_height = 0;
};
inline constexpr double kCameraDistance = 2.0;

class PreviewRays {
 public:
  // Throws InputError for a view along its own up direction.
  PreviewRays(const TriangleMesh& mesh, const PreviewOptions& options, const RayScene& scene);

  // The view whose tile has a place of the picture, in pixels from its top left corner. Tiles that are left
  // over have none.
  std::optional<std::size_t> view_at(double px, double py) const;
  // Where the ray of that place begins.
  Vec3d exact_origin(std::size_t view, double px, double py) const;
  Vec3f origin(std::size_t view, double px, double py) const { return to_float(exact_origin(view, px, py)); }
  const PreviewCamera& camera(std::size_t view) const { return cameras_[view]; }
  // The side of a pixel in the unit ball.
  double pixel() const { return pixel_; }

 private:
  double tile_width() const { return width_ / columns_; }
  double tile_height() const { return height_ / rows_; }

  double width_, height_;
  int columns_, rows_;
  std::vector<PreviewCamera> cameras_;  // one a view
  double pixel_ = 1e-9;
};

// Interpolates a value at the corners of the triangle that was hit.
template <typename T>
Vec3f interpolate_corners(const TriangleMesh& mesh, const std::vector<Vec3<T>>& corners, const RayHit& hit) {
  const Triangle& t = mesh.triangles[hit.triangle];
  const T u = hit.u, v = hit.v;
  const Vec3<T> value = (T(1) - u - v) * corners[t[0]] + u * corners[t[1]] + v * corners[t[2]];
  return {static_cast<float>(value.x), static_cast<float>(value.y), static_cast<float>(value.z)};
}

struct SeenNormals {
  Vec3f face, smooth;  // unit vectors towards the viewer's side: the triangle's, and the interpolated one
};
// In open or inverted meshes a surface may be seen from behind. Its normals are turned then.
SeenNormals seen_normals(const TriangleMesh& mesh, const std::vector<Vec3d>& vertex_normals,
                         const RayHit& hit, const Vec3f& to_viewer);

}  // namespace astrolith
