#include "geometry/surface/triangle_scene.h"

#include <algorithm>

#include "geometry/surface/embree_internal.h"
#include "numerics/errors.h"

namespace astrolith {
namespace {

struct ReleaseGeometry {
  void operator()(RTCGeometryTy* geometry) const { rtcReleaseGeometry(geometry); }
};

}  // namespace

void TriangleScene::Release::operator()(RTCDeviceTy* device) const { rtcReleaseDevice(device); }
void TriangleScene::Release::operator()(RTCSceneTy* scene) const { rtcReleaseScene(scene); }

TriangleScene::TriangleScene(const TriangleMesh& mesh, const Vec3d& center, double scale)
    : center_(center), scale_(scale), device_(rtcNewDevice(nullptr)) {
  if (!device_) {
    // The library says nothing of memory where there is too little for its threads.
    throw WorkError("the ray-tracing library Embree does not start; is there enough memory?");
  }
  scene_.reset(rtcNewScene(device_.get()));
  rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
  add_triangles(mesh);
  rtcCommitScene(scene_.get());
  check();
}

void TriangleScene::add_triangles(const TriangleMesh& mesh) {
  const std::unique_ptr<RTCGeometryTy, ReleaseGeometry> geometry(
      rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
  auto* positions = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.vertices.size()));
  auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
      geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(Triangle), mesh.triangles.size()));
  check();
  for (const Vec3d& vertex : mesh.vertices) {
    const Vec3d q = to_scene(vertex);
    for (const double x : {q.x, q.y, q.z}) *positions++ = static_cast<float>(x);
  }
  for (const Triangle& t : mesh.triangles) indices = std::copy(t.begin(), t.end(), indices);
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometry(scene_.get(), geometry.get());
}

void TriangleScene::check() const {
  if (rtcGetDeviceError(device_.get()) != RTC_ERROR_NONE) {
    throw WorkError("building the tree of the surface failed; is there enough memory?");
  }
}

}  // namespace astrolith
