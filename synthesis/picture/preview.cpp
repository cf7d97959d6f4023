#include "synthesis/picture/preview.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include "geometry/mesh_measure.h"
#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "numerics/parallel_for.h"
#include "numerics/portable_angles.h"
#include "numerics/scalar_math.h"
#include "numerics/srgb.h"
#include "numerics/tangent_frame.h"
#include "synthesis/picture/preview_rays_internal.h"
#include "synthesis/picture/ray_scene.h"

namespace astrolith {
namespace {

constexpr Vec3f kNeutralAlbedo{0.58f, 0.56f, 0.535f};
// The height above the surface at which secondary rays start, in radii of the body. It exceeds the rounding
// errors of a hit.
constexpr float kLift = 2e-5f;
// Square roots of linear light in neighbouring pixels that differ by more are worth more samples.
constexpr float kContrast = 0.035f;
// Points of the sun's disk that neighbouring pixels look at in turn, along a row and along a column. Pixels
// in a penumbra then differ and get more samples.
constexpr int kTurns = 3;

float fraction(double x) { return static_cast<float>(x - std::floor(x)); }

// The sun of one view, in the scene's axes.
struct Sun {
  Vec3f direction;      // unit vector
  Vec3f first, second;  // across the sun's disk, as long as its apparent radius
  bool casts_shadows = true;
};

// The sun of a place on a map: from the upper left, whatever the place.
Sun map_sun(const Vec3f& outwards) {
  const Vec3f across{-outwards.y, outwards.x, 0.0f};
  const float length = norm(across);
  const Vec3f east = length > 1e-6f ? (1.0f / length) * across : Vec3f{0.0f, 1.0f, 0.0f};
  return {normalized(cross(outwards, east) - east + 1.4f * outwards), {}, {}, false};
}

// What is left of light where colours stand for numbers: some relief, and a darker outline, so that a colour
// is nearly the one of the bar.
float faint_relief(float incidence, float facing) {
  const float relief = 0.86f + 0.14f * std::clamp(incidence, 0.0f, 1.0f),
              outline = std::min(1.0f, 0.7f + facing);
  return relief * outline;
}

Sun make_sun(const ViewCamera& camera, const PreviewOptions& options) {
  const Vec3d sun = normalized(options.sun.direction);
  const Vec3d direction =
      options.sun.in_mesh_axes ? sun : sun.x * camera.right + sun.y * camera.up + sun.z * camera.from;
  Sun made{to_float(direction), {}, {}};
  const auto radius =
      static_cast<float>(portable::tan(options.sun_radius_degrees * std::numbers::pi / 180.0));
  const Tangents<float> tangents =
      duff_tangents<SumRounding::kTwice>(made.direction, std::copysign(1.0f, made.direction.z));
  made.first = radius * tangents.first;
  made.second = radius * tangents.second;
  return made;
}

// Where a sample lies in its pixel, and the point of the unit disk that stands for the sun.
struct SamplePlace {
  float x = 0.5f, y = 0.5f, sun_x = 0, sun_y = 0;
};

constexpr double kGoldenTurn = 0.6180339887498949;

// The k-th of `count` points that cover the unit disk evenly (Vogel 1979).
SamplePlace on_disk(float x, float y, int k, int count) {
  const float radius = math::sqrt((static_cast<float>(k) + 0.5f) / static_cast<float>(count));
  const float turn = fraction(kGoldenTurn * k);
  return {x, y, radius * math::cos_turns(turn), radius * math::sin_turns(turn)};
}

// Places that cover the pixel by a lattice of the golden ratio, moved by the seed. All pixels have the same
// places, so that penumbrae are free of noise.
std::vector<SamplePlace> sample_places(int count, std::uint64_t seed) {
  const std::uint32_t hash = hash_seed(seed, 0);
  const double dx = unit_float(hash_append(hash, 0)), dy = unit_float(hash_append(hash, 1));
  std::vector<SamplePlace> places;
  for (int k = 0; k < count; ++k)
    places.push_back(on_disk(fraction((k + dx) / count), fraction(dy + kGoldenTurn * k), k, count));
  return places;
}

// What one sample or one pixel shows.
struct Seen {
  Vec3f light;         // linear, of the surface; weighted by `cover`
  float cover = 0.0f;  // share of the samples that meet the surface
};

bool differ(const Vec3f& a, const Vec3f& b) {
  const Vec3f d = a - b;
  return std::max({std::fabs(d.x), std::fabs(d.y), std::fabs(d.z)}) > kContrast;
}

// A sample at the middle of a pixel, and the square roots of its light.
struct Probe {
  Seen seen;
  Vec3f level{-1.0f, -1.0f, -1.0f};
};

class Painter {
 public:
  Painter(const TriangleMesh& mesh, const PreviewOptions& options)
      : mesh_(mesh),
        options_(options),
        scene_(mesh),
        rays_(mesh, options, scene_),
        normals_(mesh.normals.size() == mesh.vertices.size() ? mesh.normals : vertex_normals(mesh)),
        places_(sample_places(options.oversampling * options.oversampling, options.seed)) {
    rays_.require_outside(scene_);
    for (std::size_t view = 0; view < options.views.size(); ++view)
      suns_.push_back(make_sun(rays_.camera(view), options));
    for (int k = 0; k < kTurns * kTurns; ++k) {
      // Neighbours look at far points of the disk.
      turns_.push_back(on_disk(0.5f, 0.5f, k * 4 % (kTurns * kTurns), kTurns * kTurns));
    }
  }

