#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/surface/embree_internal.h"
#include "numerics/errors.h"
#include "synthesis/picture/ray_scene.h"

namespace astrolith {
namespace {

void check(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) throw InputError("preview: the mesh has no triangles; nothing to draw");
  for (const Vec3d& p : mesh.vertices) {
    if (!std::isfinite(squared_norm(p))) throw InputError("preview: a vertex is not finite; repair the mesh");
  }
  for (const Triangle& t : mesh.triangles) {
    if (*std::max_element(t.begin(), t.end()) >= mesh.vertices.size()) {
      throw InputError("preview: a triangle names a vertex that does not exist; repair the mesh");
    }
  }
}

// The mesh in the unit ball about the centre of its box; the farthest vertex lies on the ball.
TriangleScene unit_scene(const TriangleMesh& mesh) {
  check(mesh);
  const Vec3d center = mesh.bounds().center();
  double radius = 0.0;
  for (const Vec3d& p : mesh.vertices) radius = std::max(radius, norm(p - center));
  return {mesh, center, radius > 0.0 ? 1.0 / radius : 1.0};
}

RTCRay make_ray(const Vec3f& origin, const Vec3f& direction) {
  RTCRay ray{};
  ray.org_x = origin.x;
  ray.org_y = origin.y;
  ray.org_z = origin.z;
  ray.dir_x = direction.x;
  ray.dir_y = direction.y;
  ray.dir_z = direction.z;
  ray.tfar = std::numeric_limits<float>::infinity();
  ray.mask = ~0u;
  return ray;
}

}  // namespace

RayScene::RayScene(const TriangleMesh& mesh) : scene_(unit_scene(mesh)) {}

RayHit RayScene::first_hit(const Vec3f& origin, const Vec3f& direction) const {
  RTCRayHit query{};
  query.ray = make_ray(origin, direction);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  intersect_ray(scene_.handle(), query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  const Vec3f normal = normalized(Vec3f{query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z});
  return {true, query.ray.tfar, query.hit.primID, query.hit.u, query.hit.v, normal};
}

bool RayScene::occluded(const Vec3f& origin, const Vec3f& direction) const {
  RTCRay ray = make_ray(origin, direction);
  occlude_ray(scene_.handle(), ray);
  return ray.tfar < 0.0f;
}

void RayScene::visit_near(const Vec3f& point, float radius,
                          const std::function<void(std::uint32_t)>& visit) const {
  RTCPointQuery query{point.x, point.y, point.z, 0, radius};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  const auto call = [](RTCPointQueryFunctionArguments* arguments) {
    (*static_cast<const std::function<void(std::uint32_t)>*>(arguments->userPtr))(arguments->primID);
    return false;  // the radius stays
  };
  rtcPointQuery(scene_.handle(), &query, &context, call, const_cast<void*>(static_cast<const void*>(&visit)));
}

}  // namespace astrolith
