#include "synthesis/finish/mascons.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "numerics/portable_double.h"
#include "numerics/scalar_math.h"
#include "synthesis/mesh/processor_clock.h"

namespace astrolith {
namespace {

constexpr int kLatticeCells = 64;           // along the longest side: the volume is right within a percent
constexpr double kGravitation = 6.674e-11;  // m^3 / (kg s^2)
constexpr int kPointsAtOnce = 128;

// The points of one plane of the lattice that lie inside, and the sphere that each belongs to.
struct InnerPoints {
  std::vector<Vec3d> points;
  std::vector<std::size_t> owners;
};

std::size_t nearest_sphere(std::span<const Sphere> spheres, const Vec3d& p) {
  std::size_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const double q = squared_norm(p - spheres[i].center) / (spheres[i].radius * spheres[i].radius);
    if (q < least) least = q, nearest = i;
  }
  return nearest;
}

// A square of points of a plane, numbered from (x, y) on. Its points lie close together, so that it needs few
// impulses at once and may be proved to lie inside or outside.
constexpr int kSquare = 8;
struct Square {
  int x, y, end_x, end_y;
};

// Marks the points of a square that lie inside. Only the sign of the field matters.
void mark_inside(const FieldBlock& plane, const Square& square, std::span<const float> xs,
                 std::span<const float> ys, float z, double step, std::vector<char>& inside) {
  std::vector<float> x, y;
  std::vector<std::size_t> number;
  Box box;
  for (int iy = square.y; iy < square.end_y; ++iy) {
    for (int ix = square.x; ix < square.end_x; ++ix) {
      x.push_back(xs[static_cast<std::size_t>(ix)]);
      y.push_back(ys[static_cast<std::size_t>(iy)]);
      number.push_back(static_cast<std::size_t>(iy) * xs.size() + static_cast<std::size_t>(ix));
      box.extend({x.back(), y.back(), z});
    }
  }
  const FieldBlock block = plane.restricted_to(widened(box, 0.01 * step));
  const BlockContent content = block.content();
  std::vector<float> value(x.size(), content == BlockContent::kInside ? 1.0f : -1.0f);
  if (content == BlockContent::kMixed) block.evaluate(x, y, std::vector<float>(x.size(), z), value, 0.0f);
  for (std::size_t i = 0; i < value.size(); ++i) inside[number[i]] = value[i] > 0.0f ? 1 : 0;
}

std::vector<float> lattice_coordinates(double low, double high, double step) {
  std::vector<float> coordinates;
  for (double at = low + 0.5 * step; at < high; at += step) coordinates.push_back(static_cast<float>(at));
  return coordinates;
}

InnerPoints inner_points(const ImplicitField& field, std::span<const Sphere> spheres, const Box& bounds,
                         double step, int plane) {
  const double z = bounds.min.z + (plane + 0.5) * step;
  const std::vector<float> x = lattice_coordinates(bounds.min.x, bounds.max.x, step),
                           y = lattice_coordinates(bounds.min.y, bounds.max.y, step);
  const int columns = static_cast<int>(x.size()), rows = static_cast<int>(y.size());
  const FieldBlock block =
      field.gather({{bounds.min.x, bounds.min.y, z - step}, {bounds.max.x, bounds.max.y, z + step}});
  std::vector<char> inside(x.size() * y.size(), 0);
  for (int iy = 0; iy < rows; iy += kSquare) {
    for (int ix = 0; ix < columns; ix += kSquare) {
      const Square square{ix, iy, std::min(ix + kSquare, columns), std::min(iy + kSquare, rows)};
      mark_inside(block, square, x, y, static_cast<float>(z), step, inside);
    }
  }
  InnerPoints inner;
  for (std::size_t i = 0; i < inside.size(); ++i) {
    if (inside[i] == 0) continue;
    inner.points.push_back({x[i % x.size()], y[i / x.size()], z});
    inner.owners.push_back(nearest_sphere(spheres, inner.points.back()));
  }
  return inner;
}

// Adds the attraction of one mascon at a batch of points, divided by G times the density.
ASTROLITH_SIMD_CLONES void add_attraction(const Vec3d& center, double radius, int n,
                                          const double* __restrict x, const double* __restrict y,
                                          const double* __restrict z, double* __restrict gx,
                                          double* __restrict gy, double* __restrict gz) {
  const double volume = 4.0 / 3.0 * std::numbers::pi * radius * radius * radius,
               radius_squared = radius * radius;
  const double cx = center.x, cy = center.y, cz = center.z;
#pragma omp simd
  for (int i = 0; i < n; ++i) {
    const double dx = cx - x[i], dy = cy - y[i], dz = cz - z[i];
    const double d2 = dx * dx + (dy * dy + dz * dz);
    // Inside the ball its pull grows in proportion to the distance from the centre.
    const double r2 = d2 > radius_squared ? d2 : radius_squared;
    const double pull = volume / (r2 * __builtin_sqrt(r2));
    gx[i] += pull * dx;
    gy[i] += pull * dy;
    gz[i] += pull * dz;
  }
}

Vec3d center_of_mass(std::span<const Mascon> mascons) {
  Vec3d sum;
  double weight = 0.0;
  for (const Mascon& m : mascons) {
    const double volume = m.radius * m.radius * m.radius;
    sum += volume * m.center;
    weight += volume;
  }
  return sum * (1.0 / weight);
}

}  // namespace

