#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

#include "geometry/mesh_measure.h"
#include "geometry/mesh_topology.h"
#include "geometry/points/nearest_neighbours.h"
#include "geometry/points/point_tree_internal.h"
#include "geometry/surface/surface_tree.h"
#include "numerics/errors.h"
#include "numerics/jacobi_rotation.h"
#include "numerics/parallel_for.h"
#include "numerics/portable_angles.h"
#include "tasks/repair/cgal_repair_internal.h"
#include "tasks/repair/point_surface_internal.h"

namespace astrolith {
namespace {

constexpr std::size_t kFewestPoints = 16;
// More points than these are joined: those of a small cube count as their mean.
constexpr std::size_t kMostPoints = 100000;
constexpr int kNear = 6;  // neighbours that tell how far points are from one another

struct Cloud {
  std::vector<Vec3d> points, normals;  // normals that the file states, or none
};

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Points in one cube of this side become their mean; points at one place where it is 0.
Cloud joined_in_cubes(const Cloud& cloud, double side) {
  const auto cube = [&](const Vec3d& p) {
    return side > 0.0 ? Vec3d{std::floor(p.x / side), std::floor(p.y / side), std::floor(p.z / side)} : p;
  };
  std::vector<std::size_t> order(cloud.points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const Vec3d p = cube(cloud.points[a]), q = cube(cloud.points[b]);
    return std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z);
  });
  Cloud joined;
  for (std::size_t i = 0; i < order.size();) {
    const Vec3d here = cube(cloud.points[order[i]]);
    Vec3d point, normal;
    double count = 0.0;
    for (; i < order.size() && cube(cloud.points[order[i]]) == here; ++i, ++count) {
      point += cloud.points[order[i]];
      if (!cloud.normals.empty()) normal += cloud.normals[order[i]];
    }
    joined.points.push_back(side > 0.0 ? (1.0 / count) * point : here);
    if (!cloud.normals.empty()) joined.normals.push_back(normal);
  }
  return joined;
}

// Distances to the neighbour of this rank, counted from 1, in rows of kNear.
std::vector<double> distances_to(const std::vector<Vec3d>& points, const std::vector<std::uint32_t>& nearest,
                                 int rank) {
  std::vector<double> distances;
  for (std::size_t i = 0; i < points.size(); ++i)
    distances.push_back(norm(points[nearest[kNear * i + static_cast<std::size_t>(rank) - 1]] - points[i]));
  return distances;
}

// Whether each point belongs to the largest set of points that hang together over short ways.
std::vector<char> largest_set(const std::vector<Vec3d>& points, const std::vector<std::uint32_t>& nearest,
                              double longest) {
  std::vector<std::size_t> root(points.size());
  std::iota(root.begin(), root.end(), std::size_t{0});
  const auto find = [&](std::size_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t k = 0; k < kNear; ++k) {
      const std::size_t j = nearest[kNear * i + k];
      if (norm(points[j] - points[i]) <= longest) root[find(i)] = find(j);
    }
  }
  std::vector<std::size_t> size(points.size(), 0);
  for (std::size_t i = 0; i < points.size(); ++i) ++size[find(i)];
  const auto largest = static_cast<std::size_t>(std::max_element(size.begin(), size.end()) - size.begin());
  std::vector<char> inside(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) inside[i] = find(i) == largest;
  return inside;
}

// Takes out the points that are not kept, unless they are too many to be strays.
void drop_strays(Cloud& cloud, const std::vector<char>& kept, PointSurface& result) {
  constexpr double kMostStrays = 0.05;
  const auto count = std::count(kept.begin(), kept.end(), char{0});
  if (count == 0 || static_cast<double>(count) > kMostStrays * static_cast<double>(kept.size())) return;
  Vec3d middle;
  for (const Vec3d& p : cloud.points) middle += (1.0 / static_cast<double>(kept.size())) * p;
  Cloud rest;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (kept[i] != 0) {
      rest.points.push_back(cloud.points[i]);
      if (!cloud.normals.empty()) rest.normals.push_back(cloud.normals[i]);
    } else if (result.strays++ == 0 || norm(cloud.points[i] - middle) > norm(result.stray - middle)) {
      result.stray = cloud.points[i];
    }
  }
  cloud = std::move(rest);
}

// How far apart the points are, and how far they scatter about the surface.
struct Scatter {
  double spacing = 0.0;  // the square root of the area for each point
  double noise = 0.0;
};

