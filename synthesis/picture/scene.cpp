#include "synthesis/picture/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "geometry/mesh_measure.h"
#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "numerics/portable_angles.h"
#include "numerics/reported_loop.h"
#include "synthesis/picture/ray_scene.h"

namespace astrolith {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();
constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
constexpr double kPerRadian = 180.0 / std::numbers::pi;
// How far single precision may be from the truth in the unit ball: shadows are sought from above that, and
// triangles around a hit that near are looked at.
constexpr double kAboveGround = 2e-6;
constexpr float kAroundHit = 1e-5f;
constexpr double kLeastEmission = 1e-3;  // cosine

// The angle of a cosine within 2e-8 (Abramowitz and Stegun 4.4.46): a tenth of what single precision
// resolves.
double radians_by_cosine(double cosine) {
  const double x = std::min(std::fabs(cosine), 1.0);
  double p = -0.0012624911;
  for (const double c : {0.0066700901, -0.0170881256, 0.0308918810, -0.0501743046, 0.0889789874,
                         -0.2145988016, 1.5707963050}) {
    p = p * x + c;
  }
  const double angle = std::sqrt(1.0 - x) * p;
  return cosine < 0.0 ? std::numbers::pi - angle : angle;
}

float degrees_by_cosine(double cosine) { return static_cast<float>(kPerRadian * radians_by_cosine(cosine)); }

// Where a ray meets the plane of a triangle, with the weights u and v of its second and third corner.
struct OnTriangle {
  double length = 0, u = 0, v = 0;
  bool is_inside() const {
    constexpr double kTolerance = 1e-12;
    return u >= -kTolerance && v >= -kTolerance && u + v <= 1 + kTolerance;
  }
};

// Moeller and Trumbore 1997, in double precision. None where the ray lies in the plane.
std::optional<OnTriangle> meet_triangle(const TriangleMesh& mesh, std::uint32_t triangle, const Vec3d& origin,
                                        const Vec3d& direction) {
  const auto [i, j, k] = mesh.triangles[triangle];
  const Vec3d a = mesh.vertices[i], ab = mesh.vertices[j] - a, ac = mesh.vertices[k] - a;
  const Vec3d p = cross(direction, ac), from = origin - a, q = cross(from, ab);
  const double volume = dot(ab, p);
  if (volume == 0.0) return std::nullopt;
  return OnTriangle{dot(ac, q) / volume, dot(from, p) / volume, dot(direction, q) / volume};
}

// How far a ray of the unit ball's axes goes before it comes near the ball; none where it passes it by.
std::optional<double> way_to_ball(const Vec3d& origin, const Vec3d& direction) {
  constexpr double kWide = 1.00001, kBefore = 1.01;
  const double along = dot(origin, direction);
  if (squared_norm(origin - along * direction) > kWide) return std::nullopt;
  if (along > 0 && squared_norm(origin) > kWide) return std::nullopt;
  return std::max(0.0, -along - kBefore);
}

Vec3d mean_of_corners(const std::vector<Vec3d>& values, const Triangle& t, double u, double v) {
  return (1 - u - v) * values[t[0]] + u * values[t[1]] + v * values[t[2]];
}

// Vectors from the middle of a beam to its rays, for a middle of unit length: 19 that cover the beam
// evenly (Vogel 1979), and the first of which is 0.
std::vector<Vec3d> spread_beam(const Vec3d& middle, double beam) {
  constexpr int kRays = 19;
  constexpr double kGoldenAngle = 2.399963229728653;
  std::vector<Vec3d> rays(1);
  const Vec3d axis = std::fabs(middle.x) < 0.5 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  const Vec3d right = normalized(cross(middle, axis)), up = cross(middle, right);
  const double tangent = portable::tan(0.5 * beam / kPerRadian);
  for (int k = 1; k < kRays; ++k) {
    const double radius = tangent * std::sqrt((k + 0.5) / kRays);
    const auto [s, c] = portable::sine_and_cosine(kGoldenAngle * k);
    rays.push_back(radius * (c * right + s * up));
  }
  return rays;
}

}  // namespace

