// Cameras that look at a mesh, and the words that describe one.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "synthesis/picture/map_projection.h"

namespace astrolith {

// A camera looks at `target`. It is orthographic, or a pinhole where field_of_view is above 0. The pinhole
// stands at target + distance * from / |from| and sees the point p at
//   column = width / 2 + f * dot(p - eye, right) / depth,    row = height / 2 - f * dot(p - eye, up) / depth,
//   depth = -dot(p - eye, from / |from|),    f = (width / 2) / tan(field_of_view / 2),
// in pixels from the top left corner of its view, which is width x height pixels.
struct Camera {
  Vec3d from{1, 0, 0};  // from the target to the camera, in the axes of the mesh; any length above 0
  Vec3d up{0, 0, 1};    // what is up in the picture, in the axes of the mesh; not along `from`
  // Degrees by which the camera turns counter-clockwise about its line of sight, seen by the viewer. The body
  // turns clockwise in the picture.
  double roll = 0.0;
  double field_of_view = 0.0;  // degrees across the width of the view, below 175; 0: orthographic
  // From the target to a pinhole, in lengths of the mesh, or, where `in_radii` is set, in radii of the sphere
  // about the centre of the mesh's box that holds the mesh. 0: as far as the whole mesh needs.
  double distance = 0.0;
  bool in_radii = false;
  std::optional<Vec3d> target = std::nullopt;  // in lengths of the mesh; none: the centre of the mesh's box
  // A map in place of a view: what is outermost in each direction from the origin of the mesh's axes, with
  // `from` in its middle. Its light comes from the upper left everywhere, and casts no shadows.
  MapProjection map = MapProjection::kNone;
};

// The camera that looks from a direction of any length above 0. North is up, or +y where it looks along the
// pole.
Camera view_from(const Vec3d& direction);

// The orthographic cameras from +x, from +y, from above the +z pole, and obliquely, as readers of shape
// models expect them.
std::vector<Camera> standard_views();

// One map of all longitudes, or two of the hemispheres about the longitudes 0 and 180 degrees.
std::vector<Camera> map_views(MapProjection projection);

// The standard views; of a patch of ground, which is open and faces one way, the view from above its mean
// plane and one obliquely.
std::vector<Camera> usual_views(const TriangleMesh& mesh);

// Reads a camera from words, each followed by its numbers:
//   lat DEGREES, lon DEGREES    where the camera stands over the mesh, north and east of +x about +z
//   from X Y Z                  the same as a direction
//   at X Y Z                    the place of a pinhole, in lengths of the mesh; needs target or means 0 0 0
//   fov DEGREES                 a pinhole with this field of view; orthographic without
//   distance L, radii R         from the target, in lengths or in radii of the mesh; needs fov
//   target X Y Z, up X Y Z, roll DEGREES
// Throws InputError, one line that begins with `name`.
Camera parse_camera(const std::string& name, const std::string& words);

}  // namespace astrolith
