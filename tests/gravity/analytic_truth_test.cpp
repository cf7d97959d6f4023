// Exact sums beside truths that share nothing with them: the closed form of a cuboid, quadrature over a
// tetrahedron, and balls and ellipsoids as limits of polyhedra.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <numbers>
#include <vector>

#include "gravity/polyhedron_gravity.h"
#include "tests/support/meshes.h"

namespace astrolith {
namespace {

using Long = long double;
using LongVector = Vec3<Long>;
constexpr Long kPi = std::numbers::pi_v<Long>;

struct Truth {
  Long potential = 0;
  LongVector pull;
};

void expect_near(const TriangleMesh& mesh, const Vec3d& p, const Truth& truth, double tolerance) {
  const Attraction value = PolyhedronGravity(mesh).exactly_at(std::vector<Vec3d>{p}).values[0];
  EXPECT_LT(std::fabs(static_cast<double>(value.potential / truth.potential - 1)), tolerance)
      << p.x << " " << p.y << " " << p.z;
  const Vec3d pull{static_cast<double>(truth.pull.x), static_cast<double>(truth.pull.y),
                   static_cast<double>(truth.pull.z)};
  const double size = norm(pull) > 1e-12 ? norm(pull) : 1.0;
  EXPECT_LT(norm(value.acceleration - pull) / size, tolerance) << p.x << " " << p.y << " " << p.z;
}

// log(z + r) without cancellation below zero. s is x^2 + y^2.
Long log_sum(Long z, Long r, Long s) { return z >= 0 ? logl(z + r) : logl(s / (r - z)); }

// factor * log(z + r), zero where the factor is.
Long times_log(Long factor, Long z, Long r, Long s) { return factor == 0 ? 0 : factor * log_sum(z, r, s); }
Long times_atan(Long factor, Long a, Long b) { return factor == 0 ? 0 : factor * atanl(a / b); }

// The potential and its gradient at p of the cuboid [0, sides] (Nagy 1966).
Truth cuboid(const Vec3d& sides, const Vec3d& p) {
  Truth truth;
  for (int corner = 0; corner < 8; ++corner) {
    const Long x = (corner & 1 ? Long(sides.x) : 0) - p.x, y = (corner & 2 ? Long(sides.y) : 0) - p.y,
               z = (corner & 4 ? Long(sides.z) : 0) - p.z;
    const Long sign = (((corner & 1) + (corner >> 1 & 1) + (corner >> 2 & 1)) % 2 == 1) ? 1 : -1;
    const Long r = sqrtl(x * x + y * y + z * z), xx = x * x, yy = y * y, zz = z * z;
    truth.potential += sign * (times_log(x * y, z, r, xx + yy) + times_log(y * z, x, r, yy + zz) +
                               times_log(z * x, y, r, zz + xx) - times_atan(xx / 2, y * z, x * r) -
                               times_atan(yy / 2, z * x, y * r) - times_atan(zz / 2, x * y, z * r));
    truth.pull.x -=
        sign * (times_log(y, z, r, xx + yy) + times_log(z, y, r, zz + xx) - times_atan(x, y * z, x * r));
    truth.pull.y -=
        sign * (times_log(z, x, r, yy + zz) + times_log(x, z, r, xx + yy) - times_atan(y, z * x, y * r));
    truth.pull.z -=
        sign * (times_log(x, y, r, zz + xx) + times_log(y, x, r, yy + zz) - times_atan(z, x * y, z * r));
  }
  return truth;
}

TEST(AnalyticTruth, CuboidInsideOutsideOnEdgesAndAtCorners) {
  const Vec3d sides{1.0, 2.0, 0.5};
  TriangleMesh mesh = testing::cube();
  for (Vec3d& p : mesh.vertices) p = {sides.x * p.x, sides.y * p.y, sides.z * p.z};
  for (const Vec3d& p : {Vec3d{0.3, 0.8, 0.2}, Vec3d{0.5, 1.0, 0.25}, Vec3d{0, 0, 0}, Vec3d{1, 2, 0.5},
                         Vec3d{1, 0, 0.5}, Vec3d{0.4, 0, 0}, Vec3d{1, 1.3, 0.5}, Vec3d{0, 2, 0.2},
                         Vec3d{0.4, 1.1, 0.5}, Vec3d{0, 0.7, 0.1}, Vec3d{0.3, 0.8, 0.500001},
                         Vec3d{-0.7, 0.5, 0.3}, Vec3d{2, 3, -1}, Vec3d{0.5, 1, 12}, Vec3d{3, 0, 0}}) {
    expect_near(mesh, p, cuboid(sides, p), 1e-12);
  }
}

struct Node {
  Long at, weight;  // on [0, 1]
};

// Gauss-Legendre by Newton's method.
std::vector<Node> gauss(int n) {
  std::vector<Node> nodes;
  for (int i = 0; i < n; ++i) {
    Long x = cosl(kPi * (i + 0.75L) / (n + 0.5L)), slope = 1;
    for (int step = 0; step < 20; ++step) {
      Long last = 0, now = 1;
      for (int l = 1; l <= n; ++l) {
        const Long next = ((2 * l - 1) * x * now - (l - 1) * last) / l;
        last = now;
        now = next;
      }
      slope = n * (last - x * now) / (1 - x * x);
      x -= now / slope;
    }
    nodes.push_back({(x + 1) / 2, 1 / ((1 - x * x) * slope * slope)});
  }
  return nodes;
}

LongVector long_vector(const Vec3d& v) { return {v.x, v.y, v.z}; }

// A polyhedron is the signed sum of the tetrahedra of its facets with the point p. With q = s f, f on the
// facet, the integral of 1 / |q| over one is that of s ds times h dA / |f|, smooth unless p lies in the
// facet, where h = 0 and there is no tetrahedron. No logarithm and no angle is needed.
Truth by_quadrature(const TriangleMesh& mesh, const Vec3d& p) {
  const std::vector<Node> rule = gauss(80);
  Truth truth;
  for (const auto& [ia, ib, ic] : mesh.triangles) {
    const LongVector a = long_vector(mesh.vertices[ia] - p),
                     u = long_vector(mesh.vertices[ib] - mesh.vertices[ia]),
                     v = long_vector(mesh.vertices[ic] - mesh.vertices[ia]);
    const Long height_by_area = dot(a, cross(u, v));
    if (std::fabs(static_cast<double>(height_by_area)) < 1e-15) continue;
    for (const Node& i : rule) {
      for (const Node& k : rule) {
        const LongVector f = a + i.at * u + (k.at * (1 - i.at)) * v;
        const Long weight = i.weight * k.weight * (1 - i.at) * height_by_area, r = norm(f);
        truth.potential += weight / r / 2;
        truth.pull += f * (weight / (r * r * r));
      }
    }
  }
  return truth;
}

TEST(AnalyticTruth, TetrahedronByQuadrature) {
  const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0.25, 1.125, 0}, {0.375, 0.25, 0.875}},
                          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}},
                          {}};
  for (const Vec3d& p : {Vec3d{0.4, 0.35, 0.25}, Vec3d{0, 0, 0}, Vec3d{1, 0, 0}, Vec3d{0.25, 1.125, 0},
                         Vec3d{0.375, 0.25, 0.875}, Vec3d{0.5, 0, 0}, Vec3d{0.625, 0.5625, 0},
                         Vec3d{0.4, 0.4, 0}, Vec3d{1, 1, 1}, Vec3d{-0.5, 0.25, 0.25}, Vec3d{0.4, 0.3, -4}}) {
    expect_near(mesh, p, by_quadrature(mesh, p), 1e-12);
  }
}

