#include "synthesis/mesh/surface_probes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace astrolith {
namespace {

struct Corners {
  Vec3d a, b, c;
  Vec3d doubled_area() const { return cross(b - a, c - a); }
};

Corners triangle_corners(const TriangleMesh& mesh, const Triangle& triangle) {
  return {mesh.vertices[triangle[0]], mesh.vertices[triangle[1]], mesh.vertices[triangle[2]]};
}

double along(const Vec3d& p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

bool holds(const Box& box, const Vec3d& p) { return boxes_touch(box, {p, p}); }

// A triangle that six planes have cut has at most nine corners.
struct Polygon {
  std::array<Vec3d, 10> corners;
  std::size_t size = 0;
  void add(const Vec3d& p) {
    if (size < corners.size()) corners[size++] = p;
  }
};

// The part of a polygon where sign * (coordinate - limit) >= 0.
Polygon cut(const Polygon& polygon, int axis, double limit, double sign) {
  Polygon part;
  for (std::size_t i = 0; i < polygon.size; ++i) {
    const Vec3d &p = polygon.corners[i], &q = polygon.corners[(i + 1) % polygon.size];
    const double at_p = sign * (along(p, axis) - limit), at_q = sign * (along(q, axis) - limit);
    if (at_p >= 0.0) part.add(p);
    if ((at_p >= 0.0) != (at_q >= 0.0)) part.add(p + (at_p / (at_p - at_q)) * (q - p));
  }
  return part;
}

double polygon_area(const Polygon& polygon) {
  Vec3d doubled;
  for (std::size_t i = 1; i + 1 < polygon.size; ++i) {
    doubled += cross(polygon.corners[i] - polygon.corners[0], polygon.corners[i + 1] - polygon.corners[0]);
  }
  return 0.5 * norm(doubled);
}

// Numbers in [0, 1) that lie evenly for every count of them.
double even(int index, double ratio) {
  const double x = 0.5 + ratio * double(index);
  return x - std::floor(x);
}

}  // namespace

ProbedSurface::ProbedSurface(TriangleMesh mesh, const Box& within) : mesh_(std::move(mesh)) {
  double sum = 0.0;
  std::vector<Box> boxes;
  for (const Triangle& triangle : mesh_.triangles) {
    const Corners t = triangle_corners(mesh_, triangle);
    if (holds(within, (1.0 / 3.0) * (t.a + t.b + t.c))) sum += 0.5 * norm(t.doubled_area());
    areas_.push_back(sum);
    Box& box = boxes.emplace_back();
    for (const Vec3d& p : {t.a, t.b, t.c}) box.extend(p);
  }
  tree_ = BoxTree(boxes);
}

ProbedSurface::Point ProbedSurface::point(int index) const {
  constexpr double kGolden = 0.6180339887498949, kSqrtTwo = 0.4142135623730951,
                   kSqrtThree = 0.7320508075688772;
  const auto found = std::upper_bound(areas_.begin(), areas_.end(), even(index, kGolden) * areas_.back());
  const auto i = static_cast<std::size_t>(std::min(found, areas_.end() - 1) - areas_.begin());
  const Corners t = triangle_corners(mesh_, mesh_.triangles[i]);
  double u = even(index, kSqrtTwo), v = even(index, kSqrtThree);
  if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
  const Vec3d normal = t.doubled_area();
  return {t.a + u * (t.b - t.a) + v * (t.c - t.a), (1.0 / norm(normal)) * normal};
}

double ProbedSurface::largest_share(double height) const {
  constexpr int kBins = 512;
  Box bounds;
  for (const Triangle& t : mesh_.triangles) {
    for (const std::uint32_t corner : t) bounds.extend(mesh_.vertices[corner]);
  }
  if (empty() || !(bounds.extent().z > height)) return 1.0;
  const double bin = bounds.extent().z / kBins;
  const auto bin_at = [&](double z) { return std::clamp(int((z - bounds.min.z) / bin), 0, kBins - 1); };
  std::array<double, kBins> profile{};
  for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
    const Corners t = triangle_corners(mesh_, mesh_.triangles[i]);
    const int first = bin_at(std::min({t.a.z, t.b.z, t.c.z})), last = bin_at(std::max({t.a.z, t.b.z, t.c.z}));
    const double area = areas_[i] - (i > 0 ? areas_[i - 1] : 0.0);
    for (int k = first; k <= last; ++k) profile[static_cast<std::size_t>(k)] += area / (last - first + 1);
  }
  const int width = std::clamp(int(std::ceil(height / bin)), 1, kBins);
  double sum = 0.0, most = 0.0;
  for (int k = 0; k < kBins; ++k) {
    sum += profile[static_cast<std::size_t>(k)];
    if (k >= width) sum -= profile[static_cast<std::size_t>(k - width)];
    most = std::max(most, sum);
  }
  return std::clamp(most / areas_.back(), 0.0, 1.0);
}

double ProbedSurface::area_within(const Box& box) const {
  double area = 0.0;
  for (const std::uint32_t number : tree_.touching(box)) {
    const Corners t = triangle_corners(mesh_, mesh_.triangles[number]);
    Polygon part;
    for (const Vec3d& p : {t.a, t.b, t.c}) part.add(p);
    for (int axis = 0; axis < 3; ++axis) {
      part = cut(part, axis, along(box.min, axis), 1.0);
      part = cut(part, axis, along(box.max, axis), -1.0);
    }
    area += polygon_area(part);
  }
  return area;
}

}  // namespace astrolith
