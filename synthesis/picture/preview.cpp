#include "synthesis/picture/preview.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/mesh_normals.h"
#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "numerics/parallel_for.h"
#include "numerics/portable_angles.h"
#include "numerics/scalar_math.h"
#include "numerics/tangent_frame.h"
#include "synthesis/picture/colormap.h"
#include "synthesis/picture/ray_scene_internal.h"

namespace astrolith {
namespace {

constexpr double kFilled = 0.92;  // share of a tile that the largest view spans
constexpr Vec3f kBackground{0.0030f, 0.0034f, 0.0048f};
constexpr Vec3f kNeutralAlbedo{0.58f, 0.56f, 0.535f};
// The height above the surface at which secondary rays start, in radii of the body. It exceeds the rounding
// errors of a hit.
constexpr float kLift = 2e-5f;
// The share of the law of Lommel and Seeliger in the reflectance (McEwen 1991), which makes full moons look
// flat. Rocks look less flat: the rest of the reflectance follows Lambert.
constexpr float kLunarShare = 0.35f;

// A frame across the unit vector n. Sums are rounded twice and the sign bit of n.z decides the frame, because
// pictures have always had these bits.
Tangents<float> tangents_about(const Vec3f& n) {
  return duff_tangents<SumRounding::kTwice>(n, std::copysign(1.0f, n.z));
}

// An orthographic camera in the unit ball of the scene.
struct Camera {
  Vec3f to_viewer, sun;         // unit vectors
  Vec3f sun_first, sun_second;  // across the sun's disk, as long as its apparent radius
  Vec3d right, up, from;        // orthonormal
  // The centre and the half sides of the body's box in the picture plane.
  double center_x = 0, center_y = 0, half_width = 0, half_height = 0;
};

void light(Camera& camera, const PreviewOptions& options) {
  const Vec3d sun = normalized(options.sun);
  camera.sun = to_float(sun.x * camera.right + sun.y * camera.up + sun.z * camera.from);
  const auto radius =
      static_cast<float>(portable::tan(options.sun_radius_degrees * std::numbers::pi / 180.0));
  const Tangents<float> tangents = tangents_about(camera.sun);
  camera.sun_first = radius * tangents.first;
  camera.sun_second = radius * tangents.second;
}

Camera make_camera(const PreviewView& view, const PreviewOptions& options, const RayScene& scene,
                   const TriangleMesh& mesh) {
  Camera camera;
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
  light(camera, options);
  return camera;
}

// Uniform random numbers of one ray, as hashes of the pixel and the ray.
class RayRandom {
 public:
  RayRandom(std::uint64_t seed, int x, int y, int ray) : hash_(hash_cell(hash_seed(seed, 0), x, y, ray)) {}
  float next() { return unit_float(hash_append(hash_, index_++)); }

 private:
  std::uint32_t hash_;
  std::uint32_t index_ = 0;
};

// A point of the unit disk with uniform density.
std::array<float, 2> disk_point(RayRandom& random) {
  const float radius = math::sqrt(random.next());
  const float turn = random.next();
  return {radius * math::cos_turns(turn), radius * math::sin_turns(turn)};
}

class Painter {
 public:
  Painter(const TriangleMesh& mesh, const PreviewOptions& options)
      : mesh_(mesh),
        options_(options),
        scene_(mesh),
        normals_(mesh.normals.size() == mesh.vertices.size() ? mesh.normals : vertex_normals(mesh)),
        columns_(static_cast<int>(std::ceil(std::sqrt(double(options.views.size()))))),
        rows_((static_cast<int>(options.views.size()) + columns_ - 1) / columns_) {
    for (const PreviewView& view : options.views)
      cameras_.push_back(make_camera(view, options, scene_, mesh));
    for (const Camera& camera : cameras_) {
      pixel_ = std::max({pixel_, 2 * camera.half_width / (kFilled * tile_width()),
                         2 * camera.half_height / (kFilled * tile_height())});
    }
  }

  std::array<unsigned char, 3> pixel(int x, int y) const {
    const int n = options_.oversampling, rays = n * n;
    Vec3f sum;
    bool is_hit = false;
    for (int k = 0; k < rays; ++k) {
      // The rays at two opposite corners come first. Where both miss the body, the whole pixel is background.
      const int ray = k == 1 ? rays - 1 : k > 1 ? k - 1 : 0;
      const int column = ray % n, row = ray / n;
      RayRandom random(options_.seed, x, y, ray);
      const double px = x + (column + double(random.next())) / n;
      const double py = y + (row + double(random.next())) / n;
      sum += radiance(px, py, random, is_hit);
      if (k == 1 && !is_hit)
        return {srgb_byte(kBackground.x), srgb_byte(kBackground.y), srgb_byte(kBackground.z)};
    }
    sum *= 1.0f / static_cast<float>(rays);
    return {srgb_byte(sum.x), srgb_byte(sum.y), srgb_byte(sum.z)};
  }

 private:
  double tile_width() const { return double(options_.width) / columns_; }
  double tile_height() const { return double(options_.height) / rows_; }