Scatter find_scatter(Cloud& cloud, PointSurface& result) {
  constexpr double kLongestWay = 5.0;  // over the usual distance of the kNear-th neighbour
  const std::vector<std::uint32_t> nearest = nearest_neighbours(cloud.points, kNear);
  const double usual = median(distances_to(cloud.points, nearest, kNear));
  drop_strays(cloud, largest_set(cloud.points, nearest, kLongestWay * usual), result);
  Scatter scatter{usual * std::sqrt(std::numbers::pi / kNear), 0.0};
  // A surface of second degree has six numbers, which take their share of the scatter.
  constexpr int kNeighbours = 24;
  constexpr double kOfNormal = 1.4826;  // standard deviation over the median of distances
  constexpr double kFarthest = 10.0;
  if (cloud.points.size() <= 2 * kNeighbours) return scatter;
  const std::vector<Vec3d> smooth = jet_smoothed(cloud.points, kNeighbours);
  std::vector<double> away;
  for (std::size_t i = 0; i < smooth.size(); ++i) away.push_back(norm(cloud.points[i] - smooth[i]));
  scatter.noise = kOfNormal * median(away) / std::sqrt(1.0 - 6.0 / kNeighbours);
  std::vector<char> kept;
  for (const double d : away) kept.push_back(d <= kFarthest * std::max(scatter.noise, 0.1 * scatter.spacing));
  drop_strays(cloud, kept, result);
  return scatter;
}

// Neighbours over which noise is averaged. Their circle is several times as wide as the noise.
int smoothing_neighbours(const Scatter& scatter, std::size_t points) {
  constexpr double kQuiet = 0.05, kFewest = 40.0, kMost = 240.0, kEach = 80.0;
  const double ratio = scatter.noise / scatter.spacing;
  if (ratio < kQuiet) return 0;
  return static_cast<int>(
      std::min({kFewest + kEach * ratio * ratio, kMost, static_cast<double>(points) / 8.0}));
}

// Unit normals that look outwards. Those that the file states decide between the two sides of the surface.
std::vector<Vec3d> outward_normals(const std::vector<Vec3d>& points, const std::vector<Vec3d>& stated) {
  constexpr int kNeighbours = 18;
  std::vector<Vec3d> normals =
      jet_normals(points, std::min(kNeighbours, static_cast<int>(points.size()) - 1));
  Vec3d middle;
  for (const Vec3d& p : points) middle += (1.0 / static_cast<double>(points.size())) * p;
  double flux = 0.0;  // through the surface, of the field p - middle: three times the volume, if outwards
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!stated.empty() && dot(normals[i], stated[i]) < 0.0) normals[i] = -1.0 * normals[i];
    flux += dot(points[i] - middle, normals[i]);
  }
  if (flux < 0.0) {
    for (Vec3d& n : normals) n = -1.0 * n;
  }
  return normals;
}

// Which triangles no point has seen: those around a place far from points, up to the border of the gap.
std::vector<char> find_gaps(const TriangleMesh& mesh, const PointTree& tree, const std::vector<Vec3d>& points,
                            double far_away, double border) {
  std::vector<double> away(mesh.triangles.size());
  parallel_for(
      0, static_cast<std::int64_t>(away.size()),
      [&](std::int64_t i) {
        const Triangle& t = mesh.triangles[static_cast<std::size_t>(i)];
        const Vec3d middle = (1.0 / 3.0) * (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]);
        away[static_cast<std::size_t>(i)] = norm(points[tree.nearest(middle, 1)[0]] - middle);
      },
      64);
  std::vector<char> gaps(away.size(), 0), reached(mesh.vertices.size(), 0);
  for (bool grows = true; grows;) {
    grows = false;
    for (std::size_t i = 0; i < away.size(); ++i) {
      const Triangle& t = mesh.triangles[i];
      const bool at_gap = reached[t[0]] != 0 || reached[t[1]] != 0 || reached[t[2]] != 0;
      if (gaps[i] != 0 || !(away[i] > far_away || (at_gap && away[i] > border))) continue;
      gaps[i] = reached[t[0]] = reached[t[1]] = reached[t[2]] = 1;
      grows = true;
    }
  }
  return gaps;
}

