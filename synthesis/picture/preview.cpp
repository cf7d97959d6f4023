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
#include "synthesis/picture/preview_rays_internal.h"
#include "synthesis/picture/ray_scene_internal.h"

namespace astrolith {
namespace {

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

// The sun of one view, in the scene's axes.
struct Sun {
  Vec3f direction;      // unit vector
  Vec3f first, second;  // across the sun's disk, as long as its apparent radius
};

Sun make_sun(const PreviewCamera& camera, const PreviewOptions& options) {
  const Vec3d sun = normalized(options.sun);
  Sun made{to_float(sun.x * camera.right + sun.y * camera.up + sun.z * camera.from), {}, {}};
  const auto radius =
      static_cast<float>(portable::tan(options.sun_radius_degrees * std::numbers::pi / 180.0));
  const Tangents<float> tangents = tangents_about(made.direction);
  made.first = radius * tangents.first;
  made.second = radius * tangents.second;
  return made;
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
        rays_(mesh, options, scene_),
        normals_(mesh.normals.size() == mesh.vertices.size() ? mesh.normals : vertex_normals(mesh)) {
    for (std::size_t view = 0; view < options.views.size(); ++view)
      suns_.push_back(make_sun(rays_.camera(view), options));
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
  Vec3f radiance(double px, double py, RayRandom& random, bool& is_hit) const {
    const std::optional<std::size_t> view = rays_.view_at(px, py);
    if (!view) return kBackground;
    const Vec3f to_viewer = rays_.camera(*view).to_viewer;
    const Vec3f origin = rays_.origin(*view, px, py);
    const RayHit hit = scene_.first_hit(origin, -to_viewer);
    if (!hit.found) return kBackground;
    is_hit = true;
    return shade(to_viewer, suns_[*view], origin - hit.distance * to_viewer, hit, random);
  }

  Vec3f shade(const Vec3f& to_viewer, const Sun& sun, const Vec3f& point, const RayHit& hit,
              RayRandom& random) const {
    const auto [face, normal] = seen_normals(mesh_, normals_, hit, to_viewer);
    const Vec3f start = point + kLift * face;
    const Vec3f albedo = options_.vertex_colors.empty()
                             ? kNeutralAlbedo
                             : interpolate_corners(mesh_, options_.vertex_colors, hit);
    const float light = sunlight(sun, start, normal, to_viewer, random);
    return albedo * (light + sky_light(start, normal, to_viewer, random));
  }

  float sunlight(const Sun& sun, const Vec3f& start, const Vec3f& normal, const Vec3f& to_viewer,
                 RayRandom& random) const {
    const auto [dx, dy] = disk_point(random);
    const Vec3f towards = normalized(sun.direction + dx * sun.first + dy * sun.second);
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
  PreviewRays rays_;
  std::vector<Vec3d> normals_;  // (#V)
  std::vector<Sun> suns_;       // one a view
};

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

std::vector<PreviewView> usual_views(const TriangleMesh& mesh) {
  // The areas of a closed surface, as vectors, add up to nothing; those of a plane to its whole area.
  constexpr double kFacesOneWay = 0.5;
  Vec3d facing{0, 0, 0};
  double area = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3d& p = mesh.vertices[t[0]];
    const Vec3d twice = cross(mesh.vertices[t[1]] - p, mesh.vertices[t[2]] - p);
    facing += twice;
    area += norm(twice);
  }
  if (!(norm(facing) > kFacesOneWay * area)) return standard_views();
  const PreviewView above = view_from(facing);
  const Vec3d north = normalized(above.up - dot(above.up, above.from) * above.from);
  return {above, {above.from - 1.2 * north, above.from}};
}

RgbImage render_preview(const TriangleMesh& mesh, const PreviewOptions& options, const Progress& progress) {
  check_preview_options(options, mesh);
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
