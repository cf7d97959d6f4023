// A mesh that rays can be shot at: Embree 3 behind two questions. The mesh is moved and scaled into the unit
// ball, where single precision serves any body.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "geometry/triangle_mesh.h"

struct RTCDeviceTy;
struct RTCSceneTy;

namespace astrolith {

struct RayHit {
  bool found = false;
  float distance = 0.0f;
  std::uint32_t triangle = 0;
  float u = 0.0f, v = 0.0f;  // weights of the triangle's second and third corner
  Vec3f normal;              // of the triangle, unit length
};

class RayScene {
 public:
  // Throws InputError for a mesh without triangles, with indices out of range or positions that are not
  // finite.
  explicit RayScene(const TriangleMesh& mesh);

  // Directions have unit length; const queries may run in parallel.
  RayHit first_hit(const Vec3f& origin, const Vec3f& direction) const;
  bool occluded(const Vec3f& origin, const Vec3f& direction) const;

  // Into the unit ball: (p - center) * scale.
  Vec3d to_unit(const Vec3d& p) const { return (p - center_) * scale_; }

 private:
  struct Release {
    void operator()(RTCDeviceTy* device) const;
    void operator()(RTCSceneTy* scene) const;
  };

  void build(const TriangleMesh& mesh);

  Vec3d center_;
  double scale_ = 1.0;
  std::unique_ptr<RTCDeviceTy, Release> device_;
  std::unique_ptr<RTCSceneTy, Release> scene_;
};

}  // namespace astrolith
