#include <algorithm>
#include <cmath>
#include <numbers>

#include "numerics/errors.h"
#include "numerics/portable_angles.h"
#include "synthesis/picture/preview_rays_internal.h"

namespace astrolith {
namespace {

constexpr double kFilled = 0.92;          // share of a panel that the largest view spans
constexpr double kLeastPixel = 1e-9;      // in the unit ball, of a mesh without extent
constexpr double kMapFilled = 0.84;       // share of a panel that a map spans, beside its degrees
constexpr double kOrthographicFar = 2.0;  // from the ball's centre to where orthographic rays begin

double radians(double degrees) { return degrees * std::numbers::pi / 180.0; }

// The axes of a camera, without its place.
ViewCamera oriented(const Camera& view) {
  ViewCamera camera;
  camera.from = normalized(view.from);
  const Vec3d right = normalized(cross(normalized(view.up), camera.from));
  if (!(squared_norm(right) > 0.5)) {
    throw InputError("preview: a view looks along its own up direction; choose another up");
  }
  const Vec3d up = cross(camera.from, right);
  const double c = portable::cos(radians(view.roll)), s = portable::sin(radians(view.roll));
  camera.right = view.roll == 0.0 ? right : c * right + s * up;
  camera.up = view.roll == 0.0 ? up : c * up - s * right;
  return camera;
}

void place_orthographic(const Camera& view, const RayScene& scene, const TriangleMesh& mesh,
                        ViewCamera& camera) {
  Box box;
  for (const Vec3d& vertex : mesh.vertices) {
    const Vec3d p = scene.to_unit(vertex);
    box.extend({dot(p, camera.right), dot(p, camera.up), 0.0});
  }
  Vec3d middle = box.center();
  camera.half_width = 0.5 * box.extent().x;
  camera.half_height = 0.5 * box.extent().y;
  if (view.target) {
    const Vec3d target = scene.to_unit(*view.target);
    middle = {dot(target, camera.right), dot(target, camera.up), 0.0};
  }
  camera.eye = middle.x * camera.right + middle.y * camera.up + kOrthographicFar * camera.from;
}

// The least distance at which a pinhole sees the whole mesh in the middle of its panel.
double distance_for_all(const Vec3d& target, const ViewCamera& camera, double half_width_tangent,
                        double half_height_tangent, const RayScene& scene, const TriangleMesh& mesh) {
  constexpr double kClearance = 0.05;  // radii before what lies on the line of sight
  double distance = 0.0;
  for (const Vec3d& vertex : mesh.vertices) {
    const Vec3d p = scene.to_unit(vertex) - target;
    const double across = std::max(std::fabs(dot(p, camera.right)) / half_width_tangent,
                                   std::fabs(dot(p, camera.up)) / half_height_tangent);
    distance = std::max(distance, dot(p, camera.from) + std::max(across / kFilled, kClearance));
  }
  return distance;
}

void place_pinhole(const Camera& view, const RayScene& scene, const TriangleMesh& mesh, double panel_width,
                   double panel_height, ViewCamera& camera) {
  const double tangent = portable::tan(radians(0.5 * view.field_of_view));
  const Vec3d target = view.target ? scene.to_unit(*view.target) : Vec3d{0, 0, 0};
  double distance = view.in_radii ? view.distance : view.distance * scene.scale();
  if (!(view.distance > 0.0)) {
    distance = distance_for_all(target, camera, tangent, tangent * panel_height / panel_width, scene, mesh);
  }
  camera.is_pinhole = true;
  camera.pixel = 2.0 * tangent / panel_width;
  camera.eye = target + distance * camera.from;
}

// Whether the first surface before a pinhole turns its back to it.
bool is_inside(const ViewCamera& camera, const RayScene& scene) {
  if (norm(camera.eye) > 1.0) return false;
  const RayHit hit = scene.first_hit(to_float(camera.eye), to_float(-camera.from));
  return hit.found && dot(hit.normal, to_float(camera.from)) < 0.0f;
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
  if (!within(options.sun_radius_degrees, 0, 45) || !within(options.ambient, 0, 10)) {
    throw InputError("preview: the sun's radius must be 0 .. 45 degrees and the ambient light 0 .. 10");
  }
  if (!(squared_norm(options.sun.direction) > 0.0)) throw InputError("preview: the sun needs a direction");
  for (const Camera& view : options.views) {
    if (!within(view.field_of_view, 0, 175) || !(view.distance >= 0.0) || !std::isfinite(view.roll)) {
      throw InputError("preview: a field of view must be 0 .. 175 degrees, a distance above 0");
    }
  }
  if (!options.vertex_colors.empty() && options.vertex_colors.size() != mesh.vertices.size()) {
    throw InputError("preview: give one colour a vertex, or none");
  }
}

PreviewRays::PreviewRays(const TriangleMesh& mesh, const PreviewOptions& options, const RayScene& scene)
    : width_(options.width),
      height_(options.height - marks_height(options)),
      columns_(static_cast<int>(std::ceil(std::sqrt(double(options.views.size()))))),
      rows_((static_cast<int>(options.views.size()) + columns_ - 1) / columns_),
      pixel_(kLeastPixel),
      origin_(scene.to_unit({0, 0, 0})) {
  for (const Camera& view : options.views) {
    ViewCamera camera = oriented(view);
    camera.map = view.map;
    if (view.map != MapProjection::kNone) {
      if (!(norm(origin_) < 1.0))
        throw InputError(
            "preview: the origin of the mesh's axes lies beside it, so that it has no longitudes");
    } else if (view.field_of_view > 0.0) {
      place_pinhole(view, scene, mesh, panel_width(), panel_height(), camera);
    } else {
      place_orthographic(view, scene, mesh, camera);
    }
    cameras_.push_back(camera);
  }
  double at_body = 0.0;  // side of a pixel of a pinhole at the ball's centre
  for (const ViewCamera& camera : cameras_) {
    pixel_ = std::max({pixel_, 2 * camera.half_width / (kFilled * panel_width()),
                       2 * camera.half_height / (kFilled * panel_height())});
    if (camera.is_pinhole) at_body = std::max(at_body, camera.pixel * norm(camera.eye));
  }
  if (pixel_ == kLeastPixel && at_body > 0.0) pixel_ = at_body;
  for (ViewCamera& camera : cameras_) {
    if (!camera.is_pinhole) camera.pixel = pixel_;
  }
}

void fail_inside() {
  throw InputError("camera: it stands inside the body or below its ground; give a larger distance");
}

void PreviewRays::require_outside(const RayScene& scene) const {
  for (const ViewCamera& camera : cameras_) {
    if (camera.is_pinhole && is_inside(camera, scene)) fail_inside();
  }
}

std::optional<std::size_t> PreviewRays::view_at(double px, double py) const {
  if (py >= height_) return std::nullopt;
  const int column = std::min(columns_ - 1, static_cast<int>(px / panel_width()));
  const int row = std::min(rows_ - 1, static_cast<int>(py / panel_height()));
  const auto view = static_cast<std::size_t>(row * columns_ + column);
  if (view >= cameras_.size()) return std::nullopt;
  if (cameras_[view].map != MapProjection::kNone && !map_direction_at(view, px, py)) return std::nullopt;
  return view;
}

double PreviewRays::map_half() const {
  const MapProjection map = cameras_[0].map;
  return 0.5 * kMapFilled * std::min(panel_height(), panel_width() / map_width(map));
}

std::optional<Vec3d> PreviewRays::map_direction_at(std::size_t view, double px, double py) const {
  const ViewCamera& camera = cameras_[view];
  const Vec3d offset = (1.0 / map_half()) * across(view, px, py);
  const auto d = map_direction(camera.map, dot(offset, camera.right), dot(offset, camera.up));
  if (!d) return std::nullopt;
  return d->x * camera.from + d->y * camera.right + d->z * camera.up;
}

std::optional<std::pair<double, double>> PreviewRays::on_map(std::size_t view, const Vec3d& direction) const {
  const ViewCamera& camera = cameras_[view];
  const auto place = map_place(
      camera.map, {dot(direction, camera.from), dot(direction, camera.right), dot(direction, camera.up)});
  if (!place) return std::nullopt;
  const auto [left, bottom] = lower_left(view);
  return std::pair(left + 0.5 * panel_width() + map_half() * place->first,
                   bottom - 0.5 * panel_height() - map_half() * place->second);
}

Vec3d PreviewRays::across(std::size_t view, double px, double py) const {
  const int column = static_cast<int>(view) % columns_, row = static_cast<int>(view) / columns_;
  return (px - (column + 0.5) * panel_width()) * cameras_[view].right +
         ((row + 0.5) * panel_height() - py) * cameras_[view].up;
}

Vec3d PreviewRays::on_plane(std::size_t view, double px, double py) const {
  const ViewCamera& camera = cameras_[view];
  const double before = camera.is_pinhole ? pixel_ / camera.pixel : 0.0;
  return camera.eye - before * camera.from + pixel_ * across(view, px, py);
}

PictureRay PreviewRays::ray(std::size_t view, double px, double py) const {
  const ViewCamera& camera = cameras_[view];
  if (camera.map != MapProjection::kNone) {
    const Vec3d outwards = map_direction_at(view, px, py).value_or(camera.from);
    return {to_float(origin_ + kOrthographicFar * outwards), to_float(-outwards), 0.0,
            static_cast<float>(kOrthographicFar)};
  }
  const Vec3d offset = camera.pixel * across(view, px, py);
  if (!camera.is_pinhole) return {to_float(camera.eye + offset), to_float(-camera.from), 0.0};
  const Vec3d direction = normalized(offset - camera.from);
  // Where the ray of a far camera nears the ball: single precision is enough from there.
  const double before = std::max(0.0, -dot(camera.eye, direction) - kOrthographicFar);
  return {to_float(camera.eye + before * direction), to_float(direction), before};
}

std::optional<std::pair<double, double>> PreviewRays::seen_at(std::size_t view, const Vec3d& point,
                                                              const RayScene& scene) const {
  constexpr double kLifted = 1e-3;  // above the surface that the point lies on
  const ViewCamera& camera = cameras_[view];
  if (camera.map != MapProjection::kNone) {
    const Vec3d outwards = normalized(point - origin_);
    if (scene.occluded(to_float(point + kLifted * outwards), to_float(outwards))) return std::nullopt;
    return on_map(view, point - origin_);
  }
  const Vec3d offset = point - camera.eye;
  const double depth = -dot(offset, camera.from);
  if (!(depth > 0.0)) return std::nullopt;
  const Vec3d towards = camera.is_pinhole ? normalized(-offset) : camera.from;
  if (scene.occluded(to_float(point + kLifted * towards), to_float(towards))) return std::nullopt;
  const double pixel = camera.is_pinhole ? depth * camera.pixel : camera.pixel;
  const auto [left, bottom] = lower_left(view);
  const double px = left + 0.5 * panel_width() + dot(offset, camera.right) / pixel;
  const double py = bottom - 0.5 * panel_height() - dot(offset, camera.up) / pixel;
  if (!(px >= 0.0 && py >= 0.0 && px < width_) || view_at(px, py) != view) return std::nullopt;
  return std::pair(px, py);
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