// Half of 1 - cosine of the greatest angle between a direction and all normals but one in 500: the share of
// the directions within that angle.
double widest_angle(const std::vector<Vec3d>& normals) {
  constexpr int kDirections = 300, kSteps = 180;
  constexpr double kLeftOut = 0.002, kGolden = 2.399963229728653;
  double widest = 0.0;
  for (int k = 0; k < kDirections; ++k) {
    const double z = (2.0 * k + 1.0) / kDirections - 1.0, across = std::sqrt(1.0 - z * z);
    const portable::SineCosine turn =
        portable::sine_and_cosine(std::fmod(kGolden * k, 2.0 * std::numbers::pi));
    const Vec3d direction{across * turn.cosine, across * turn.sine, z};
    std::array<double, kSteps + 1> within{};
    for (const Vec3d& n : normals)
      within[static_cast<std::size_t>(std::clamp(0.5 - 0.5 * dot(n, direction), 0.0, 1.0) * kSteps)] += 1.0;
    double sum = 0.0;
    std::size_t step = 0;
    while (step < kSteps && (sum += within[step]) < kLeftOut * static_cast<double>(normals.size())) ++step;
    widest = std::max(widest, static_cast<double>(step) / kSteps);
  }
  return widest;
}

// The share of the ground that no point has seen, of which only the border of the gap is known. On a sphere,
// a gap has the share that a flat cover of it has of the rest, and also the share of all directions that no
// normal of the rest has. Long bodies have less of the one and more of the other: the mean is taken where a
// wide angle of directions is missing.
double unseen_share(const TriangleMesh& mesh, const std::vector<char>& gaps,
                    const std::vector<Vec3d>& normals) {
  const auto facet = [&](const Triangle& t) {
    return 0.5 * cross(mesh.vertices[t[1]] - mesh.vertices[t[0]], mesh.vertices[t[2]] - mesh.vertices[t[0]]);
  };
  TriangleMesh unseen{mesh.vertices, {}, {}};
  double area = 0.0;
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    if (gaps[i] != 0)
      unseen.triangles.push_back(mesh.triangles[i]);
    else
      area += norm(facet(mesh.triangles[i]));
  }
  if (unseen.triangles.empty()) return 0.0;
  if (area == 0.0) return 1.0;
  const std::vector<std::uint32_t> number = triangle_components(unseen);
  std::vector<Vec3d> covers(number.size());
  for (std::size_t i = 0; i < number.size(); ++i) covers[number[i]] += facet(unseen.triangles[i]);
  double flat = 0.0;
  for (const Vec3d& cover : covers) flat += norm(cover) / area;
  constexpr double kWide = 0.25;  // of all directions: 60 degrees about one
  const double directions = widest_angle(normals);
  return std::min(directions > kWide ? 0.5 * (flat + directions) : flat, 1.0);
}

// How the surface lies to the points.
void judge(PointSurface& result, const std::vector<Vec3d>& points, const std::vector<Vec3d>& normals,
           const Scatter& scatter) {
  const SurfaceTree surface(result.mesh);
  const PointTree tree(points);
  std::vector<double> away(points.size()), ground(result.mesh.vertices.size());
  const auto each = [](std::vector<double>& values, const auto& value) {
    parallel_for(
        0, static_cast<std::int64_t>(values.size()),
        [&](std::int64_t i) { values[static_cast<std::size_t>(i)] = value(static_cast<std::size_t>(i)); },
        64);
  };
  each(away, [&](std::size_t i) { return surface.closest(points[i]).distance; });
  each(ground, [&](std::size_t i) {
    const Vec3d& p = result.mesh.vertices[i];
    return norm(points[tree.nearest(p, 1)[0]] - p);
  });
  double sum = 0.0;
  for (const double d : away) sum += d * d;
  result.noise = std::sqrt(sum / static_cast<double>(away.size()));
  result.farthest_point = *std::max_element(away.begin(), away.end());
  result.farthest_ground = *std::max_element(ground.begin(), ground.end());
  constexpr double kFar = 5.0, kBorder = 1.25;  // spacings
  const double far_away = kFar * std::max(scatter.spacing, scatter.noise);
  result.unseen_share = unseen_share(
      result.mesh, find_gaps(result.mesh, tree, points, far_away, kBorder * scatter.spacing + scatter.noise),
      normals);
}

TriangleMesh moved_outwards(TriangleMesh mesh, const std::vector<Vec3d>& normals, double way) {
  for (std::size_t v = 0; v < normals.size(); ++v) mesh.vertices[v] += way * normals[v];
  return mesh;
}

