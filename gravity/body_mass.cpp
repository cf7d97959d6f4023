#include "gravity/body_mass.h"

#include <algorithm>
#include <cmath>

#include "gravity/solid_harmonics.h"
#include "numerics/reported_loop.h"

namespace astrolith {
namespace {

std::array<double, 3> components(const Vec3d& v) { return {v.x, v.y, v.z}; }

// Sums of y y^T over tetrahedra become the inertia tensor of their union.
Matrix3 inertia_tensor(const Matrix3& second) {
  const double trace = second[0][0] + second[1][1] + second[2][2];
  Matrix3 inertia{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) inertia[i][j] = (i == j ? trace : 0.0) - second[i][j];
  }
  return inertia;
}

// Sums of R_lm without the sign of Condon and Shortley, l <= degree, at the index l (l + 1) / 2 + m.
struct RegularSums {
  explicit RegularSums(int n) : degree(n), values(count(n)) {}
  static std::size_t count(int n) { return static_cast<std::size_t>((n + 1) * (n + 2) / 2); }
  static std::size_t place(int l, int m) { return static_cast<std::size_t>(l * (l + 1) / 2 + m); }

  void add(const Vec3d& y, double weight) {
    HarmonicValue diagonal{weight, 0.0};
    for (int m = 0; m <= degree; ++m) {
      if (m > 0) {
        const HarmonicValue turned = HarmonicValue{y.x, y.y} * diagonal;
        diagonal = {0.5 / m * turned.re, 0.5 / m * turned.im};
      }
      visit_harmonics(y, m, degree, diagonal,
                      [&](int l, const HarmonicValue& value) { values[place(l, m)] += value; });
    }
  }

  int degree;
  std::vector<HarmonicValue> values;
};

// The integral of a homogeneous polynomial of degree l over the tetrahedron of a facet and the origin is that
// over the facet times height / (l + 3).
void add_facet(const Vec3d& a, const Vec3d& b, const Vec3d& c, std::span<const TrianglePoint> rule,
               RegularSums& sums) {
  const double twice_area_by_height = dot(a, cross(b - a, c - a));
  for (const TrianglePoint& t : rule) {
    sums.add(a + t.b * (b - a) + t.c * (c - a), 0.5 * twice_area_by_height * t.weight);
  }
}

// Facets of one task: as many as take some milliseconds, since the program stops between tasks only.
std::int64_t facets_per_task(int degree, std::size_t rule_points) {
  const auto terms = static_cast<std::int64_t>(rule_points * RegularSums::count(degree));
  return std::clamp<std::int64_t>(20'000'000 / terms, 1, 1024);
}

// Tasks are done in stretches, so that the sums of few tasks are held at a time.
RegularSums volume_sums(const TriangleMesh& mesh, const Vec3d& center, double radius, int degree,
                        const Progress& progress) {
  constexpr std::int64_t kStretchTasks = 256;
  const std::vector<TrianglePoint> rule = triangle_rule(degree);
  const auto facets = static_cast<std::int64_t>(mesh.triangles.size());
  const std::int64_t size = facets_per_task(degree, rule.size()), tasks = (facets + size - 1) / size;
  RegularSums sums(degree);
  for (std::int64_t first = 0; first < tasks; first += kStretchTasks) {
    const std::int64_t end = std::min(first + kStretchTasks, tasks);
    std::vector<RegularSums> parts(static_cast<std::size_t>(end - first), RegularSums(degree));
    reported_parallel_for({first, end, tasks}, progress, "harmonics", [&](std::int64_t task) {
      RegularSums& part = parts[static_cast<std::size_t>(task - first)];
      for (std::int64_t i = task * size; i < std::min((task + 1) * size, facets); ++i) {
        const auto& [a, b, c] = mesh.triangles[static_cast<std::size_t>(i)];
        const auto scaled = [&](std::uint32_t v) { return (mesh.vertices[v] - center) * (1.0 / radius); };
        add_facet(scaled(a), scaled(b), scaled(c), rule, part);
      }
    });
    for (const RegularSums& part : parts) {
      for (std::size_t i = 0; i < sums.values.size(); ++i) sums.values[i] += part.values[i];
    }
  }
  return sums;
}

double factorial(int n) {
  double product = 1.0;
  for (int i = 2; i <= n; ++i) product *= i;
  return product;
}

}  // namespace

BodyMass body_mass(const TriangleMesh& mesh) {
  const Vec3d origin = mesh.bounds().center();
  BodyMass body;
  Vec3d first;
  Matrix3 second{};
  for (const auto& [i, j, k] : mesh.triangles) {
    const Vec3d a = mesh.vertices[i] - origin, b = mesh.vertices[j] - origin, c = mesh.vertices[k] - origin;
    const double v = dot(a, cross(b, c)) / 6.0;
    const Vec3d sum = a + b + c;
    body.volume += v;
    first += 0.25 * v * sum;
    for (const Vec3d& y : {a, b, c, sum}) {
      const std::array<double, 3> e = components(y);
      for (std::size_t p = 0; p < 3; ++p) {
        for (std::size_t q = 0; q < 3; ++q) second[p][q] += 0.05 * v * e[p] * e[q];
      }
    }
  }
  const Vec3d center = body.volume != 0.0 ? first * (1.0 / body.volume) : Vec3d{};
  const std::array<double, 3> e = components(center);
  for (std::size_t p = 0; p < 3; ++p) {
    for (std::size_t q = 0; q < 3; ++q) second[p][q] -= body.volume * e[p] * e[q];
  }
  body.center = origin + center;
  body.inertia = inertia_tensor(second);
  return body;
}

PrincipalAxes principal_axes(const Matrix3& symmetric) {
  Matrix3 m = symmetric, vectors = kIdentity3;
  for (int sweep = 0; sweep < 30; ++sweep) {
    rotate_to_diagonal(m, vectors, 0, 1);
    rotate_to_diagonal(m, vectors, 0, 2);
    rotate_to_diagonal(m, vectors, 1, 2);
  }
  std::array<std::size_t, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return m[a][a] < m[b][b]; });
  PrincipalAxes axes;
  for (std::size_t k = 0; k < 3; ++k) {
    axes.moments[k] = m[order[k]][order[k]];
    axes.axes[k] = {vectors[0][order[k]], vectors[1][order[k]], vectors[2][order[k]]};
  }
  axes.axes[2] = cross(axes.axes[0], axes.axes[1]);
  return axes;
}

std::vector<GravityCoefficient> gravity_coefficients(const TriangleMesh& mesh, const Vec3d& center,
                                                     double radius, int degree, const Progress& progress) {
  const RegularSums sums = volume_sums(mesh, center, radius, degree, progress);
  const double volume = sums.values[0].re / 3.0;
  std::vector<GravityCoefficient> coefficients;
  for (int l = 0; l <= degree; ++l) {
    for (int m = 0; m <= l; ++m) {
      const double twice = m == 0 ? 1.0 : 2.0;
      const double scale =
          std::sqrt(twice * factorial(l - m) * factorial(l + m) / (2 * l + 1)) / (l + 3) / volume;
      const HarmonicValue& sum = sums.values[RegularSums::place(l, m)];
      coefficients.push_back({l, m, scale * sum.re, scale * sum.im});
    }
  }
  return coefficients;
}

}  // namespace astrolith