  Figure draw_marks(const RgbaImage16& image) const {
    return astrolith::draw_marks(image, options_, rays_, scene_);
  }

  // The bit of the view that a pixel belongs to.
  std::uint64_t view_bit(int x, int y) const {
    const std::optional<std::size_t> view = rays_.view_at(x + 0.5, y + 0.5);
    return view ? std::uint64_t{1} << *view : 0;
  }

  Probe probe(int x, int y) const {
    Probe made{sample(x, y, turns_[static_cast<std::size_t>(x % kTurns + kTurns * (y % kTurns))])};
    const Vec3f& light = made.seen.light;
    if (made.seen.cover > 0.0f) made.level = {math::sqrt(light.x), math::sqrt(light.y), math::sqrt(light.z)};
    return made;
  }

  Seen pixel(int x, int y) const {
    Seen sum;
    for (const SamplePlace& place : places_) {
      const Seen seen = sample(x, y, place);
      sum.light += seen.light;
      sum.cover += seen.cover;
    }
    const float share = 1.0f / static_cast<float>(places_.size());
    return {share * sum.light, share * sum.cover};
  }

 private:
  Seen sample(int x, int y, const SamplePlace& place) const {
    const double px = x + double{place.x}, py = y + double{place.y};
    const std::optional<std::size_t> view = rays_.view_at(px, py);
    if (!view) return {};
    const PictureRay ray = rays_.ray(*view, px, py);
    const RayHit hit = scene_.first_hit(ray.origin, ray.direction);
    if (!hit.found || hit.distance >= ray.end) return {};
    const Vec3f point = ray.origin + hit.distance * ray.direction;
    const bool is_map = rays_.camera(*view).map != MapProjection::kNone;
    return {shade(-ray.direction, is_map ? map_sun(-ray.direction) : suns_[*view], point, hit, place), 1.0f};
  }

  Vec3f shade(const Vec3f& to_viewer, const Sun& sun, const Vec3f& point, const RayHit& hit,
              const SamplePlace& place) const {
    const auto [face, smooth] = seen_normals(mesh_, normals_, hit, to_viewer);
    const MappedPlace mapped =
        options_.maps ? options_.maps(hit.triangle, hit.u, hit.v) : MappedPlace{smooth};
    const Vec3f albedo = mapped.albedo ? *mapped.albedo
                         : options_.vertex_colors.empty()
                             ? kNeutralAlbedo
                             : interpolate_corners(mesh_, options_.vertex_colors, hit);
    const float facing = std::max(0.0f, dot(mapped.normal, to_viewer));
    if (options_.colors_are_values && !options_.keep_radiance)
      return faint_relief(dot(mapped.normal, sun.direction), facing) * albedo;
    const Vec3f start = lifted(point, hit, face);
    return albedo * (sunlight(sun, start, mapped.normal, to_viewer, place) + mapped.open * ambient(facing));
  }

  // Where secondary rays start: above the planes across the normals of the triangle's corners, so that facets
  // near the terminator do not shade their neighbours (Hanika, "Hacking the shadow terminator", 2021).
  Vec3f lifted(const Vec3f& point, const RayHit& hit, const Vec3f& face) const {
    const Triangle& t = mesh_.triangles[hit.triangle];
    const float weights[] = {1.0f - hit.u - hit.v, hit.u, hit.v};
    Vec3f start = point + kLift * face;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3f normal = to_float(normals_[t[k]]);
      if (dot(normal, face) <= 0.0f) continue;  // the surface is seen from behind
      const float below = dot(point - to_float(scene_.to_unit(mesh_.vertices[t[k]])), normal);
      if (below < 0.0f) start -= weights[k] * below * normal;
    }
    return start;
  }