SceneCamera in_axes_of_body(const SceneCamera& camera, const BodyPose& pose) {
  Matrix3 axes;
  std::size_t row = 0;
  for (const Vec3d& axis : {camera.right(), camera.down(), camera.boresight()}) {
    const Vec3d v = rotate_back(pose.rotation, axis);
    axes[row++] = {v.x, v.y, v.z};
  }
  return {camera.calibration(), rotate_back(pose.rotation, camera.position() - pose.position), axes};
}

struct Scene::Body {
  Body(const TriangleMesh& given, const std::vector<float>& given_albedo)
      : mesh(given),
        tree(mesh),
        normals(mesh.normals.size() == mesh.vertices.size() ? mesh.normals : vertex_normals(mesh)),
        albedo(given_albedo) {
    mesh.normals.clear();
    mesh.colors.clear();
  }

  // The first triangle that a ray in the body's axes meets, and how far away.
  std::optional<std::pair<std::uint32_t, OnTriangle>> first_hit(const Vec3d& origin,
                                                                const Vec3d& direction) const {
    const Vec3d in_ball = tree.to_unit(origin);
    const std::optional<double> before = way_to_ball(in_ball, direction);
    if (!before) return std::nullopt;
    const Vec3f start = to_float(in_ball + *before * direction), along = to_float(direction);
    const RayHit hit = tree.first_hit(start, along);
    if (!hit.found) return std::nullopt;
    const double skipped = *before / tree.scale();
    std::pair<std::uint32_t, OnTriangle> met =
        refined(hit, origin + skipped * direction, direction, start + hit.distance * along);
    met.second.length += skipped;
    return met;
  }

  bool shades(const Vec3d& origin, const Vec3d& towards_sun) const {
    const Vec3d in_ball = tree.to_unit(origin);
    const std::optional<double> before = way_to_ball(in_ball, towards_sun);
    return before && tree.occluded(to_float(in_ball + *before * towards_sun), to_float(towards_sun));
  }

  double albedo_at(const Triangle& t, double u, double v) const {
    return (1 - u - v) * albedo[t[0]] + u * albedo[t[1]] + v * albedo[t[2]];
  }

  TriangleMesh mesh;  // without normals and colours
  RayScene tree;
  std::vector<Vec3d> normals;  // (#V)
  std::vector<float> albedo;   // (#V), or empty

 private:
  // The hit in double precision. Near an edge single precision may have found the neighbour of the triangle
  // that is met.
  std::pair<std::uint32_t, OnTriangle> refined(const RayHit& hit, const Vec3d& origin, const Vec3d& direction,
                                               const Vec3f& place) const {
    const std::optional<OnTriangle> found = meet_triangle(mesh, hit.triangle, origin, direction);
    if (found && found->is_inside()) return {hit.triangle, *found};
    std::pair<std::uint32_t, OnTriangle> best{hit.triangle, {kNone, hit.u, hit.v}};
    tree.visit_near(place, kAroundHit, [&](std::uint32_t triangle) {
      const std::optional<OnTriangle> other = meet_triangle(mesh, triangle, origin, direction);
      if (!other || !other->is_inside() || !(other->length >= 0)) return;
      if (std::pair(other->length, triangle) < std::pair(best.second.length, best.first))
        best = {triangle, *other};
    });
    if (best.second.length == kNone) best.second.length = double{hit.distance} / tree.scale();
    return best;
  }
};

struct Scene::Hit {
  double range = kNone;
  std::size_t body = 0;
  std::uint32_t facet = 0;
  double u = 0, v = 0;
  bool found() const { return range < kNone; }
};

Scene::Placed& Scene::placed(std::size_t body) {
  if (body >= bodies_.size()) {
    throw InputError(
        fmt::format("pose: there is no body {}; the scene has {}, from 0", body, bodies_.size()));
  }
  return bodies_[body];
}