// The cuboid [0, sides] from outside, as the sum over the points of a rule in its volume: nothing cancels.
Truth cuboid_from_afar(const Vec3d& sides, const Vec3d& p) {
  static const std::vector<Node> rule = gauss(40);
  Truth truth;
  for (const Node& i : rule) {
    for (const Node& j : rule) {
      for (const Node& k : rule) {
        const LongVector f{i.at * sides.x - p.x, j.at * sides.y - p.y, k.at * sides.z - p.z};
        const Long weight = i.weight * j.weight * k.weight * sides.x * sides.y * sides.z, r = norm(f);
        truth.potential += weight / r;
        truth.pull += f * (weight / (r * r * r));
      }
    }
  }
  return truth;
}

double relative_error(const Attraction& value, const Truth& truth) {
  return static_cast<double>(norm(long_vector(value.acceleration) - truth.pull) / norm(truth.pull));
}

struct FarPlaces {
  std::vector<Vec3d> points;
  std::vector<Truth> truths;
};

// From 1.5 to 1e9 radii of the cuboid, in directions without symmetry.
FarPlaces far_places(const Vec3d& sides) {
  FarPlaces places;
  double turn = 0.3;
  for (const double radii : {1.5, 2.5, 4.0, 5.0, 6.0, 9.0, 13.0, 16.0, 20.0, 40.0, 1e3, 1e5, 1e7, 1e9}) {
    const Vec3d direction = normalized(Vec3d{std::cos(turn), std::sin(turn), 0.4 + 0.1 * turn});
    places.points.push_back(0.5 * sides + 0.5 * radii * norm(sides) * direction);
    places.truths.push_back(cuboid_from_afar(sides, places.points.back()));
    turn += 1.0;
  }
  return places;
}

