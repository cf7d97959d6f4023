#include "tasks/gravity/landing_sites.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <numeric>

#include "geometry/mesh_measure.h"
#include "geometry/surface/ground_plane.h"
#include "numerics/box_tree.h"
#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "numerics/portable_angles.h"
#include "numerics/vec3_json.h"

namespace astrolith {
namespace {

// A convex polygon with coordinates along right, ahead and up. A triangle that six planes cut has at most 9
// corners; rounding might make more of a sliver, whose last ones are left out.
struct GroundPolygon {
  std::array<Vec3d, 12> corners;
  std::size_t size = 0;

  void add(const Vec3d& p) {
    if (size < corners.size()) corners[size++] = p;
  }
};

// Keeps what lies where sign * axis <= limit (Sutherland and Hodgman 1974).
GroundPolygon cut_by_plane(const GroundPolygon& polygon, double Vec3d::*axis, double sign, double limit) {
  GroundPolygon kept;
  for (std::size_t i = 0; i < polygon.size; ++i) {
    const Vec3d &a = polygon.corners[i], &b = polygon.corners[(i + 1) % polygon.size];
    const double distance_a = limit - sign * (a.*axis), distance_b = limit - sign * (b.*axis);
    if (distance_a >= 0.0) kept.add(a);
    if ((distance_a >= 0.0) != (distance_b >= 0.0))
      kept.add(a + distance_a / (distance_a - distance_b) * (b - a));
  }
  return kept;
}

// One coordinate of a triangle's corners.
struct CornerCoordinate {
  std::array<double, 3> at;
  double least, most;

  CornerCoordinate(const std::array<Vec3d, 3>& triangle, const Vec3d& axis)
      : at{dot(triangle[0], axis), dot(triangle[1], axis), dot(triangle[2], axis)},
        least(std::min({at[0], at[1], at[2]})),
        most(std::max({at[0], at[1], at[2]})) {}
};

// The part of a triangle in a cube of this side and these axes about the origin. Most triangles near a cube
// lie wholly inside or outside: only planes that have a corner beyond them cut.
GroundPolygon cut_to_cube(const std::array<Vec3d, 3>& triangle, const GroundAxes& axes, double side) {
  const double half = 0.5 * side;
  const auto beyond = [half](const CornerCoordinate& c) { return c.least > half || c.most < -half; };
  const CornerCoordinate x(triangle, axes.right);
  if (beyond(x)) return {};
  const CornerCoordinate y(triangle, axes.ahead);
  if (beyond(y)) return {};
  const CornerCoordinate z(triangle, axes.up);
  if (beyond(z)) return {};
  GroundPolygon polygon;
  for (std::size_t k = 0; k < 3; ++k) polygon.add({x.at[k], y.at[k], z.at[k]});
  const auto cut = [&](const CornerCoordinate& c, double Vec3d::*axis) {
    if (c.most > half) polygon = cut_by_plane(polygon, axis, 1.0, half);
    if (c.least < -half) polygon = cut_by_plane(polygon, axis, -1.0, half);
  };
  cut(x, &Vec3d::x), cut(y, &Vec3d::y), cut(z, &Vec3d::z);
  return polygon;
}

// The area times the normal.
Vec3d area_vector(const GroundPolygon& polygon) {
  Vec3d sum;
  for (std::size_t i = 2; i < polygon.size; ++i) {
    sum += cross(polygon.corners[i - 1] - polygon.corners[0], polygon.corners[i] - polygon.corners[0]);
  }
  return 0.5 * sum;
}

// Integrals over the square of products of 1, x, y and the height z.
class HeightSums {
 public:
  // Adds a polygon and returns its area seen from above, negative where the ground faces down. The mean of a
  // quadratic over a triangle is its mean over the middles of the edges.
  double add(const GroundPolygon& polygon) {
    double total = 0.0;
    for (std::size_t i = 2; i < polygon.size; ++i) {
      const Vec3d &a = polygon.corners[0], &b = polygon.corners[i - 1], &c = polygon.corners[i];
      const double area = 0.5 * ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
      for (const Vec3d& p : {0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)}) add(p, area / 3.0);
      total += area;
    }
    return total;
  }
  double area() const { return one_; }