std::size_t Scene::add(const TriangleMesh& mesh, const std::vector<float>& albedo) {
  constexpr std::size_t kMostBodies = 1000;
  if (bodies_.size() == kMostBodies)
    throw InputError(fmt::format("scene: holds at most {} bodies", kMostBodies));
  if (!albedo.empty() && albedo.size() != mesh.vertices.size()) {
    throw InputError(fmt::format("scene: {} albedos for {} vertices; give one a vertex, or none",
                                 albedo.size(), mesh.vertices.size()));
  }
  for (const float a : albedo) {
    if (!(a >= 0 && a <= 10))
      throw InputError(fmt::format("scene: an albedo of {:g}; it must be 0 to 10", a));
  }
  bodies_.push_back({std::make_shared<const Body>(mesh, albedo), {}});
  return bodies_.size() - 1;
}

void Scene::replace(std::size_t body, const Scene& other, std::size_t of_other) {
  placed(body).body = other.bodies_.at(of_other).body;
}

void Scene::place(std::size_t body, const BodyPose& pose) {
  Placed& moved = placed(body);
  if (!std::isfinite(squared_norm(pose.position))) throw InputError("pose: the position is not finite");
  moved.pose = {checked_rotation("pose: rotation", pose.rotation), pose.position};
}

Scene::Hit Scene::first_hit(const Vec3d& origin, const Vec3d& direction) const {
  Hit first;
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    const auto& [body, pose] = bodies_[k];
    const auto met = body->first_hit(rotate_back(pose.rotation, origin - pose.position),
                                     rotate_back(pose.rotation, direction));
    if (!met || !(met->second.length < first.range)) continue;
    first = {met->second.length, k, met->first, met->second.u, met->second.v};
  }
  return first;
}

// The point lies on a facet of the hit, from which `lift` leads away.
bool Scene::sees_sun(const Hit& hit, const Vec3d& point, const Vec3d& lift, const Vec3d& sun) const {
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    const auto& [body, pose] = bodies_[k];
    const Vec3d start = k == hit.body ? point + lift : point;
    if (body->shades(rotate_back(pose.rotation, start - pose.position), rotate_back(pose.rotation, sun))) {
      return false;
    }
  }
  return true;
}

// A camera is inside a body, or below open ground, where the first facet of it before the camera is seen from
// behind.
void Scene::require_outside(const SceneCamera& camera) const {
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    const auto& [body, pose] = bodies_[k];
    const Vec3d along = rotate_back(pose.rotation, camera.boresight());
    const auto met = body->first_hit(rotate_back(pose.rotation, camera.position() - pose.position), along);
    if (!met || dot(triangle_normal(body->mesh, body->mesh.triangles[met->first]), along) <= 0) continue;
    throw InputError(fmt::format("camera: it stands inside body {} or below its ground; move it outside", k));
  }
}

// What the pixels of one picture show.
class ScenePixels {
 public:
  ScenePixels(const Scene& scene, const SceneCamera& camera, const Vec3d& sun,
              const SceneImageOptions& options)
      : scene_(scene),
        camera_(camera),
        sun_(normalized(sun)),
        options_(options),
        from_above_(reflectance_at(options.reflectance, 1.0, 1.0, 0.0)) {}

  void fill(std::size_t i, const ImagePoint& middle, SceneImage& image) const {
    const Vec3d direction = camera_.direction(middle);
    const Scene::Hit hit = scene_.first_hit(camera_.position(), direction);
    const Ground ground = hit.found() ? look_at_ground(hit, direction) : Ground{};
    image.radiance[i] = options_.oversampling == 1 ? radiance(ground) : mean_radiance(middle);
    if (!hit.found()) return;
    image.depth[i] = hit.range * dot(direction, camera_.boresight());
    image.normal[i] = to_float(ground.normal);
    image.facet[i] = static_cast<std::int32_t>(hit.facet);
    image.body[i] = static_cast<std::int16_t>(hit.body);
    image.incidence[i] = degrees_by_cosine(ground.m0);
    image.emission[i] = degrees_by_cosine(ground.m);
    image.phase[i] = static_cast<float>(kPerRadian * ground.phase);
  }

 private:
  struct Ground {
    Vec3d normal;
    double m0 = 0, m = 0, phase = 0;  // cosines of incidence and emission; radians
    double albedo = 0;                // over the value of the law of reflection seen and lit from above
    bool is_lit = false;
  };