// stated >= true >= stated / 100, alone and beside other places, and nobody's bytes depend on the others'.
void expect_honest(const Vec3d& sides, double tolerance, double most) {
  TriangleMesh mesh = testing::cube();
  for (Vec3d& v : mesh.vertices) v = {sides.x * v.x, sides.y * v.y, sides.z * v.z};
  const PolyhedronGravity gravity(mesh);
  const auto values = [&](const std::vector<Vec3d>& points) {
    return tolerance > 0.0 ? gravity.at(points, tolerance) : gravity.exactly_at(points).values;
  };
  const FarPlaces places = far_places(sides);
  const std::vector<Attraction> together = values(places.points);
  double largest = 0.0;
  for (std::size_t i = 0; i < places.points.size(); ++i) {
    const std::vector<Vec3d> one{places.points[i]};
    const std::vector<Attraction> alone = values(one);
    EXPECT_EQ(std::memcmp(alone.data(), &together[i], sizeof(Attraction)), 0) << i;
    const double error = relative_error(alone[0], places.truths[i]),
                 stated = achieved_error(gravity, one, alone, 100, 1).largest;
    EXPECT_GE(stated, error) << i;
    EXPECT_GE(std::max(error, 1e-15), 0.01 * stated) << i;  // a few round-offs may cancel by luck
    largest = std::max(largest, error);
  }
  const AchievedError stated = achieved_error(gravity, places.points, together, 100, 1);
  EXPECT_EQ(stated.points, static_cast<int>(places.points.size()));
  EXPECT_GE(stated.largest, largest);
  EXPECT_GE(largest, 0.01 * stated.largest);
  EXPECT_LE(largest, most);
}

TEST(AnalyticTruth, FarPlacesStateTheirOwnErrors) {
  for (const Vec3d& sides : {Vec3d{1, 1, 1}, Vec3d{1, 2, 0.5}, Vec3d{3, 1, 0.25}}) {
    expect_honest(sides, 1e-7, 1e-8);
    expect_honest(sides, 0.0, 1e-11);
  }
}

// An octahedron whose faces are divided into n * n triangles and drawn onto the unit ball. The map from a
// face to the ball is smooth, so that errors are a series in even powers of 1 / n.
TriangleMesh octasphere(int n) {
  TriangleMesh mesh;
  for (const double sx : {1.0, -1.0}) {
    for (const double sy : {1.0, -1.0}) {
      for (const double sz : {1.0, -1.0}) {
        const auto vertex = [&](int i, int j) {
          mesh.vertices.push_back(normalized(Vec3d{sx * i, sy * j, sz * (n - i - j)}));
          return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
        };
        const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
          mesh.triangles.push_back(sx * sy * sz > 0 ? Triangle{a, b, c} : Triangle{a, c, b});
        };
        for (int i = 0; i < n; ++i) {
          for (int j = 0; i + j < n; ++j) {
            add(vertex(i + 1, j), vertex(i, j + 1), vertex(i, j));
            if (i + j + 1 < n) add(vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1));
          }
        }
      }
    }
  }
  return mesh;
}

