// Bodies that stay in memory with the trees of their triangles, for cameras and lidars that ask again and
// again: pictures in I/F with what is known of each pixel, and ranges. Answers are the same on every run and
// for any number of threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "numerics/jacobi_rotation.h"
#include "numerics/progress.h"
#include "synthesis/picture/reflectance.h"
#include "synthesis/picture/scene_camera.h"

namespace astrolith {

// The point p of a body stands at rotation * p + position in the scene.
struct BodyPose {
  Matrix3 rotation = kIdentity3;
  Vec3d position;
};

// The camera of a scene in the axes of a body.
SceneCamera in_axes_of_body(const SceneCamera& camera, const BodyPose& pose);

struct SceneImageOptions {
  Reflectance reflectance;
  // Samples of I/F along the side of a pixel, 1 .. 16; their mean is taken. All else is of the pixel's
  // middle.
  int oversampling = 1;
  // Whether normals are interpolated from those of the vertices. Otherwise they are those of the facets.
  bool smooth = true;
};

// One number or vector for each pixel, row after row from the top. Where the pixel's middle shows no body,
// numbers are NaN, and facet and body are -1.
struct SceneImage {
  std::vector<float> radiance;      // I/F; 0 in shadow and where a pixel shows no body
  std::vector<double> depth;        // along the boresight, in lengths of the scene
  std::vector<Vec3f> normal;        // in the axes of the scene, towards the camera's side
  std::vector<std::int32_t> facet;  // a triangle of the body
  std::vector<std::int16_t> body;
  std::vector<float> incidence, emission, phase;  // degrees
};

struct RangeOptions {
  double noise = 0;        // standard deviation of the error of a range, 0 .. 1e18 lengths of the scene
  double beam = 0;         // the angle across a beam, degrees, 0 .. 10: ranges are means over 19 rays
  std::uint64_t seed = 1;  // of the noise
};

// What each ray meets first. Where it meets nothing, numbers are NaN, and facet and body are -1.
struct SceneRanges {
  std::vector<double> range;     // from the origin, in lengths of the scene
  std::vector<float> incidence;  // between ray and facet, degrees; above 90 where a facet is met from behind
  std::vector<std::int32_t> facet;  // of a beam: that of the ray nearest to its middle
  std::vector<std::int16_t> body;
};

// A copy shares the bodies and has poses of its own. Calls of const functions may run in parallel.
class Scene {
 public:
  // Adds a body in the pose of its own axes and returns its number. `albedo` has the normal albedo of each
  // vertex, at least 0, or nothing: then I/F is that of the law of reflection alone. The law is scaled to
  // have the albedo where sun and viewer are above the ground. Throws InputError for a mesh that RayScene
  // refuses and for another number of albedos.
  std::size_t add(const TriangleMesh& mesh, const std::vector<float>& albedo = {});
  // Gives a body the mesh and the albedo of a body of another scene, and keeps its pose; throws as place()
  // does.
  void replace(std::size_t body, const Scene& other, std::size_t of_other);
  // Throws InputError for a body that is not there and for a pose that is none.
  void place(std::size_t body, const BodyPose& pose);
  const BodyPose& pose(std::size_t body) const { return bodies_.at(body).pose; }
  std::size_t size() const { return bodies_.size(); }

  // The sun is a point far away, in a direction of any length above 0. Bodies shade themselves and each
  // other. Throws InputError for a sun without direction, options out of range and a camera inside a body,
  // and WorkError when progress asks to stop.
  SceneImage image(const SceneCamera& camera, const Vec3d& sun, const SceneImageOptions& options = {},
                   const Progress& progress = {}) const;

  // There is one origin for each direction, or one for all. Directions have any length above 0. The triangle
  // that single precision finds is intersected again in double precision: ranges are those to its plane but
  // for 1e-15 of the size of its body. Throws InputError for another number of origins, for a direction 0 0 0
  // and for options out of range, and WorkError when progress asks to stop.
  SceneRanges ranges(std::span<const Vec3d> origins, std::span<const Vec3d> directions,
                     const RangeOptions& options = {}, const Progress& progress = {}) const;

 private:
  friend class ScenePixels;
  struct Body;
  struct Placed {
    std::shared_ptr<const Body> body;
    BodyPose pose;
  };
  struct Hit;

  Placed& placed(std::size_t body);
  Hit first_hit(const Vec3d& origin, const Vec3d& direction) const;
  bool sees_sun(const Hit& hit, const Vec3d& point, const Vec3d& lift, const Vec3d& sun) const;
  void require_outside(const SceneCamera& camera) const;
  void measure(std::size_t ray, const Vec3d& origin, const Vec3d& towards, const RangeOptions& options,
               SceneRanges& made) const;

  std::vector<Placed> bodies_;
};

}  // namespace astrolith