std::vector<Mascon> mascons_of(const ImplicitField& field, std::span<const Sphere> spheres) {
  const Box bounds = field.bounds();
  const Vec3d extent = bounds.extent();
  const double step = std::max({extent.x, extent.y, extent.z}) / kLatticeCells;
  std::vector<InnerPoints> planes(static_cast<std::size_t>(std::ceil(extent.z / step)));
  parallel_for(0, static_cast<std::int64_t>(planes.size()), [&](std::int64_t i) {
    planes[static_cast<std::size_t>(i)] = inner_points(field, spheres, bounds, step, static_cast<int>(i));
  });
  std::vector<Vec3d> sums(spheres.size());
  std::vector<double> counts(spheres.size());
  for (const InnerPoints& plane : planes) {
    for (std::size_t i = 0; i < plane.points.size(); ++i) {
      sums[plane.owners[i]] += plane.points[i];
      counts[plane.owners[i]] += 1.0;
    }
  }
  std::vector<Mascon> mascons;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    if (counts[i] == 0.0) continue;
    const double volume = counts[i] * step * step * step;
    mascons.push_back({sums[i] * (1.0 / counts[i]), portable::cbrt(volume * 0.75 / std::numbers::pi)});
  }
  if (mascons.empty()) throw InputError("gravity: the body is too thin to find its mass; check its spheres");
  return mascons;
}

double seconds_of_mascons(const ImplicitField& field, std::span<const Sphere> spheres) {
  const Box bounds = field.bounds();
  const Vec3d extent = bounds.extent();
  const double step = std::max({extent.x, extent.y, extent.z}) / kLatticeCells;
  const double planes = std::ceil(extent.z / step);
  const ProcessorClock clock;
  for (const double at : {0.35, 0.65})
    inner_points(field, spheres, bounds, step, static_cast<int>(at * planes));
  return 0.5 * planes * clock.seconds();
}

std::vector<Vec3d> vertical_directions(std::span<const Mascon> mascons, const BodyMotion& motion,
                                       std::span<const Vec3d> points) {
  // The centrifugal acceleration at unit distance from the axis, divided by G times the density.
  const double turn =
      motion.rotation_hours > 0.0 ? 2.0 * std::numbers::pi / (3600.0 * motion.rotation_hours) : 0.0;
  const double spin = turn * turn / (kGravitation * motion.density);
  const Vec3d center = center_of_mass(mascons);
  std::vector<Vec3d> up(points.size());
  const auto batches = static_cast<std::int64_t>((points.size() + kPointsAtOnce - 1) / kPointsAtOnce);
  parallel_for(0, batches, [&](std::int64_t batch) {
    const std::size_t begin = static_cast<std::size_t>(batch) * kPointsAtOnce;
    const std::size_t n = std::min<std::size_t>(kPointsAtOnce, points.size() - begin);
    std::array<double, kPointsAtOnce> x{}, y{}, z{}, gx{}, gy{}, gz{};
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3d& p = points[begin + i];
      x[i] = p.x, y[i] = p.y, z[i] = p.z;
      gx[i] = spin * (p.x - center.x);
      gy[i] = spin * (p.y - center.y);
    }
    for (const Mascon& m : mascons) {
      add_attraction(m.center, m.radius, static_cast<int>(n), x.data(), y.data(), z.data(), gx.data(),
                     gy.data(), gz.data());
    }
    for (std::size_t i = 0; i < n; ++i) up[begin + i] = normalized(Vec3d{-gx[i], -gy[i], -gz[i]});
  });
  return up;
}

}  // namespace astrolith
