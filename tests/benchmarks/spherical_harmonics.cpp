#include "tests/benchmarks/spherical_harmonics.h"

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

using Matrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr int kIterations = 60;
constexpr double kConverged = 1e-6;

Eigen::Index coefficient_count(int degree) { return Eigen::Index{degree + 1} * (degree + 1); }

}  // namespace

void harmonics_at(const Vec3d& direction, int degree, std::vector<float>& values) {
  values.clear();
  const double z = direction.z;
  // sin^m cos(m phi) and sin^m sin(m phi); the Legendre functions here therefore lack their factor sin^m.
  double cosine = 1.0, sine = 0.0;
  double diagonal = std::sqrt(1.0 / (4.0 * std::numbers::pi));  // the function of l = m
  for (int m = 0; m <= degree; ++m) {
    double before = 0.0, here = diagonal;
    for (int l = m; l <= degree; ++l) {
      const double scale = m == 0 ? 1.0 : std::numbers::sqrt2;
      values.push_back(static_cast<float>(scale * here * cosine));
      if (m > 0) values.push_back(static_cast<float>(scale * here * sine));
      const double n = l + 1;
      const double a = std::sqrt((4 * n * n - 1) / (n * n - m * m));
      const double b = std::sqrt(((n - 1) * (n - 1) - m * m) / (4 * (n - 1) * (n - 1) - 1));
      const double next = a * (z * here - (l == m ? 0.0 : b * before));
      before = here;
      here = next;
    }
    diagonal *= std::sqrt((2.0 * m + 3.0) / (2.0 * m + 2.0));
    const double turned = cosine * direction.x - sine * direction.y;
    sine = cosine * direction.y + sine * direction.x;
    cosine = turned;
  }
}

SphericalHarmonics fit_harmonics(const std::vector<Vec3d>& points, const Vec3d& center, int degree) {
  Matrix a(static_cast<Eigen::Index>(points.size()), coefficient_count(degree));
  Eigen::VectorXf residual(a.rows());
  parallel_for(0, a.rows(), [&](std::int64_t i) {
    const Vec3d p = points[static_cast<std::size_t>(i)] - center;
    residual[i] = static_cast<float>(norm(p));
    std::vector<float> row;
    harmonics_at(normalized(p), degree, row);
    a.row(i) = Eigen::Map<const Eigen::RowVectorXf>(row.data(), a.cols());
  });
  Eigen::VectorXf x = Eigen::VectorXf::Zero(a.cols());
  Eigen::VectorXf gradient = a.transpose() * residual, direction = gradient;
  double square = gradient.squaredNorm();
  const double first = square;
  for (int k = 0; k < kIterations && square > kConverged * kConverged * first; ++k) {
    const Eigen::VectorXf step = a * direction;
    const auto length = static_cast<float>(square / step.squaredNorm());
    x += length * direction;
    residual -= length * step;
    gradient.noalias() = a.transpose() * residual;
    const double now = gradient.squaredNorm();
    direction = gradient + static_cast<float>(now / square) * direction;
    square = now;
  }
  return {degree, center, {x.data(), x.data() + x.size()}};
}

TriangleMesh harmonics_mesh(const SphericalHarmonics& body, int rows) {
  const int columns = 2 * rows;
  TriangleMesh mesh;
  mesh.vertices.resize(static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns) + 2);
  const std::size_t south = mesh.vertices.size() - 2, north = south + 1;
  parallel_for(0, static_cast<std::int64_t>(mesh.vertices.size()), [&](std::int64_t i) {
    const auto v = static_cast<std::size_t>(i);
    const double row = v == south ? -0.5 : v == north ? rows - 0.5 : static_cast<double>(i / columns);
    const double theta = std::numbers::pi * (1.0 - (row + 0.5) / rows);
    const double phi = 2.0 * std::numbers::pi * static_cast<double>(i % columns) / columns;
    const Vec3d direction{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
    std::vector<float> values;
    harmonics_at(direction, body.degree, values);
    double radius = 0.0;
    for (std::size_t k = 0; k < values.size(); ++k)
      radius += double{values[k]} * double{body.coefficients[k]};
    mesh.vertices[v] = body.center + direction * std::max(radius, 1e-6);
  });
  const auto at = [&](int row, int column) {
    return static_cast<std::uint32_t>(row * columns + column % columns);
  };
  for (int c = 0; c < columns; ++c) {
    mesh.triangles.push_back({static_cast<std::uint32_t>(south), at(0, c + 1), at(0, c)});
    mesh.triangles.push_back({static_cast<std::uint32_t>(north), at(rows - 1, c), at(rows - 1, c + 1)});
    for (int r = 0; r + 1 < rows; ++r) {
      mesh.triangles.push_back({at(r, c), at(r, c + 1), at(r + 1, c)});
      mesh.triangles.push_back({at(r, c + 1), at(r + 1, c + 1), at(r + 1, c)});
    }
  }
  return mesh;
}

}  // namespace astrolith
