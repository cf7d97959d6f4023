#include "descriptor/surface/surface_statistics.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "descriptor/surface/evened_surface.h"
#include "geometry/mesh_measure.h"
#include "geometry/mesh_topology.h"
#include "geometry/points/point_tree_internal.h"
#include "gravity/vertical_directions.h"
#include "numerics/errors.h"
#include "numerics/portable_angles.h"
#include "numerics/reported_loop.h"
#include "numerics/tangent_frame.h"

namespace astrolith {
namespace {

constexpr std::int64_t kFewestTriangles = 1000, kFewestPoints = 500, kMostPoints = 60000;
constexpr std::int64_t kFewestPlaces = 100, kMostPlaces = 20000;
constexpr std::size_t kFewestNeighbours = 12;  // to fit six coefficients to
constexpr double kLargestRadius = 0.6;         // of the body's; larger discs are no piece of a surface
constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr std::array<double, 4> kRadii{3, 6, 12, 24};              // edges
constexpr std::array<double, 8> kLags{1, 1.5, 2, 3, 4, 6, 8, 12};  // edges

[[noreturn]] void refuse_option(const std::string& words) {
  throw InputError("surface statistics: " + words);
}

void check_range(const char* name, std::int64_t value, std::int64_t least, std::int64_t most) {
  if (value < least || value > most) {
    refuse_option(std::string(name) + ": " + std::to_string(value) + " is outside " + std::to_string(least) +
                  " to " + std::to_string(most));
  }
}

void check_statistics_options(const SurfaceStatisticsOptions& options) {
  if (options.points != 0) check_range("points", options.points, kFewestPoints, kMostPoints);
  check_range("places", options.places, kFewestPlaces, kMostPlaces);
  if (!(options.density > 0.0) || !(options.rotation_hours >= 0.0)) {
    refuse_option("density or rotation period: must be above 0");
  }
}

void check_triangles(const TriangleMesh& mesh) {
  const auto triangles = static_cast<std::int64_t>(mesh.triangles.size());
  if (triangles >= kFewestTriangles) return;
  refuse_option("the mesh has " + std::to_string(triangles) + " triangles; give one of at least " +
                std::to_string(kFewestTriangles));
}

struct PlaceValues {
  bool defined = false;
  std::vector<double> values;  // of each radius, in the order of the quantities
  // Sums of squared differences of height to the place, in squared edges, and numbers of points.
  std::array<double, kLags.size()> squares{}, counts{};
};

// The bin of a distance in edges: distances within the geometric means of neighbouring lags. The number of
// lags where there is none.
std::size_t lag_bin(double squared_distance) {
  for (std::size_t k = 0; k < kLags.size(); ++k) {
    const double low = k > 0 ? kLags[k - 1] * kLags[k] : 0.64 * kLags[0] * kLags[0];
    const double high = k + 1 < kLags.size() ? kLags[k] * kLags[k + 1] : 1.44 * kLags[k] * kLags[k];
    if (squared_distance >= low && squared_distance < high) return k;
  }
  return kLags.size();
}

class PlaceMeasurement {
 public:
  PlaceMeasurement(const EvenedSurface& even, std::span<const double> radii, double lag_radius)
      : even_(even), radii_(radii), lag_radius_(lag_radius), tree_(even.points) {}

  PlaceValues operator()(std::size_t place) const {
    const std::vector<std::pair<std::uint32_t, double>> around = facing_points(place);
    PlaceValues result;
    for (const double radius : radii_) {
      if (!measure(place, radius, around, result)) return {};
    }
    result.defined = true;
    return result;
  }

 private:
  using Neighbours = std::vector<std::pair<std::uint32_t, double>>;

  // The points within the largest radius. Points that look away lie on another side of the body.
  Neighbours facing_points(std::size_t place) const {
    Neighbours around = tree_.within(even_.points[place], radii_.back() * even_.edge);
    std::erase_if(around,
                  [&](const auto& n) { return dot(even_.normals[n.first], even_.normals[place]) <= 0.0; });
    return around;
  }