  Vec3f radiance(double px, double py, RayRandom& random, bool& is_hit) const {
    const int column = std::min(columns_ - 1, static_cast<int>(px / tile_width()));
    const int row = std::min(rows_ - 1, static_cast<int>(py / tile_height()));
    const auto view = static_cast<std::size_t>(row * columns_ + column);
    if (view >= cameras_.size()) return kBackground;
    const Camera& camera = cameras_[view];
    const double u = (px - (column + 0.5) * tile_width()) * pixel_ + camera.center_x;
    const double v = ((row + 0.5) * tile_height() - py) * pixel_ + camera.center_y;
    const Vec3f origin = to_float(u * camera.right + v * camera.up + 2.0 * camera.from);
    const RayHit hit = scene_.first_hit(origin, -camera.to_viewer);
    if (!hit.found) return kBackground;
    is_hit = true;
    return shade(camera, origin - hit.distance * camera.to_viewer, hit, random);
  }

  // Interpolates a value at the corners of the triangle that was hit.
  template <typename T>
  Vec3f interpolate(const std::vector<Vec3<T>>& corners, const RayHit& hit) const {
    const Triangle& t = mesh_.triangles[hit.triangle];
    const T u = hit.u, v = hit.v;
    const Vec3<T> value = (T(1) - u - v) * corners[t[0]] + u * corners[t[1]] + v * corners[t[2]];
    return {static_cast<float>(value.x), static_cast<float>(value.y), static_cast<float>(value.z)};
  }

  Vec3f shade(const Camera& camera, const Vec3f& point, const RayHit& hit, RayRandom& random) const {
    const Vec3f& to_viewer = camera.to_viewer;
    Vec3f face = hit.normal;
    Vec3f normal = normalized(interpolate(normals_, hit));
    if (squared_norm(normal) < 0.5f) normal = face;
    // In open or inverted meshes a surface may be seen from behind. It is lit like the others.
    if (dot(face, to_viewer) < 0.0f) face = -face;
    if (dot(normal, face) < 0.0f) normal = -normal;
    const Vec3f start = point + kLift * face;
    const Vec3f albedo =
        options_.vertex_colors.empty() ? kNeutralAlbedo : interpolate(options_.vertex_colors, hit);
    const float sun = sunlight(camera, start, normal, to_viewer, random);
    return albedo * (sun + sky_light(start, normal, to_viewer, random));
  }

  float sunlight(const Camera& camera, const Vec3f& start, const Vec3f& normal, const Vec3f& to_viewer,
                 RayRandom& random) const {
    const auto [dx, dy] = disk_point(random);
    const Vec3f towards = normalized(camera.sun + dx * camera.sun_first + dy * camera.sun_second);
    const float incidence = dot(normal, towards);
    if (incidence <= 0.0f || scene_.occluded(start, towards)) return 0.0f;
    const float emission = std::max(dot(normal, to_viewer), 1e-3f);
    return kLunarShare * 2.0f * incidence / (incidence + emission) + (1.0f - kLunarShare) * incidence;
  }

  // Light from a sky that is brightest behind the viewer. One cosine-weighted ray tests whether the sky is
  // open. In shadows this keeps slopes legible and makes hollows look hollow.
  float sky_light(const Vec3f& start, const Vec3f& normal, const Vec3f& to_viewer, RayRandom& random) const {
    if (options_.fill_light <= 0.0) return 0.0f;
    const auto [dx, dy] = disk_point(random);
    const float dz = math::sqrt(std::max(0.0f, 1.0f - dx * dx - dy * dy));
    const Tangents<float> tangents = tangents_about(normal);
    const Vec3f towards = normalized(dx * tangents.first + dy * tangents.second + dz * normal);
    if (scene_.occluded(start, towards)) return 0.0f;
    const float facing = std::max(0.0f, dot(normal, to_viewer));
    return static_cast<float>(options_.fill_light) * (0.25f + 0.75f * facing * facing);
  }

  const TriangleMesh& mesh_;
  const PreviewOptions& options_;
  RayScene scene_;
  std::vector<Vec3d> normals_;  // (#V)
  int columns_, rows_;
  std::vector<Camera> cameras_;  // one a view
  double pixel_ = 1e-9;          // side of a pixel in the unit ball
};

void check(const PreviewOptions& options, const TriangleMesh& mesh) {
  const auto within = [](double value, double low, double high) { return value >= low && value <= high; };
  if (!within(options.width, 16, 16384) || !within(options.height, 16, 16384)) {
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

}  // namespace

PreviewView view_from(const Vec3d& direction) {
  const Vec3d from = normalized(direction);
  const bool polar = from.x * from.x + from.y * from.y < 1e-6;
  return {from, polar ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1}};
}

std::vector<PreviewView> standard_views() {
  return {
      {{1, 0, 0}, {0, 0, 1}}, {{0, 1, 0}, {0, 0, 1}}, {{0, 0, 1}, {0, 1, 0}}, {{1.0, -1.2, 0.8}, {0, 0, 1}}};
}

RgbImage render_preview(const TriangleMesh& mesh, const PreviewOptions& options, const Progress& progress) {
  check(options, mesh);
  const Painter painter(mesh, options);
  RgbImage image{options.width, options.height, {}};
  image.pixels.resize(3 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  constexpr int kBand = 32;  // rows between two reports of progress
  for (int first = 0; first < image.height; first += kBand) {
    const int end = std::min(image.height, first + kBand);
    parallel_for(first, end, [&](std::int64_t y) {
      unsigned char* out =
          &image.pixels[3 * static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width)];
      for (int x = 0; x < image.width; ++x) {
        for (const unsigned char byte : painter.pixel(x, static_cast<int>(y))) *out++ = byte;
      }
    });
    if (!report(progress, double(end) / image.height, "preview")) {
      throw WorkError("preview: stopped before the picture was complete");
    }
  }
  return image;
}

}  // namespace astrolith