  float sunlight(const Sun& sun, const Vec3f& start, const Vec3f& normal, const Vec3f& to_viewer,
                 const SamplePlace& place) const {
    const float incidence = dot(normal, sun.direction), facing = std::max(0.0f, dot(normal, to_viewer));
    if (incidence <= 0.0f) return 0.0f;
    const Vec3f towards = normalized(sun.direction + place.sun_x * sun.first + place.sun_y * sun.second);
    if (sun.casts_shadows && scene_.occluded(start, towards)) return 0.0f;
    const float cos_phase = dot(to_viewer, sun.direction);
    return options_.keep_radiance ? radiance_factor(options_.reflectance, incidence, facing, cos_phase)
                                  : pictured_reflectance(options_.reflectance, incidence, facing, cos_phase);
  }

  // Light from a sky that is brightest behind the viewer keeps slopes legible in shadows.
  float ambient(float facing) const {
    if (options_.keep_radiance) return 0.0f;
    return static_cast<float>(options_.ambient) * (0.25f + 0.75f * facing * facing);
  }

  const TriangleMesh& mesh_;
  const PreviewOptions& options_;
  RayScene scene_;
  PreviewRays rays_;
  std::vector<Vec3d> normals_;  // (#V)
  std::vector<SamplePlace> places_, turns_;
  std::vector<Sun> suns_;  // one a view
};

// Values of sRGB in 16 bits, from a table over the square root of linear light, on which they are smooth.
class SrgbTable {
 public:
  SrgbTable() {
    for (int i = 0; i <= kSteps + 1; ++i) {
      const double root = std::min(1.0, static_cast<double>(i) / kSteps);
      values_.push_back(static_cast<float>(65535.0 * linear_to_srgb(root * root)));
    }
  }
  std::uint16_t operator()(float linear) const {
    const float at = math::sqrt(std::clamp(linear, 0.0f, 1.0f)) * kSteps;
    const auto i = static_cast<std::size_t>(at);
    const float between = at - static_cast<float>(i);
    return static_cast<std::uint16_t>(values_[i] + between * (values_[i + 1] - values_[i]) + 0.5f);
  }

 private:
  static constexpr int kSteps = 4096;
  std::vector<float> values_;
};

// Paints bands of rows: first a sample for each pixel, then more where neighbours differ.
class BandPainter {
 public:
  BandPainter(const Painter& painter, const PreviewOptions& options, RgbaImage16& image)
      : painter_(painter), options_(options), image_(image), shown_(static_cast<std::size_t>(image.height)) {
    if (options.keep_radiance) radiance_.resize(image.pixels.size() / 4 * 3);
  }

  std::vector<float> radiance() { return std::move(radiance_); }

  void paint(int first, int end) {
    first_probe_ = std::max(0, first - 1);
    const int end_probe = std::min(image_.height, end + 1);
    probes_.resize(static_cast<std::size_t>(end_probe - first_probe_) * columns());
    parallel_for(first_probe_, end_probe, [&](std::int64_t y) {
      std::uint64_t shown = 0;
      for (int x = 0; x < image_.width; ++x) {
        Probe& probe = probes_[index(x, static_cast<int>(y))];
        probe = painter_.probe(x, static_cast<int>(y));
        if (probe.seen.cover > 0.0f) shown |= painter_.view_bit(x, static_cast<int>(y));
      }
      shown_[static_cast<std::size_t>(y)] = shown;
    });
    parallel_for(first, end, [&](std::int64_t y) {
      for (int x = 0; x < image_.width; ++x) paint_pixel(x, static_cast<int>(y), end_probe);
    });
  }

  // The views that no probe has met the mesh in. Call it when all rows are painted.
  std::vector<std::size_t> empty_views() const {
    const std::uint64_t shown =
        std::accumulate(shown_.begin(), shown_.end(), std::uint64_t{0}, std::bit_or<>());
    std::vector<std::size_t> empty;
    for (std::size_t view = 0; view < options_.views.size(); ++view) {
      if ((shown >> view & 1) == 0) empty.push_back(view);
    }
    return empty;
  }

