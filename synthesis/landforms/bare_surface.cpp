#include "synthesis/landforms/bare_surface.h"

#include <algorithm>
#include <cmath>

#include "numerics/errors.h"
#include "numerics/interval.h"
#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

constexpr int kMeshCells =
    64;  // cells along the longest side; the mesh's area is within 1e-3 of the surface's
constexpr int kRaySamples = 1024;  // samples along a ray, to find its last crossing

}  // namespace

double BareSurface::longest_side() const { return body_.bounds.longest_side(); }

Vec3d BareSurface::nearer(const Vec3d& p) const {
  const Vec3d g = body_.gradient(p);
  const double steepness = squared_norm(g);
  return steepness > 0.0 ? p - (body_.value(p) / steepness) * g : p;
}

// Where the surface is the cut-off of a kernel, the gradient may be zero.
Vec3d BareSurface::normal(const Vec3d& p) const {
  const Vec3d outwards = normalized(-body_.gradient(p));
  if (squared_norm(outwards) > 0.0) return outwards;
  const Vec3d from_center = normalized(p - body_.bounds.center());
  return squared_norm(from_center) > 0.0 ? from_center : Vec3d{0, 0, 1};
}

Vec3d BareSurface::nearest(const Vec3d& start, const std::string& where) const {
  constexpr int kMaxSteps = 50;
  const double close = 1e-4 * longest_side();
  Vec3d p = start;
  for (int step = 0; step < kMaxSteps; ++step) {
    const Vec3d next = nearer(p);
    const bool arrived = norm(next - p) < 1e-3 * close;
    p = next;
    if (arrived) break;
  }
  if (!(std::fabs(body_.value(p)) < close && norm(p - start) < 2.0 * longest_side())) {
    throw InputError(where + ": no surface of the bare body was found near it; give a point closer to one");
  }
  return p;
}

Vec3d BareSurface::last_crossing(const Vec3d& direction, const std::string& where) const {
  const Vec3d ray = normalized(direction);
  const double reach = 1.01 * std::sqrt(3.0) * largest_coordinate(body_.bounds);
  const auto at = [&](int i) { return (reach * (kRaySamples - i) / kRaySamples) * ray; };  // inwards
  int first = 0;
  while (first <= kRaySamples && !body_.inside(at(first))) ++first;
  if (first == 0 || first > kRaySamples) {
    throw InputError(
        where + ": the ray from the origin along it does not leave the bare body; give a position instead");
  }
  Vec3d in = at(first), out = at(first - 1);
  for (int halving = 0; halving < 40; ++halving) {
    const Vec3d middle = 0.5 * (in + out);
    (body_.inside(middle) ? in : out) = middle;
  }
  return in;
}

Vec3d BareSurface::find(const SurfacePlace& place, const std::string& where) const {
  return place.is_direction ? last_crossing(place.vector, where) : nearest(place.vector, where);
}

void BareSurface::make_mesh() const {
  if (!areas_.empty() || empty()) return;
  mesh_ = body_.meshed_at(kMeshCells);
  double sum = 0.0;
  for (const Triangle& t : mesh_.triangles) {
    const Vec3d a = mesh_.vertices[t[0]], b = mesh_.vertices[t[1]], c = mesh_.vertices[t[2]];
    areas_.push_back(sum += 0.5 * norm(cross(b - a, c - a)));
  }
}

const TriangleMesh& BareSurface::mesh() const {
  make_mesh();
  return mesh_;
}

double BareSurface::area() const {
  make_mesh();
  return areas_.empty() ? 0.0 : areas_.back();
}

Vec3d BareSurface::on_mesh(const Vec3d& random) const {
  const auto found = std::upper_bound(areas_.begin(), areas_.end(), random.x * areas_.back());
  const std::size_t i =
      std::min<std::size_t>(static_cast<std::size_t>(found - areas_.begin()), areas_.size() - 1);
  const Triangle& t = mesh_.triangles[i];
  const double root = std::sqrt(random.y);
  return (1.0 - root) * mesh_.vertices[t[0]] + (root * (1.0 - random.z)) * mesh_.vertices[t[1]] +
         (root * random.z) * mesh_.vertices[t[2]];
}

Vec3d BareSurface::place(const Vec3d& random) const {
  const Vec3d start = on_mesh(random), end = projected(start);
  return norm(end - start) < longest_side() / kMeshCells ? end : start;
}

std::vector<Vec3d> BareSurface::scatter(std::span<const Vec3d> random) const {
  make_mesh();
  std::vector<Vec3d> points(areas_.empty() ? 0 : random.size());
  parallel_for(0, static_cast<std::int64_t>(points.size()), [&](std::int64_t i) {
    const auto k = static_cast<std::size_t>(i);
    points[k] = place(random[k]);
  });
  return points;
}

std::optional<Vec3d> BareSurface::place_beside(const Vec3d& p, double east, double north) const {
  const Vec3d up = normal(p);
  const Vec3d along = std::fabs(up.z) < 0.9 ? Vec3d{0, 0, 1} : Vec3d{1, 0, 0};
  const Vec3d to_east = normalized(cross(along, up)), to_north = cross(up, to_east);
  const Vec3d start = p + east * to_east + north * to_north;
  Vec3d end = start;
  for (int step = 0; step < 4; ++step) end = nearer(end);
  const double moved = norm(end - start), strayed = std::sqrt(east * east + north * north);
  const bool found = std::fabs(body_.value(end)) < 1e-4 * longest_side() && moved <= strayed;
  return found ? std::optional(end) : std::nullopt;
}

}  // namespace astrolith