  // The root mean square of z about the plane z = u + v x + w y of least squares; 0 without area.
  double rms_about_plane() const {
    if (!(one_ > 0.0)) return 0.0;
    const double x = x_ / one_, y = y_ / one_, z = z_ / one_;
    const double xx = xx_ / one_ - x * x, xy = xy_ / one_ - x * y, yy = yy_ / one_ - y * y;
    const double xz = xz_ / one_ - x * z, yz = yz_ / one_ - y * z, zz = zz_ / one_ - z * z;
    const double determinant = xx * yy - xy * xy;
    if (!(determinant > 0.0)) return 0.0;
    const double v = (xz * yy - yz * xy) / determinant, w = (yz * xx - xz * xy) / determinant;
    return std::sqrt(std::fmax(zz - v * xz - w * yz, 0.0));
  }

 private:
  void add(const Vec3d& p, double weight) {
    one_ += weight;
    x_ += weight * p.x, y_ += weight * p.y, z_ += weight * p.z;
    xx_ += weight * p.x * p.x, xy_ += weight * p.x * p.y, yy_ += weight * p.y * p.y;
    xz_ += weight * p.x * p.z, yz_ += weight * p.y * p.z, zz_ += weight * p.z * p.z;
  }

  double one_ = 0, x_ = 0, y_ = 0, z_ = 0, xx_ = 0, xy_ = 0, yy_ = 0, xz_ = 0, yz_ = 0, zz_ = 0;
};

constexpr double kDegrees = 180.0 / std::numbers::pi;

void check_side(const TriangleMesh& mesh, double side) {
  constexpr double kFewestEdges = 4.0, kLargest = 0.25;
  const double least = kFewestEdges * mean_edge(mesh), most = kLargest * norm(mesh.bounds().extent());
  if (side < least) {
    throw InputError(
        fmt::format("site_size: {:.4g} is less than 4 edges of the mesh, which are {:.4g}; take larger "
                    "sites or a finer mesh",
                    side, least));
  }
  if (side > most) {
    throw InputError(
        fmt::format("site_size: {:.4g} is more than a quarter of the body, {:.4g}; take less", side, most));
  }
}

class SiteFinder {
 public:
  SiteFinder(const TriangleMesh& mesh, std::span<const double> slopes, double side)
      : mesh_(mesh), slopes_(slopes), side_(side) {
    std::vector<Box> boxes(mesh.triangles.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      for (const std::uint32_t v : mesh.triangles[i]) boxes[i].extend(mesh.vertices[v]);
    }
    tree_ = BoxTree(boxes);
  }

  Vec3d facet_center(std::size_t facet) const {
    const auto& [a, b, c] = mesh_.triangles[facet];
    return (mesh_.vertices[a] + mesh_.vertices[b] + mesh_.vertices[c]) * (1.0 / 3.0);
  }

  // The site about the centre of a facet; its cost is infinite where there is none.
  LandingSite site_at(std::size_t facet) const {
    LandingSite site;
    site.side = side_;
    site.cost = std::numeric_limits<double>::infinity();
    site.center = facet_center(facet);
    const double reach = 0.5 * std::numbers::sqrt3 * side_;
    const Vec3d r{reach, reach, reach};
    const std::vector<std::uint32_t> near = tree_.touching({site.center - r, site.center + r});
    if (!align(near, site)) return site;
    measure(near, site);
    return site;
  }

 private:
  std::array<Vec3d, 3> corners(std::uint32_t facet, const Vec3d& center) const {
    const auto& [a, b, c] = mesh_.triangles[facet];
    return {mesh_.vertices[a] - center, mesh_.vertices[b] - center, mesh_.vertices[c] - center};
  }

  // Turns the site's axes to the mean normal of the ground in their cube, as synth aligns a patch.
  bool align(std::span<const std::uint32_t> near, LandingSite& site) const {
    constexpr int kSteps = 3;
    site.axes = {};
    for (int step = 0; step < kSteps; ++step) {
      Vec3d sum;
      for (const std::uint32_t f : near) {
        sum += area_vector(cut_to_cube(corners(f, site.center), site.axes, side_));
      }
      const Vec3d up = normalized(site.axes.to_frame(sum));
      if (!(norm(up) > 0.5)) return false;
      site.axes = axes_about(up);
    }
    return true;
  }

