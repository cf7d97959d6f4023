#include "descriptor/spectrum/laplacian_spectrum.h"

#include <Spectra/SymEigsShiftSolver.h>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <string>

#include "geometry/mesh_topology.h"
#include "geometry/points/nearest_neighbours.h"
#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "numerics/tangent_frame.h"

namespace astrolith {
namespace {

struct PlanePoint {
  double x, y;
  std::uint32_t index;
};

// The z component of (b - a) x (c - a): positive for a turn to the left.
double turn(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// The corners of the convex hull, counter-clockwise (Andrew's monotone chain).
std::vector<PlanePoint> convex_hull(std::vector<PlanePoint> points) {
  std::sort(points.begin(), points.end(), [](const PlanePoint& a, const PlanePoint& b) {
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.index < b.index;
  });
  std::vector<PlanePoint> hull;
  const auto extend = [&hull](const PlanePoint& p, std::size_t fixed) {
    while (hull.size() >= fixed + 2 && turn(hull[hull.size() - 2], hull.back(), p) <= 0) hull.pop_back();
    hull.push_back(p);
  };
  for (const PlanePoint& p : points) extend(p, 0);
  const std::size_t lower = hull.size() - 1;
  for (auto p = points.rbegin() + 1; p != points.rend(); ++p) extend(*p, lower);
  hull.pop_back();
  return hull;
}

// The neighbours of point i in its tangent plane, relative to i and inverted: a place q becomes q / |q|^2.
// Circles through the origin become lines, so that the Delaunay neighbours of the origin are the corners of a
// convex hull.
std::vector<PlanePoint> inverted_neighbours(std::span<const Vec3d> points, std::uint32_t i,
                                            const Vec3d& normal, std::span<const std::uint32_t> around) {
  const auto [u, v] = crossed_tangents(normal);
  std::vector<PlanePoint> inverted;
  for (const std::uint32_t j : around) {
    const Vec3d d = points[j] - points[i];
    const double x = dot(d, u), y = dot(d, v), squared = x * x + y * y;
    if (squared > 1e-12 * squared_norm(d)) inverted.push_back({x / squared, y / squared, j});
  }
  return inverted;
}

std::vector<Triangle> star(std::span<const Vec3d> points, std::uint32_t i, const Vec3d& normal,
                           std::span<const std::uint32_t> around) {
  std::vector<PlanePoint> inverted = inverted_neighbours(points, i, normal, around);
  if (inverted.size() < 2) return {};
  const std::vector<PlanePoint> hull = convex_hull(std::move(inverted));
  std::vector<Triangle> triangles;
  for (std::size_t k = 0; k < hull.size(); ++k) {
    const PlanePoint &a = hull[k], &b = hull[(k + 1) % hull.size()];
    // A side that does not run counter-clockwise around the origin is a gap, because i lies on a border.
    if (a.x * b.y - a.y * b.x > 0) triangles.push_back({i, a.index, b.index});
  }
  return triangles;
}

using SparseMatrix = Eigen::SparseMatrix<double>;

// The factorisation for half a million vertices needs about a gigabyte.
constexpr std::size_t kMaxVertices = 500000;
// Delaunay neighbours are among the nearest few points; 20 hold them all unless the sampling is very uneven.
constexpr int kCloudNeighbours = 20;
// The shift lies below the whole spectrum, so that the shifted matrix is positive definite, and near its low
// end.
constexpr double kShift = -1;
// Triangles with a smaller sine of an angle are left out: their cotangents would drown all others.
constexpr double kSmallestSine = 1e-8;

// The operator S = M^-1/2 L M^-1/2 over the vertices that have a mass. Its eigenvalues are those of L x =
// lambda M x.
struct Operator {
  SparseMatrix matrix;
  double mass = 0;  // the area of all triangles
  std::int64_t left_out = 0;
};

class Assembly {
 public:
  explicit Assembly(std::span<const Vec3d> points) : points_(points), mass_(points.size(), 0.0) {}

  void add(const Triangle& t) {
    const Vec3d &a = points_[t[0]], &b = points_[t[1]], &c = points_[t[2]];
    const double double_area = norm(cross(b - a, c - a));
    const double longest2 = std::max({squared_norm(b - a), squared_norm(c - b), squared_norm(a - c)});
    if (!(double_area > kSmallestSine * longest2)) {
      ++left_out_;
      return;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t i = t[(k + 1) % 3], j = t[(k + 2) % 3];
      const Vec3d &p = points_[t[k]], &q = points_[i], &r = points_[j];
      const double weight = 0.5 * dot(q - p, r - p) / double_area;  // half the cotangent at p
      weights_.push_back({i, j, weight});
      mass_[t[k]] += double_area / 6;
    }
  }

  Operator finish() const {
    Operator result;
    result.left_out = left_out_;
    std::vector<int> row(mass_.size(), -1);
    std::vector<double> inverse_root;
    for (std::size_t i = 0; i < mass_.size(); ++i) {
      if (!(mass_[i] > 0)) continue;
      row[i] = static_cast<int>(inverse_root.size());
      inverse_root.push_back(1 / std::sqrt(mass_[i]));
      result.mass += mass_[i];
    }
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(4 * weights_.size());
    for (const auto& [i, j, weight] : weights_) {
      const int ri = row[i], rj = row[j];
      const double si = inverse_root[static_cast<std::size_t>(ri)],
                   sj = inverse_root[static_cast<std::size_t>(rj)];
      entries.emplace_back(ri, ri, weight * si * si);
      entries.emplace_back(rj, rj, weight * sj * sj);
      entries.emplace_back(ri, rj, -weight * si * sj);
      entries.emplace_back(rj, ri, -weight * si * sj);
    }
    const auto n = static_cast<Eigen::Index>(inverse_root.size());
    result.matrix.resize(n, n);
    result.matrix.setFromTriplets(entries.begin(), entries.end());
    result.matrix *= result.mass;  // eigenvalues times the area of all triangles
    return result;
  }

 private:
  struct Weight {
    std::uint32_t i, j;
    double value;
  };
  std::span<const Vec3d> points_;
  std::vector<double> mass_;
  std::vector<Weight> weights_;
  std::int64_t left_out_ = 0;
};

// (S - shift)^-1 x in the interface that Spectra expects. The matrix is positive definite, so that Cholesky
// serves; Spectra's own class uses LU, which is slower.
class ShiftedInverse {
 public:
  using Scalar = double;

  explicit ShiftedInverse(const SparseMatrix& matrix) : matrix_(matrix) {}
  Eigen::Index rows() const { return matrix_.rows(); }
  Eigen::Index cols() const { return matrix_.cols(); }
  void set_shift(double shift) {
    SparseMatrix shifted = matrix_;
    for (Eigen::Index i = 0; i < shifted.rows(); ++i) shifted.coeffRef(i, i) -= shift;
    factor_.compute(shifted);
    if (factor_.info() != Eigen::Success) {
      throw WorkError("Laplacian spectrum: the matrix cannot be factored; weld or remesh the surface");
    }
  }
  void perform_op(const double* x, double* y) const {
    Eigen::Map<Eigen::VectorXd>(y, rows()) = factor_.solve(Eigen::Map<const Eigen::VectorXd>(x, rows()));
  }

 private:
  const SparseMatrix& matrix_;
  Eigen::SimplicialLDLT<SparseMatrix> factor_;
};

std::vector<double> lowest_eigenvalues(const SparseMatrix& matrix, int count) {
  const Eigen::Index n = matrix.rows();
  if (count < 1 || count + 2 > n) {
    throw InputError("Laplacian spectrum: " + std::to_string(count) + " eigenvalues of " + std::to_string(n) +
                     " vertices; ask for at least 1 and for fewer than there are vertices");
  }
  ShiftedInverse inverse(matrix);
  // One eigenvalue more is sought: the zero of the constant function is dropped.
  const Eigen::Index wanted = std::min<Eigen::Index>(count + 1, n - 1);
  const Eigen::Index basis = std::min<Eigen::Index>(n, 2 * wanted + 20);
  Spectra::SymEigsShiftSolver<ShiftedInverse> solver(inverse, wanted, basis, kShift);
  solver.init();
  solver.compute(Spectra::SortRule::LargestMagn, 1000, 1e-10, Spectra::SortRule::SmallestAlge);
  if (solver.info() != Spectra::CompInfo::Successful) {
    throw WorkError("Laplacian spectrum: the eigensolver did not converge; weld or remesh the surface");
  }
  std::vector<double> values;
  for (const double value : solver.eigenvalues()) values.push_back(std::max(0.0, value));
  std::sort(values.begin(), values.end());
  return {values.begin() + 1, values.begin() + 1 + count};
}

// `covers` is how often the triangles cover the surface.
LaplacianSpectrum solve_spectrum(std::span<const Vec3d> points, std::span<const Triangle> triangles,
                                 double covers, int count) {
  Assembly assembly(points);
  for (const Triangle& t : triangles) assembly.add(t);
  const Operator op = assembly.finish();
  if (!(op.mass > 0) || !std::isfinite(op.mass)) {
    throw InputError("Laplacian spectrum: the surface has no area or is not finite; give another mesh");
  }
  LaplacianSpectrum spectrum{lowest_eigenvalues(op.matrix, count), op.mass / covers, op.left_out};
  for (double& value : spectrum.eigenvalues) value /= covers;
  return spectrum;
}

void check_size(std::size_t vertices) {
  if (vertices > kMaxVertices) {
    throw InputError("Laplacian spectrum: " + std::to_string(vertices) + " vertices are more than " +
                     std::to_string(kMaxVertices) + "; give a coarser mesh");
  }
}

}  // namespace

std::vector<Triangle> point_cloud_triangles(std::span<const Vec3d> points, std::span<const Vec3d> normals,
                                            int neighbours) {
  if (points.size() != normals.size() || neighbours < 3) {
    throw InputError("point cloud: " + std::to_string(points.size()) + " points have " +
                     std::to_string(normals.size()) + " normals and " + std::to_string(neighbours) +
                     " neighbours; give a normal for each and at least 3 neighbours");
  }
  const std::vector<std::uint32_t> nearest = nearest_neighbours(points, neighbours);
  const auto k = static_cast<std::size_t>(neighbours);
  std::vector<std::vector<Triangle>> stars(points.size());
  parallel_for(
      0, static_cast<std::int64_t>(points.size()),
      [&](std::int64_t index) {
        const auto i = static_cast<std::uint32_t>(index);
        stars[i] = star(points, i, normals[i], std::span(nearest).subspan(i * k, k));
      },
      64);
  std::vector<Triangle> triangles;
  for (const auto& s : stars) triangles.insert(triangles.end(), s.begin(), s.end());
  return triangles;
}

LaplacianSpectrum laplacian_spectrum(const TriangleMesh& mesh, int count) {
  check_size(mesh.vertices.size());
  const MeshTopology topology = analyze_topology(mesh);
  if (topology.non_manifold_edges > 0) {
    throw InputError("Laplacian spectrum: " + std::to_string(topology.non_manifold_edges) +
                     " edges join three or more triangles; give a mesh that is a surface everywhere");
  }
  return solve_spectrum(mesh.vertices, mesh.triangles, 1, count);
}

LaplacianSpectrum laplacian_spectrum(std::span<const Vec3d> points, std::span<const Vec3d> normals,
                                     int count) {
  check_size(points.size());
  if (points.size() < 16) {
    throw InputError("Laplacian spectrum: " + std::to_string(points.size()) +
                     " points are too few; give at least 16");
  }
  const int neighbours = std::min(kCloudNeighbours, static_cast<int>(points.size()) - 1);
  return solve_spectrum(points, point_cloud_triangles(points, normals, neighbours), 3, count);
}

}  // namespace astrolith