 private:
  std::size_t columns() const { return static_cast<std::size_t>(image_.width); }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y - first_probe_) * columns() + static_cast<std::size_t>(x);
  }

  bool is_even(int x, int y, int end_probe) const {
    const Vec3f& level = probes_[index(x, y)].level;
    for (int v = std::max(first_probe_, y - 1); v < std::min(end_probe, y + 2); ++v) {
      for (int u = std::max(0, x - 1); u < std::min(image_.width, x + 2); ++u) {
        if (differ(level, probes_[index(u, v)].level)) return false;
      }
    }
    return true;
  }

  void paint_pixel(int x, int y, int end_probe) {
    const Seen seen = options_.oversampling == 1 || is_even(x, y, end_probe) ? probes_[index(x, y)].seen
                                                                             : painter_.pixel(x, y);
    if (options_.keep_radiance) {
      float* const radiance =
          &radiance_[3 * (static_cast<std::size_t>(y) * columns() + static_cast<std::size_t>(x))];
      radiance[0] = seen.light.x, radiance[1] = seen.light.y, radiance[2] = seen.light.z;
    }
    const float open = 1.0f - seen.cover;
    const Vec3f light = options_.transparent
                            ? (seen.cover > 0.0f ? (1.0f / seen.cover) * seen.light : Vec3f{})
                            : seen.light + open * options_.background;
    std::uint16_t* out =
        &image_.pixels[4 * (static_cast<std::size_t>(y) * columns() + static_cast<std::size_t>(x))];
    out[0] = srgb_(light.x), out[1] = srgb_(light.y), out[2] = srgb_(light.z);
    out[3] = options_.transparent ? static_cast<std::uint16_t>(65535.0f * seen.cover + 0.5f) : 65535;
  }

  const Painter& painter_;
  const PreviewOptions& options_;
  RgbaImage16& image_;
  std::vector<float> radiance_;
  SrgbTable srgb_;
  int first_probe_ = 0;
  std::vector<Probe> probes_;
  std::vector<std::uint64_t> shown_;  // for each row, the bits of the views in which a probe met the mesh
};

}  // namespace

Sunlight sun_at_phase(double phase_degrees, double azimuth_degrees) {
  const double phase = phase_degrees * std::numbers::pi / 180.0;
  const double azimuth = azimuth_degrees * std::numbers::pi / 180.0;
  const double s = portable::sin(phase);
  return {{-s * portable::sin(azimuth), s * portable::cos(azimuth), portable::cos(phase)}, false};
}

std::vector<Vec3d> pinhole_places(const TriangleMesh& mesh, const PreviewOptions& options) {
  check_preview_options(options, mesh);
  const RayScene scene(mesh);
  const PreviewRays rays(mesh, options, scene);
  std::vector<Vec3d> places;
  for (std::size_t view = 0; view < options.views.size(); ++view) {
    if (rays.camera(view).is_pinhole) places.push_back(scene.from_unit(rays.camera(view).eye));
  }
  return places;
}

void require_cameras_outside(const TriangleMesh& mesh, const PreviewOptions& options) {
  check_preview_options(options, mesh);
  const RayScene scene(mesh);
  PreviewRays(mesh, options, scene).require_outside(scene);
}

std::vector<Vec3f> linear_colors(const TriangleMesh& mesh) {
  const auto linear = [](std::uint8_t byte) { return static_cast<float>(srgb_to_linear(byte / 255.0)); };
  std::vector<Vec3f> colors;
  colors.reserve(mesh.colors.size());
  for (const VertexColor& c : mesh.colors) colors.push_back({linear(c[0]), linear(c[1]), linear(c[2])});
  return colors;
}

RenderedPicture render_picture(const TriangleMesh& mesh, const PreviewOptions& options,
                               const Progress& progress) {
  check_preview_options(options, mesh);
  const Painter painter(mesh, options);
  RgbaImage16 image{options.width, options.height, {}};
  image.pixels.resize(4 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  BandPainter bands(painter, options, image);
  constexpr int kBand = 64;  // rows between two reports of progress
  for (int first = 0; first < image.height; first += kBand) {
    const int end = std::min(image.height, first + kBand);
    bands.paint(first, end);
    if (!report(progress, double(end) / image.height, "preview")) {
      throw WorkError("preview: stopped before the picture was complete");
    }
  }
  Figure marks = painter.draw_marks(image);
  return {std::move(image), bands.radiance(), bands.empty_views(), std::move(marks)};
}

RgbaImage16 RenderedPicture::marked() && {
  marks.draw_over(image);
  return std::move(image);
}

void write_page(const RenderedPicture& picture, const std::filesystem::path& file) {
  constexpr double kPixels = 2.0;  // in a point
  const double width = picture.image.width, height = picture.image.height;
  Figure page(width, height, Figure::Paper::kNone);
  page.picture({0.0, 0.0, width, height}, picture.image);
  page.add(picture.marks);
  if (file.extension() == ".pdf") return page.write_pdf(file, kPixels);
  page.write_svg(file, kPixels);
}

RgbImage render_preview(const TriangleMesh& mesh, const PreviewOptions& options, const Progress& progress) {
  return opaque_bytes(render_picture(mesh, options, progress).marked());
}

}  // namespace astrolith