  Ground look_at_ground(const Scene::Hit& hit, const Vec3d& direction) const {
    const auto& [body, pose] = scene_.bodies_[hit.body];
    const Triangle& t = body->mesh.triangles[hit.facet];
    Vec3d face = triangle_normal(body->mesh, t), normal = face;
    const bool is_behind = dot(face, rotate_back(pose.rotation, direction)) > 0;
    if (is_behind) face = -face;
    if (options_.smooth) normal = normalized(mean_of_corners(body->normals, t, hit.u, hit.v));
    if (dot(normal, face) < 0) normal = -normal;
    if (squared_norm(normal) < 0.5) normal = face;

    Ground ground;
    ground.normal = rotate(pose.rotation, normal);
    ground.m0 = dot(ground.normal, sun_);
    ground.m = -dot(ground.normal, direction);
    ground.phase = radians_by_cosine(-dot(direction, sun_));
    if (!(ground.m0 > 0)) return ground;
    ground.albedo = body->albedo.empty() ? 1.0 : body->albedo_at(t, hit.u, hit.v) / from_above_;
    const Vec3d lift = rotate(pose.rotation, find_lift(*body, hit, t, face));
    ground.is_lit = scene_.sees_sun(hit, camera_.position() + hit.range * direction, lift, sun_);
    return ground;
  }

  // Rays to the sun start a little above the ground; with smooth normals above the planes across the normals
  // of the corners, so that facets near the terminator do not shade their neighbours (Hanika 2021).
  Vec3d find_lift(const Scene::Body& body, const Scene::Hit& hit, const Triangle& t,
                  const Vec3d& face) const {
    Vec3d lift = kAboveGround / body.tree.scale() * face;
    if (!options_.smooth) return lift;
    const Vec3d point = mean_of_corners(body.mesh.vertices, t, hit.u, hit.v);
    const double weights[] = {1 - hit.u - hit.v, hit.u, hit.v};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d& normal = body.normals[t[k]];
      if (dot(normal, face) <= 0) continue;
      const double below = dot(point - body.mesh.vertices[t[k]], normal);
      if (below < 0) lift -= weights[k] * below * normal;
    }
    return lift;
  }

  float radiance(const Ground& ground) const {
    if (!ground.is_lit) return 0.0f;
    const double m = std::max(ground.m, kLeastEmission);
    return static_cast<float>(ground.albedo *
                              reflectance_at(options_.reflectance, ground.m0, m, ground.phase));
  }

  float mean_radiance(const ImagePoint& middle) const {
    const int n = options_.oversampling;
    double sum = 0;
    for (int k = 0; k < n * n; ++k) {
      const int column = k % n, row = k / n;
      const double across = (column + 0.5) / n - 0.5, down = (row + 0.5) / n - 0.5;
      const Vec3d direction = camera_.direction({middle.column + across, middle.row + down});
      const Scene::Hit hit = scene_.first_hit(camera_.position(), direction);
      if (hit.found()) sum += double{radiance(look_at_ground(hit, direction))};
    }
    return static_cast<float>(sum / (n * n));
  }

  const Scene& scene_;
  const SceneCamera& camera_;
  Vec3d sun_;
  const SceneImageOptions& options_;
  double from_above_;  // the law's value
};