  void measure(std::span<const std::uint32_t> near, LandingSite& site) const {
    constexpr double kFull = 0.01;  // what the ground may lack of the square, or have twice
    HeightSums heights;
    double covered = 0.0, slopes = 0.0;
    for (const std::uint32_t f : near) {
      const GroundPolygon ground = cut_to_cube(corners(f, site.center), site.axes, side_);
      const double area = heights.add(ground);
      if (area == 0.0) continue;
      covered += std::fabs(area);
      slopes += std::fabs(area) * slopes_[f];
      site.largest_slope = std::max(site.largest_slope, slopes_[f]);
      site.facets.push_back(f);
    }
    const double square = side_ * side_;
    if (std::fabs(covered - square) > kFull * square || heights.area() < (1.0 - kFull) * square) return;
    site.mean_slope = slopes / covered;
    site.roughness = heights.rms_about_plane();
    site.cost = site.mean_slope + kDegrees * site.roughness / (0.5 * side_);
  }

  const TriangleMesh& mesh_;
  std::span<const double> slopes_;
  double side_;
  BoxTree tree_;
};

// The facets of a site, about.
double facets_per_site(const TriangleMesh& mesh, double side) {
  return std::max(1.0, 2.0 * side * side * static_cast<double>(mesh.triangles.size()) / surface_area(mesh));
}

// How many facets lie between two that are tried, so that the search stays within a minute.
std::size_t cut_stride(const TriangleMesh& mesh, double side) {
  constexpr double kMostCuts = 2e7;
  const auto facets = static_cast<double>(mesh.triangles.size());
  return static_cast<std::size_t>(std::ceil(facets * facets_per_site(mesh, side) / kMostCuts));
}

void add_place(LandingSite& site) {
  const Vec3d& p = site.center;
  site.longitude = kDegrees * portable::atan2(p.y, p.x);
  site.latitude = kDegrees * portable::atan2(p.z, std::sqrt(p.x * p.x + p.y * p.y));
}

}  // namespace

std::vector<LandingSite> find_landing_sites(const GravityBody& body, std::span<const double> slopes,
                                            const SiteSearch& search, const Progress& progress) {
  check_side(body.mesh, search.side);
  const SiteFinder finder(body.mesh, slopes, search.side);
  const std::size_t stride = cut_stride(body.mesh, search.side);
  const std::size_t tried = (body.mesh.triangles.size() + stride - 1) / stride;
  std::vector<double> costs(tried);
  constexpr double kCutsAtOnce = 1e5;  // between two reports of progress
  const auto at_once =
      static_cast<std::size_t>(std::max(64.0, kCutsAtOnce / facets_per_site(body.mesh, search.side)));
  for (std::size_t first = 0; first < tried; first += at_once) {
    const std::size_t end = std::min(first + at_once, tried);
    parallel_for(static_cast<std::int64_t>(first), static_cast<std::int64_t>(end), [&](std::int64_t i) {
      const auto at = static_cast<std::size_t>(i);
      costs[at] = finder.site_at(at * stride).cost;
    });
    if (!report(progress, double(end) / double(tried), "sites"))
      throw WorkError("sites: stopped before all places were looked at");
  }
  std::vector<std::size_t> order(tried);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return costs[a] < costs[b]; });
  std::vector<std::size_t> taken;
  std::vector<Vec3d> centers;
  for (const std::size_t i : order) {
    if (static_cast<int>(taken.size()) == search.count || !std::isfinite(costs[i])) break;
    const Vec3d center = finder.facet_center(i * stride);
    const auto too_near = [&](const Vec3d& other) { return norm(other - center) < search.distance; };
    if (std::any_of(centers.begin(), centers.end(), too_near)) continue;
    taken.push_back(i * stride);
    centers.push_back(center);
  }
  std::vector<LandingSite> sites(taken.size());
  parallel_for(0, static_cast<std::int64_t>(taken.size()), [&](std::int64_t i) {
    const auto at = static_cast<std::size_t>(i);
    sites[at] = finder.site_at(taken[at]);
    add_place(sites[at]);
  });
  return sites;
}

std::string patch_words(const LandingSite& site) {
  const Vec3d& p = site.center;
  return fmt::format("{:.9g} {:.9g} {:.9g} {:.9g}", p.x, p.y, p.z, site.side);
}

nlohmann::ordered_json sites_json(std::span<const LandingSite> sites, const GravityBody& body) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const LandingSite& site : sites) {
    list.push_back({{"center", to_json(site.center)},
                    {"normal", to_json(site.axes.up)},
                    {"latitude_deg", site.latitude},
                    {"longitude_deg", site.longitude},
                    {"mean_slope_deg", site.mean_slope},
                    {"largest_slope_deg", site.largest_slope},
                    {"roughness_m", body.metres * site.roughness},
                    {"cost_deg", site.cost},
                    {"patch", patch_words(site)}});
  }
  return list;
}

}  // namespace astrolith
