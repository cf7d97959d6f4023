#include "synthesis/picture/picture_maps.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "geometry/mesh_measure.h"
#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "synthesis/picture/preview_rays_internal.h"

namespace astrolith {
namespace {

PictureMaps empty_maps(const PreviewOptions& options) {
  PictureMaps maps;
  maps.width = options.width;
  maps.height = options.height;
  const std::size_t pixels =
      static_cast<std::size_t>(options.width) * static_cast<std::size_t>(options.height);
  maps.depth.assign(pixels, PictureMaps::kNoDepth);
  maps.normal.assign(3 * pixels, 0.0f);
  maps.view.assign(pixels, -1);
  return maps;
}

void set_cameras(const PreviewRays& rays, const RayScene& scene, std::size_t views, PictureMaps& maps) {
  maps.pixel = rays.pixel() / scene.scale();
  for (std::size_t view = 0; view < views; ++view) {
    const ViewCamera& camera = rays.camera(view);
    maps.right.push_back(camera.right);
    maps.up.push_back(camera.up);
    maps.from.push_back(camera.from);
    maps.corner.push_back(scene.from_unit(rays.on_plane(view, 0.0, 0.0)));
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    maps.eye.push_back(camera.is_pinhole ? scene.from_unit(camera.eye) : Vec3d{kNone, kNone, kNone});
  }
}

}  // namespace

Vec3d PictureMaps::point(int x, int y) const {
  const std::size_t i =
      static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  const auto k = static_cast<std::size_t>(static_cast<unsigned char>(view[i]));  // not -1
  const Vec3d q = corner[k] + (x + 0.5) * pixel * right[k] - (y + 0.5) * pixel * up[k];
  if (std::isnan(eye[k].x)) return q - double{depth[i]} * from[k];
  return eye[k] + double{depth[i]} * normalized(q - eye[k]);
}

PictureMaps render_maps(const TriangleMesh& mesh, const PreviewOptions& options, const Progress& progress) {
  check_preview_options(options, mesh);
  const RayScene scene(mesh);
  const PreviewRays rays(mesh, options, scene);
  rays.require_outside(scene);
  const std::vector<Vec3d> normals =
      mesh.normals.size() == mesh.vertices.size() ? mesh.normals : vertex_normals(mesh);
  PictureMaps maps = empty_maps(options);
  set_cameras(rays, scene, options.views.size(), maps);
  const auto shoot = [&](int x, int y, std::size_t i) {
    const std::optional<std::size_t> view = rays.view_at(x + 0.5, y + 0.5);
    if (!view) return;
    maps.view[i] = static_cast<std::int8_t>(*view);
    const PictureRay ray = rays.ray(*view, x + 0.5, y + 0.5);
    const RayHit hit = scene.first_hit(ray.origin, ray.direction);
    if (!hit.found) return;
    maps.depth[i] = static_cast<float>((ray.before + double{hit.distance}) / scene.scale());
    const Vec3f normal = seen_normals(mesh, normals, hit, -ray.direction).smooth;
    maps.normal[3 * i] = normal.x, maps.normal[3 * i + 1] = normal.y, maps.normal[3 * i + 2] = normal.z;
  };
  parallel_for(0, maps.height, [&](std::int64_t y) {
    for (int x = 0; x < maps.width; ++x) {
      shoot(x, static_cast<int>(y),
            static_cast<std::size_t>(y) * static_cast<std::size_t>(maps.width) + static_cast<std::size_t>(x));
    }
  });
  if (!report(progress, 1.0, "maps")) throw WorkError("preview-maps: stopped before the maps were complete");
  return maps;
}

}  // namespace astrolith
