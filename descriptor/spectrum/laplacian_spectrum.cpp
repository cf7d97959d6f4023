#include "descriptor/spectrum/laplacian_spectrum.h"

#include <Spectra/SymEigsShiftSolver.h>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
#include <string>

#include "descriptor/spectrum/point_cloud_triangles.h"
#include "geometry/mesh_topology.h"
#include "numerics/errors.h"

namespace astrolith {
namespace {

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
LaplacianSpectrum spectrum_of(std::span<const Vec3d> points, std::span<const Triangle> triangles,
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

LaplacianSpectrum laplacian_spectrum(const TriangleMesh& mesh, int count) {
  check_size(mesh.vertices.size());
  const MeshTopology topology = analyze_topology(mesh);
  if (topology.non_manifold_edges > 0) {
    throw InputError("Laplacian spectrum: " + std::to_string(topology.non_manifold_edges) +
                     " edges join three or more triangles; give a mesh that is a surface everywhere");
  }
  return spectrum_of(mesh.vertices, mesh.triangles, 1, count);
}

LaplacianSpectrum laplacian_spectrum(std::span<const Vec3d> points, std::span<const Vec3d> normals,
                                     int count) {
  check_size(points.size());
  if (points.size() < 16) {
    throw InputError("Laplacian spectrum: " + std::to_string(points.size()) +
                     " points are too few; give at least 16");
  }
  const int neighbours = std::min(kCloudNeighbours, static_cast<int>(points.size()) - 1);
  return spectrum_of(points, point_cloud_triangles(points, normals, neighbours), 3, count);
}

}  // namespace astrolith
