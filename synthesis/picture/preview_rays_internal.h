// The rays of a picture: which view a pixel shows, where its ray begins, and the normals of what it hits.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "synthesis/picture/figure.h"
#include "synthesis/picture/preview.h"
#include "synthesis/picture/ray_scene.h"

namespace astrolith {

// Throws InputError for options out of range.
void check_preview_options(const PreviewOptions& options, const TriangleMesh& mesh);

// A ray in the unit ball of a scene.
struct PictureRay {
  Vec3f origin, direction;  // unit direction
  // From where lengths along the ray are counted to the origin: the ray of a far camera begins near the ball.
  double before = 0.0;
  float end = std::numeric_limits<float>::infinity();  // where the ray ends: that of a map at the origin
};

// A camera in the unit ball of a scene.
struct ViewCamera {
  Vec3d right, up, from;  // orthonormal
  // The pinhole, or the middle of the plane on which the rays of an orthographic camera begin.
  Vec3d eye;
  bool is_pinhole = false;
  MapProjection map = MapProjection::kNone;
  // The half sides of the mesh's box in the picture plane of an orthographic camera.
  double half_width = 0, half_height = 0;
  // The side of a pixel: a length, or for a pinhole the tangent of an angle.
  double pixel = 0;
};

class PreviewRays {
 public:
  // Throws InputError for a camera along its own up direction.
  PreviewRays(const TriangleMesh& mesh, const PreviewOptions& options, const RayScene& scene);

  // Throws InputError for a pinhole inside the mesh.
  void require_outside(const RayScene& scene) const;

  // The view whose panel has a place of the picture, in pixels from its top left corner. Panels that are left
  // over have none.
  std::optional<std::size_t> view_at(double px, double py) const;
  PictureRay ray(std::size_t view, double px, double py) const;
  // Where a view shows a point of the unit ball, in pixels from the picture's top left corner; none where its
  // panel does not reach or another part of the mesh is before the point.
  std::optional<std::pair<double, double>> seen_at(std::size_t view, const Vec3d& point,
                                                   const RayScene& scene) const;
  const ViewCamera& camera(std::size_t view) const { return cameras_[view]; }
  // Where a map shows a direction from the origin, in the axes of the mesh.
  std::optional<std::pair<double, double>> on_map(std::size_t view, const Vec3d& direction) const;
  // Pixels of a map from its middle to its upper edge.
  double map_half() const;
  // The side of a pixel of the orthographic views in the unit ball, and of a plane before each pinhole.
  double pixel() const { return pixel_; }
  // The point of that plane at a place of the picture.
  Vec3d on_plane(std::size_t view, double px, double py) const;

  double panel_width() const { return width_ / columns_; }
  double panel_height() const { return height_ / rows_; }
  // The lower left corner of a view's panel, in pixels from the top left corner of the picture.
  std::pair<double, double> lower_left(std::size_t view) const {
    const int column = static_cast<int>(view) % columns_, row = static_cast<int>(view) / columns_;
    return {column * panel_width(), (row + 1) * panel_height()};
  }

 private:
  // The direction from the origin that a map shows at a place of the picture.
  std::optional<Vec3d> map_direction_at(std::size_t view, double px, double py) const;
  // A place of the picture from the middle of its view, in pixels.
  Vec3d across(std::size_t view, double px, double py) const;

  double width_, height_;
  int columns_, rows_;
  std::vector<ViewCamera> cameras_;  // one a view
  double pixel_;
  Vec3d origin_;  // of the mesh's axes in the unit ball, for maps
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

// The marks of a picture (picture_marks.h), on a page whose points are its pixels.
Figure draw_marks(const RgbaImage16& image, const PreviewOptions& options, const PreviewRays& rays,
                  const RayScene& scene);

}  // namespace astrolith
