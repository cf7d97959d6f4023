// The triangles of a mesh in an Embree 3 scene: one owner of Embree's device, scene and triangle geometry for
// everything that asks Embree about a mesh (nearest points in surface_tree.h, rays in synthesis/picture/).
#pragma once

#include <memory>

#include "geometry/triangle_mesh.h"

struct RTCDeviceTy;
struct RTCSceneTy;

namespace astrolith {

// Embree works in single precision. The scene therefore holds scale * (p - center) of every vertex p, and its
// user chooses center and scale such that the mesh lies in the unit ball about 0. Primitive i of the scene is
// triangle i of the mesh. Queries through handle() may run in parallel.
class TriangleScene {
 public:
  // The mesh must have triangles, indices in range and finite vertices. It is copied. Throws WorkError when
  // Embree does not start or runs out of memory.
  TriangleScene(const TriangleMesh& mesh, const Vec3d& center, double scale);

  Vec3d to_scene(const Vec3d& p) const { return scale_ * (p - center_); }
  Vec3d from_scene(const Vec3d& p) const { return (1.0 / scale_) * p + center_; }
  // Scene lengths per mesh length.
  double scale() const { return scale_; }
  // An RTCScene of Embree, which lives as long as this object.
  RTCSceneTy* handle() const { return scene_.get(); }

 private:
  struct Release {
    void operator()(RTCDeviceTy* device) const;
    void operator()(RTCSceneTy* scene) const;
  };

  void add_triangles(const TriangleMesh& mesh);
  void check() const;

  Vec3d center_;
  double scale_;
  std::unique_ptr<RTCDeviceTy, Release> device_;
  std::unique_ptr<RTCSceneTy, Release> scene_;
};

}  // namespace astrolith