// Smoothing and facets draw a bent surface to its inner side. Noise that is alike in all directions puts the
// points outside of it on average, by its variance times the mean curvature: the surface moves to where that
// is so. The mean curvature is half the growth of the area, for each area, of a surface that moves outwards.
void settle(TriangleMesh& mesh, const std::vector<Vec3d>& points) {
  const SurfaceTree tree(mesh);
  std::vector<double> outside(points.size());
  parallel_for(
      0, static_cast<std::int64_t>(points.size()),
      [&](std::int64_t i) {
        outside[static_cast<std::size_t>(i)] = -tree.signed_distance(points[static_cast<std::size_t>(i)]);
      },
      64);
  const double mean =
      std::accumulate(outside.begin(), outside.end(), 0.0) / static_cast<double>(points.size());
  double variance = 0.0;
  for (const double d : outside) variance += (d - mean) * (d - mean) / static_cast<double>(points.size());
  const std::vector<Vec3d> normals = vertex_normals(mesh);
  const double step = 1e-4 * mesh.bounds().diagonal();
  const double growth =
      surface_area(moved_outwards(mesh, normals, step)) - surface_area(moved_outwards(mesh, normals, -step));
  const double curvature = growth / (4.0 * step * surface_area(mesh));
  mesh = moved_outwards(std::move(mesh), normals, mean - variance * curvature);
}

// Throws InputError for points in one plane or line, through which no closed surface goes.
void require_solid(const std::vector<Vec3d>& points, const std::string& name) {
  constexpr double kThin = 1e-4;  // the thickness over the extent
  Vec3d mean;
  for (const Vec3d& p : points) mean += (1.0 / static_cast<double>(points.size())) * p;
  Matrix3 covariance{}, axes = kIdentity3;
  for (const Vec3d& p : points) {
    const std::array<double, 3> d{p.x - mean.x, p.y - mean.y, p.z - mean.z};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) covariance[i][j] += d[i] * d[j];
  }
  constexpr int kSweeps = 12;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (const auto& [i, j] : {std::pair<std::size_t, std::size_t>{0, 1}, {0, 2}, {1, 2}})
      rotate_to_diagonal(covariance, axes, i, j);
  }
  const auto [least, most] = std::minmax({covariance[0][0], covariance[1][1], covariance[2][2]});
  if (least > kThin * kThin * most) return;
  throw InputError(name + ": its points lie in one plane or line; a closed surface needs those of all sides");
}

void tell_points(const Progress& progress, double fraction) {
  if (!report(progress, fraction, "points"))
    throw WorkError("stopped while a surface was laid through points");
}

}  // namespace

PointSurface surface_through(const TriangleMesh& points, const std::string& name, const Progress& progress) {
  PointSurface result;
  Cloud cloud{points.vertices, {}};
  if (points.normals.size() == points.vertices.size()) cloud.normals = points.normals;
  cloud = joined_in_cubes(cloud, 0.0);
  if (cloud.points.size() < kFewestPoints)
    throw InputError(name + ": holds " + std::to_string(cloud.points.size()) +
                     " points; a surface needs at least 16");
  require_solid(cloud.points, name);
  Scatter scatter = find_scatter(cloud, result);
  require_solid(cloud.points, name);  // without strays
  const std::vector<Vec3d> whole = cloud.points;
  if (whole.size() > kMostPoints) {
    const double growth =
        std::sqrt(static_cast<double>(cloud.points.size()) / static_cast<double>(kMostPoints));
    cloud = joined_in_cubes(cloud, 1.2 * growth * scatter.spacing);
    scatter = find_scatter(cloud, result);
  }
  result.points = static_cast<std::int64_t>(whole.size());
  tell_points(progress, 0.2);
  const int neighbours = smoothing_neighbours(scatter, cloud.points.size());
  const std::vector<Vec3d> smooth = neighbours > 0 ? jet_smoothed(cloud.points, neighbours) : cloud.points;
  tell_points(progress, 0.4);
  const std::vector<Vec3d> normals = outward_normals(smooth, cloud.normals);
  tell_points(progress, 0.5);
  constexpr double kFacet = 1.5, kError = 0.1;  // spacings
  result.mesh = poisson_surface(smooth, normals, kFacet * scatter.spacing, kError * scatter.spacing, name);
  if (result.mesh.triangles.empty())
    throw InputError(name + ": no closed surface goes through its points; give those of all sides of a body");
  if (volume(result.mesh) < 0.0) {
    for (Triangle& t : result.mesh.triangles) std::swap(t[1], t[2]);
  }
  tell_points(progress, 0.8);
  settle(result.mesh, whole);
  tell_points(progress, 0.9);
  judge(result, whole, normals, scatter);
  return result;
}

}  // namespace astrolith