// The limit of a quantity of n for ever finer meshes: the polynomial in 1 / n^2 through all values, at 0
// (Neville).
Truth find_limit(const std::function<Truth(int)>& quantity) {
  const std::vector<int> sizes{8, 12, 16, 24, 32, 48, 64};
  std::vector<Truth> values;
  std::vector<Long> x;
  for (const int n : sizes) {
    values.push_back(quantity(n));
    x.push_back(1 / (Long(n) * n));
  }
  for (std::size_t order = 1; order < values.size(); ++order) {
    for (std::size_t i = 0; i + order < values.size(); ++i) {
      const Long a = x[i] / (x[i] - x[i + order]), b = 1 - a;
      values[i] = {a * values[i + 1].potential + b * values[i].potential,
                   a * values[i + 1].pull + b * values[i].pull};
    }
  }
  return values[0];
}

// Exact sums need no multipoles.
constexpr GravityDetail kNoTree{0, 1u << 20};

Truth ellipsoid_limit(const Vec3d& half, const Vec3d& p) {
  return find_limit([&](int n) {
    TriangleMesh mesh = octasphere(n);
    for (Vec3d& v : mesh.vertices) v = {half.x * v.x, half.y * v.y, half.z * v.z};
    const Attraction at = PolyhedronGravity(mesh, kNoTree).exactly_at(std::vector<Vec3d>{p}).values[0];
    return Truth{at.potential, long_vector(at.acceleration)};
  });
}

void expect_equal(const Truth& value, const Truth& truth, double tolerance) {
  EXPECT_LT(std::fabs(static_cast<double>(value.potential / truth.potential - 1)), tolerance);
  EXPECT_LT(static_cast<double>(norm(value.pull - truth.pull) / norm(truth.pull)), tolerance);
}

TEST(AnalyticTruth, BallAsTheLimitOfPolyhedra) {
  for (const Long r : {0.3L, 0.6L, 1.6L, 4.0L}) {
    const LongVector direction{0.48L, 0.6L, 0.64L}, p = r * direction;
    const Truth truth{r < 1 ? 2 * kPi / 3 * (3 - r * r) : 4 * kPi / 3 / r,
                      direction * (r < 1 ? -4 * kPi / 3 * r : -4 * kPi / 3 / (r * r))};
    expect_equal(ellipsoid_limit({1, 1, 1}, {double(p.x), double(p.y), double(p.z)}), truth, 1e-10);
  }
}

// Potential and pull of a homogeneous ellipsoid inside and outside (MacMillan 1930): integrals over u from
// lambda, the ellipsoid through the point, to infinity. u = lambda + (t / (1 - t))^2 makes them smooth.
Truth ellipsoid_truth(const Vec3d& half, const Vec3d& p) {
  const LongVector square{Long(half.x) * half.x, Long(half.y) * half.y, Long(half.z) * half.z};
  const LongVector point{Long(p.x) * p.x, Long(p.y) * p.y, Long(p.z) * p.z};
  const auto beyond = [&](Long u) {
    return point.x / (square.x + u) + point.y / (square.y + u) + point.z / (square.z + u) - 1;
  };
  Long lambda = 0;
  if (beyond(0) > 0) {
    Long low = 0, high = 1e4L;
    for (int halving = 0; halving < 120; ++halving) {
      lambda = (low + high) / 2;
      (beyond(lambda) > 0 ? low : high) = lambda;
    }
  }
  Truth truth;
  for (const Node& node : gauss(200)) {
    const Long t = node.at, u = lambda + t * t / ((1 - t) * (1 - t));
    const Long step = 2 * t / ((1 - t) * (1 - t) * (1 - t));
    const Long weight = node.weight * step * kPi * half.x * half.y * half.z /
                        sqrtl((square.x + u) * (square.y + u) * (square.z + u));
    truth.potential -= weight * beyond(u);
    truth.pull +=
        LongVector{p.x / (square.x + u), p.y / (square.y + u), p.z / (square.z + u)} * (-2 * weight);
  }
  return truth;
}

TEST(AnalyticTruth, EllipsoidAsTheLimitOfPolyhedra) {
  const Vec3d half{1.5, 1.25, 1.0};
  for (const Vec3d& p :
       {Vec3d{0.2, -0.3, 0.25}, Vec3d{0.5, 0.25, -0.125}, Vec3d{2, 1, 1.5}, Vec3d{-4, 3, 5}}) {
    expect_equal(ellipsoid_limit(half, p), ellipsoid_truth(half, p), 1e-10);
  }
}

}  // namespace
}  // namespace astrolith