  SurfaceDisc make_disc(std::size_t place, double length, const Neighbours& around) const {
    Vec3d sum{};
    for (const auto& [j, squared] : around) {
      if (squared <= length * length) sum += even_.normals[j];
    }
    const Vec3d up = normalized(sum);
    const Tangents<double> along = crossed_tangents(up);
    const auto turned = [&](const Vec3d& v) {
      return Vec3d{dot(v, along.first), dot(v, along.second), dot(v, up)};
    };
    SurfaceDisc disc;
    for (const auto& [j, squared] : around) {
      if (squared > length * length) continue;
      disc.heights.push_back(turned(even_.points[j] - even_.points[place]) * (1.0 / length));
      disc.normals.push_back(turned(even_.normals[j]));
    }
    return disc;
  }

  bool measure(std::size_t place, double radius, const Neighbours& around, PlaceValues& result) const {
    SurfaceDisc disc = make_disc(place, radius * even_.edge, around);
    if (disc.heights.size() < kFewestNeighbours) return false;
    const std::optional<LocalQuadric> quadric = fit_quadric(disc.heights);
    if (!quadric) return false;
    disc.quadric = *quadric;
    for (const Vec3d& p : disc.heights) disc.residuals.push_back(p.z - quadric->height(p.x, p.y));
    disc.moments = residual_moments(disc.residuals, kNegligibleResidual);
    for (const SurfaceQuantityTraits& quantity : surface_quantities()) {
      if (quantity.disc_value != nullptr) result.values.push_back(quantity.disc_value(disc));
    }
    if (radius == lag_radius_) add_lags(disc, radius, result);
    return true;
  }

  // Differences between the place, which is the origin, and the points of its disc.
  static void add_lags(const SurfaceDisc& disc, double radius, PlaceValues& result) {
    const double own = -disc.quadric.height(0.0, 0.0);
    for (std::size_t k = 0; k < disc.heights.size(); ++k) {
      const std::size_t bin = lag_bin(squared_norm(disc.heights[k]) * radius * radius);
      if (bin == kLags.size()) continue;
      const double difference = (disc.residuals[k] - own) * radius;
      result.squares[bin] += difference * difference;
      result.counts[bin] += 1.0;
    }
  }

