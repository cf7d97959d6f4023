#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "numerics/errors.h"
#include "synthesis/picture/ray_scene_internal.h"

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

void RayScene::Release::operator()(RTCDeviceTy* device) const { rtcReleaseDevice(device); }
void RayScene::Release::operator()(RTCSceneTy* scene) const { rtcReleaseScene(scene); }

RayScene::RayScene(const TriangleMesh& mesh) {
  check(mesh);
  const Box box = mesh.bounds();
  center_ = box.center();
  double radius = 0.0;
  for (const Vec3d& p : mesh.vertices) radius = std::max(radius, norm(p - center_));
  scale_ = radius > 0.0 ? 1.0 / radius : 1.0;
  build(mesh);
}

void RayScene::build(const TriangleMesh& mesh) {
  device_.reset(rtcNewDevice(nullptr));
  if (!device_) throw WorkError("preview: the ray-tracing library cannot start on this machine");
  scene_.reset(rtcNewScene(device_.get()));
  rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
  RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* positions = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.vertices.size()));
  auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(Triangle), mesh.triangles.size()));
  if (positions != nullptr && indices != nullptr) {
    for (const Vec3d& vertex : mesh.vertices) {
      const Vec3d p = to_unit(vertex);
      for (const double coordinate : {p.x, p.y, p.z}) *positions++ = static_cast<float>(coordinate);
    }
    for (const Triangle& t : mesh.triangles) indices = std::copy(t.begin(), t.end(), indices);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_.get(), geometry);
  }
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene_.get());
  if (rtcGetDeviceError(device_.get()) != RTC_ERROR_NONE) {
    throw WorkError("preview: building the tree of the surface failed; is there enough memory?");
  }
}

RayHit RayScene::first_hit(const Vec3f& origin, const Vec3f& direction) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit query{};
  query.ray = make_ray(origin, direction);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene_.get(), &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  const Vec3f normal = normalized(Vec3f{query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z});
  return {true, query.ray.tfar, query.hit.primID, query.hit.u, query.hit.v, normal};
}

bool RayScene::occluded(const Vec3f& origin, const Vec3f& direction) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay ray = make_ray(origin, direction);
  rtcOccluded1(scene_.get(), &context, &ray);
  return ray.tfar < 0.0f;
}

}  // namespace astrolith