SceneImage Scene::image(const SceneCamera& camera, const Vec3d& sun, const SceneImageOptions& options,
                        const Progress& progress) const {
  if (!(squared_norm(sun) > 0) || !std::isfinite(squared_norm(sun))) {
    throw InputError("sun: 0 0 0 is no direction; give the direction from the body to the sun");
  }
  if (options.oversampling < 1 || options.oversampling > 16) {
    throw InputError(fmt::format("oversampling: {} is outside 1 to 16", options.oversampling));
  }
  if (!(reflectance_at(options.reflectance, 1.0, 1.0, 0.0) > 0)) {
    throw InputError(
        "reflectance: the law is 0 for ground that is seen and lit from above; give other numbers");
  }
  require_outside(camera);
  constexpr int kTile = 32;  // pixels; neighbours meet the same parts of the trees
  const int width = camera.calibration().width, height = camera.calibration().height;
  const int columns = (width + kTile - 1) / kTile, rows = (height + kTile - 1) / kTile;
  const std::size_t n = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  SceneImage image{std::vector<float>(n, 0.0f),
                   std::vector<double>(n, std::numeric_limits<double>::quiet_NaN()),
                   std::vector<Vec3f>(n, Vec3f{kUnknown, kUnknown, kUnknown}),
                   std::vector<std::int32_t>(n, -1),
                   std::vector<std::int16_t>(n, -1),
                   std::vector<float>(n, kUnknown),
                   std::vector<float>(n, kUnknown),
                   std::vector<float>(n, kUnknown)};
  const ScenePixels pixels(*this, camera, sun, options);
  const std::int64_t tiles = std::int64_t{columns} * rows;
  reported_parallel_for({0, tiles, tiles}, progress, "image", [&](std::int64_t tile) {
    const int left = static_cast<int>(tile % columns) * kTile, top = static_cast<int>(tile / columns) * kTile;
    for (int y = top; y < std::min(height, top + kTile); ++y) {
      for (int x = left; x < std::min(width, left + kTile); ++x) {
        const std::size_t i =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
        pixels.fill(i, {double(x), double(y)}, image);
      }
    }
  });
  return image;
}

void Scene::measure(std::size_t i, const Vec3d& origin, const Vec3d& towards, const RangeOptions& options,
                    SceneRanges& made) const {
  const Vec3d middle = normalized(towards);
  double sum = 0;
  int met = 0;
  const auto meet = [&](const Vec3d& direction) {
    const Hit hit = first_hit(origin, direction);
    if (!hit.found()) return;
    sum += hit.range;
    if (++met > 1) return;
    const auto& [body, pose] = bodies_[hit.body];
    const Vec3d facet = triangle_normal(body->mesh, body->mesh.triangles[hit.facet]);
    made.incidence[i] = degrees_by_cosine(-dot(facet, rotate_back(pose.rotation, direction)));
    made.facet[i] = static_cast<std::int32_t>(hit.facet);
    made.body[i] = static_cast<std::int16_t>(hit.body);
  };
  if (options.beam > 0) {
    for (const Vec3d& offset : spread_beam(middle, options.beam)) meet(normalized(middle + offset));
  } else {
    meet(middle);
  }
  if (met == 0) return;
  made.range[i] = sum / met;
  if (options.noise > 0) made.range[i] += options.noise * CounterRandom(options.seed, i).normal();
}

SceneRanges Scene::ranges(std::span<const Vec3d> origins, std::span<const Vec3d> directions,
                          const RangeOptions& options, const Progress& progress) const {
  if (origins.size() != directions.size() && origins.size() != 1) {
    throw InputError(
        fmt::format("ranges: {} origins and {} directions; give one origin, or one for each direction",
                    origins.size(), directions.size()));
  }
  if (!(options.noise >= 0 && options.noise <= 1e18) || !(options.beam >= 0 && options.beam <= 10)) {
    throw InputError("ranges: noise must be at least 0, and a beam 0 to 10 degrees across");
  }
  for (std::size_t i = 0; i < directions.size(); ++i) {
    if (squared_norm(directions[i]) > 0) continue;
    throw InputError(fmt::format("directions: row {} is 0 0 0, which is no direction; give another", i));
  }
  const std::size_t n = directions.size();
  SceneRanges made{std::vector<double>(n, std::numeric_limits<double>::quiet_NaN()),
                   std::vector<float>(n, kUnknown), std::vector<std::int32_t>(n, -1),
                   std::vector<std::int16_t>(n, -1)};
  constexpr std::int64_t kChunk = 1024;
  const std::int64_t chunks = (static_cast<std::int64_t>(n) + kChunk - 1) / kChunk;
  reported_parallel_for({0, chunks, chunks}, progress, "ranges", [&](std::int64_t chunk) {
    const std::size_t begin = static_cast<std::size_t>(chunk * kChunk);
    for (std::size_t i = begin; i < std::min(n, begin + kChunk); ++i) {
      measure(i, origins[origins.size() == 1 ? 0 : i], directions[i], options, made);
    }
  });
  return made;
}

}  // namespace astrolith