  const EvenedSurface& even_;
  std::span<const double> radii_;
  double lag_radius_;
  PointTree tree_;
};

// The radii that suit the body; a remark names the others.
std::vector<double> suitable_radii(double body_radius, std::vector<std::string>& remarks) {
  std::vector<double> radii;
  for (const double radius : kRadii) {
    if (radius <= kLargestRadius * body_radius) radii.push_back(radius);
  }
  if (radii.empty()) refuse_option("every radius is above .6 of the body's; give more points");
  if (radii.size() < kRadii.size()) {
    remarks.push_back(std::to_string(kRadii.size() - radii.size()) + " of " + std::to_string(kRadii.size()) +
                      " radii are left out, since their discs are as large as the body");
  }
  return radii;
}

// The largest radius that the regions hold, or the smallest of all.
double choose_lag_radius(std::span<const double> radii, double body_radius) {
  double found = radii.front();
  for (const double radius : radii) {
    if (regions_hold(radius, body_radius)) found = radius;
  }
  return found;
}

std::vector<RoughnessAtLag> roughness_at_lags(const std::vector<PlaceValues>& places, double radius,
                                              double edge) {
  std::vector<RoughnessAtLag> lags;
  for (std::size_t k = 0; k < kLags.size() && 2.0 * kLags[k] <= radius; ++k) {
    double squares = 0.0, count = 0.0;
    for (const PlaceValues& place : places) {
      squares += place.squares[k];
      count += place.counts[k];
    }
    if (count > 0.0) lags.push_back({kLags[k], edge * std::sqrt(squares / count)});
  }
  return lags;
}

std::vector<LocalStatistic> columns(const std::vector<PlaceValues>& places, std::span<const double> radii) {
  std::vector<LocalStatistic> statistics;
  for (const double radius : radii) {
    for (std::size_t q = 0; q < surface_quantities().size(); ++q) {
      if (surface_quantities()[q].disc_value == nullptr) continue;
      LocalStatistic statistic{static_cast<SurfaceQuantity>(q), radius, {}};
      for (const PlaceValues& place : places) statistic.values.push_back(place.values[statistics.size()]);
      statistics.push_back(std::move(statistic));
    }
  }
  return statistics;
}

std::vector<double> slopes_at(const TriangleMesh& mesh, std::span<const Vec3d> places,
                              std::span<const Vec3d> normals, const SurfaceStatisticsOptions& options) {
  const std::vector<Vec3d> up =
      vertical_directions_at(mesh, places, {options.density, options.rotation_hours});
  std::vector<double> slopes;
  for (std::size_t i = 0; i < places.size(); ++i) {
    slopes.push_back(kDegrees * portable::atan2(norm(cross(normals[i], up[i])), dot(normals[i], up[i])));
  }
  return slopes;
}

void add_slopes(const TriangleMesh& mesh, std::span<const Vec3d> normals,
                const SurfaceStatisticsOptions& options, SurfaceStatistics& result) {
  if (!analyze_topology(mesh).closed) {
    result.remarks.emplace_back("no slopes: the mesh is open, and gravity needs a closed one");
    return;
  }
  result.local.push_back({SurfaceQuantity::slope, 0.0, slopes_at(mesh, result.places, normals, options)});
}

std::vector<PlaceValues> measured_places(const EvenedSurface& even, std::span<const double> radii,
                                         double lag_radius, std::int64_t places, const Progress& progress) {
  const PlaceMeasurement measure(even, radii, lag_radius);
  std::vector<PlaceValues> found(static_cast<std::size_t>(places));
  reported_parallel_for({0, places, places}, progress, "surface statistics", [&](std::int64_t i) {
    found[static_cast<std::size_t>(i)] = measure(static_cast<std::size_t>(i));
  });
  return found;
}

}  // namespace

const LocalStatistic* SurfaceStatistics::find(SurfaceQuantity quantity, double radius) const {
  for (const LocalStatistic& statistic : local) {
    if (statistic.quantity == quantity && statistic.radius == radius) return &statistic;
  }
  return nullptr;
}

std::int64_t own_points(const TriangleMesh& mesh) {
  return std::clamp(static_cast<std::int64_t>(mesh.triangles.size() / 2), kFewestPoints, kMostPoints);
}

std::int64_t common_points(const TriangleMesh& a, const TriangleMesh& b) {
  return std::min(own_points(a), own_points(b));
}

bool regions_hold(double radius, double body_radius) {
  return kRegions * radius * radius <= 4.0 * body_radius * body_radius;
}

bool body_holds_discs(double radius, double body_radius) {
  constexpr double kDiscs = 100.0;
  return kDiscs * radius * radius <= 4.0 * body_radius * body_radius;
}

SurfaceStatistics surface_statistics(const TriangleMesh& mesh, const SurfaceStatisticsOptions& options,
                                     const Progress& progress) {
  check_statistics_options(options);
  check_triangles(mesh);
  SurfaceStatistics result;
  result.points = options.points > 0 ? options.points : own_points(mesh);
  const EvenedSurface even = even_surface(mesh, result.points, options.seed, progress);
  result.edge = even.edge;
  result.body_radius = std::sqrt(even.area / (4.0 * std::numbers::pi)) / even.edge;
  const std::vector<double> radii = suitable_radii(result.body_radius, result.remarks);
  const double lag_radius = choose_lag_radius(radii, result.body_radius);
  std::vector<PlaceValues> places =
      measured_places(even, radii, lag_radius, std::min(options.places, result.points), progress);

  std::vector<Vec3d> normals;
  LocalStatistic bends{SurfaceQuantity::bend, 0.0, {}};
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!places[i].defined) continue;
    result.places.push_back(even.points[i]);
    normals.push_back(even.normals[i]);
    bends.values.push_back(kDegrees * even.bends[i]);
  }
  result.undefined = static_cast<std::int64_t>(places.size() - result.places.size());
  std::erase_if(places, [](const PlaceValues& place) { return !place.defined; });
  if (places.size() < static_cast<std::size_t>(kFewestPlaces)) {
    refuse_option("the mesh is no surface at fewer than " + std::to_string(kFewestPlaces) +
                  " of its places; give one that is connected");
  }
  result.heights = height_bands(even, at_beginning(progress));
  result.lags = roughness_at_lags(places, lag_radius, even.edge);
  result.local = columns(places, radii);
  result.regions = regional_sums(find_regions(mesh, result.places, options.seed + 2), result.places,
                                 result.local.front().values, even.edge);
  result.local.push_back(std::move(bends));
  add_slopes(mesh, normals, options, result);
  return result;
}

}  // namespace astrolith
