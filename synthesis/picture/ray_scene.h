// A mesh that answers two questions about rays, by Embree 3. The mesh is moved and scaled into the unit ball,
// where single precision is enough for any body.
#pragma once

#include <cstdint>
#include <functional>

#include "geometry/surface/triangle_scene.h"
#include "geometry/triangle_mesh.h"

namespace astrolith {

struct RayHit {
  bool found = false;
  float distance = 0.0f;
  std::uint32_t triangle = 0;
  float u = 0.0f, v = 0.0f;  // weights of the triangle's second and third corner
  Vec3f normal;              // normal of the triangle, unit length
};

class RayScene {
 public:
  // Throws InputError for a mesh without triangles, with indices out of range or with positions that are not
  // finite, and WorkError when Embree does not start or runs out of memory.
  explicit RayScene(const TriangleMesh& mesh);

  // Origins and directions are in the unit ball; directions have unit length. Queries may run in parallel.
  RayHit first_hit(const Vec3f& origin, const Vec3f& direction) const;
  bool occluded(const Vec3f& origin, const Vec3f& direction) const;
  // Calls visit(triangle) for every triangle whose box comes within `radius` of a point of the unit ball.
  void visit_near(const Vec3f& point, float radius, const std::function<void(std::uint32_t)>& visit) const;

  // Maps a position of the mesh into the unit ball.
  Vec3d to_unit(const Vec3d& p) const { return scene_.to_scene(p); }
  // Maps a position of the unit ball back to the mesh.
  Vec3d from_unit(const Vec3d& p) const { return scene_.from_scene(p); }
  // Lengths of the unit ball per mesh length.
  double scale() const { return scene_.scale(); }

 private:
  TriangleScene scene_;
};

}  // namespace astrolith
