#include <algorithm>
#include <cmath>

#include "numerics/errors.h"
#include "synthesis/picture/preview_rays_internal.h"

namespace astrolith {
namespace {

constexpr double kFilled = 0.92;  // share of a tile that the largest view spans

PreviewCamera make_camera(const PreviewView& view, const RayScene& scene, const TriangleMesh& mesh) {
  PreviewCamera camera;
  camera.from = normalized(view.from);
  camera.right = normalized(cross(view.up, camera.from));
  camera.up = cross(camera.from, camera.right);
  if (!(squared_norm(camera.right) > 0.5)) {
    throw InputError("preview: a view looks along its own up direction; choose another up");
  }
  Box box;
  for (const Vec3d& vertex : mesh.vertices) {
    const Vec3d p = scene.to_unit(vertex);
    box.extend({dot(p, camera.right), dot(p, camera.up), 0.0});
  }
  camera.center_x = box.center().x;
  camera.center_y = box.center().y;
  camera.half_width = 0.5 * box.extent().x;
  camera.half_height = 0.5 * box.extent().y;
  camera.to_viewer = to_float(camera.from);
  return camera;
}

}  // namespace

void check_preview_options(const PreviewOptions& options, const TriangleMesh& mesh) {
  const auto within = [](double value, double low, double high) { return value >= low && value <= high; };
  if (!within(options.width, kLeastPictureSide, kMostPictureSide) ||
      !within(options.height, kLeastPictureSide, kMostPictureSide)) {
    throw InputError("preview: the picture's sides must be 16 .. 16384 pixels");
  }
  if (!within(options.oversampling, 1, 16)) throw InputError("preview: oversampling must be 1 .. 16");
  if (!within(static_cast<double>(options.views.size()), 1, 64)) {
    throw InputError("preview: give 1 .. 64 views");
  }
  if (!within(options.sun_radius_degrees, 0, 45) || !within(options.fill_light, 0, 10)) {
    throw InputError("preview: the sun's radius must be 0 .. 45 degrees and the fill light 0 .. 10");
  }
  if (!(squared_norm(options.sun) > 0.0)) throw InputError("preview: the sun needs a direction");
  if (!options.vertex_colors.empty() && options.vertex_colors.size() != mesh.vertices.size()) {
    throw InputError("preview: give one colour a vertex, or none");
  }
}

PreviewRays::PreviewRays(const TriangleMesh& mesh, const PreviewOptions& options, const RayScene& scene)
    : width_(options.width),
      height_(options.height),
      columns_(static_cast<int>(std::ceil(std::sqrt(double(options.views.size()))))),
      rows_((static_cast<int>(options.views.size()) + columns_ - 1) / columns_) {
  for (const PreviewView& view : options.views) cameras_.push_back(make_camera(view, scene, mesh));
  for (const PreviewCamera& camera : cameras_) {
    pixel_ = std::max({pixel_, 2 * camera.half_width / (kFilled * tile_width()),
                       2 * camera.half_height / (kFilled * tile_height())});
  }
}

std::optional<std::size_t> PreviewRays::view_at(double px, double py) const {
  const int column = std::min(columns_ - 1, static_cast<int>(px / tile_width()));
  const int row = std::min(rows_ - 1, static_cast<int>(py / tile_height()));
  const auto view = static_cast<std::size_t>(row * columns_ + column);
  return view < cameras_.size() ? std::optional(view) : std::nullopt;
}

Vec3d PreviewRays::exact_origin(std::size_t view, double px, double py) const {
  const PreviewCamera& camera = cameras_[view];
  const int column = static_cast<int>(view) % columns_, row = static_cast<int>(view) / columns_;
  const double u = (px - (column + 0.5) * tile_width()) * pixel_ + camera.center_x;
  const double v = ((row + 0.5) * tile_height() - py) * pixel_ + camera.center_y;
  return u * camera.right + v * camera.up + kCameraDistance * camera.from;
}

SeenNormals seen_normals(const TriangleMesh& mesh, const std::vector<Vec3d>& vertex_normals,
                         const RayHit& hit, const Vec3f& to_viewer) {
  Vec3f face = hit.normal;
  Vec3f normal = normalized(interpolate_corners(mesh, vertex_normals, hit));
  if (squared_norm(normal) < 0.5f) normal = face;
  if (dot(face, to_viewer) < 0.0f) face = -face;
  if (dot(normal, face) < 0.0f) normal = -normal;
  return {face, normal};
}

}  // namespace astrolith
