#include "gravity/facet_layer.h"
#include "gravity/gravity_tree.h"
#include "numerics/host_device.h"

namespace astrolith {
namespace {

ASTROLITH_SIMD_CLONES void add_facet(const layer::Facet& facet, const double* __restrict x,
                                     const double* __restrict y, const double* __restrict z,
                                     double* __restrict gx, double* __restrict gy, double* __restrict gz,
                                     double* __restrict work) {
  const layer::Facet f = facet;
#pragma omp simd
  for (int i = 0; i < kPointBatch; ++i) {
    const layer::LayerValue value = layer::layer_potential(f, x[i], y[i], z[i]);
    gx[i] += f.normal.x * value.potential;
    gy[i] += f.normal.y * value.potential;
    gz[i] += f.normal.z * value.potential;
    work[i] += value.height * value.potential;
  }
}

using Row = std::array<double, kPointBatch>;

// The irregular harmonics of one m, and the sums of all l, point after point.
struct HarmonicRows {
  Row x, y, z, inverse;          // coordinates over r^2, and 1 / r^2
  Row diagonal_re, diagonal_im;  // S_mm
  Row now_re, now_im, last_re, last_im;
  std::array<Row, 4> sums;
};

ASTROLITH_SIMD_CLONES void sum_harmonics(const GravityMultipoles& multipoles, int order, HarmonicRows& rows) {
  for (int m = 0; m <= order; ++m) {
    const double turn = -(2.0 * m - 1.0);
#pragma omp simd
    for (int i = 0; i < kPointBatch; ++i) {
      const double re = rows.diagonal_re[i], im = rows.diagonal_im[i];
      const double next_re = turn * (rows.x[i] * re - rows.y[i] * im),
                   next_im = turn * (rows.x[i] * im + rows.y[i] * re);
      rows.diagonal_re[i] = m > 0 ? next_re : re;
      rows.diagonal_im[i] = m > 0 ? next_im : im;
      rows.now_re[i] = rows.diagonal_re[i];
      rows.now_im[i] = rows.diagonal_im[i];
      rows.last_re[i] = rows.last_im[i] = 0.0;
    }
    for (int l = m; l <= order; ++l) {
      const std::array<double, 8>& t = multipoles.terms[static_cast<std::size_t>(harmonic_index(l, m))];
      const double up = 2.0 * l + 1.0, down = double(l) * l - double(m) * m;
#pragma omp simd
      for (int i = 0; i < kPointBatch; ++i) {
        const double re = rows.now_re[i], im = rows.now_im[i];
        rows.sums[0][i] += t[0] * re + t[4] * im;
        rows.sums[1][i] += t[1] * re + t[5] * im;
        rows.sums[2][i] += t[2] * re + t[6] * im;
        rows.sums[3][i] += t[3] * re + t[7] * im;
        const double a = up * rows.z[i], b = down * rows.inverse[i];
        rows.now_re[i] = a * re - b * rows.last_re[i];
        rows.now_im[i] = a * im - b * rows.last_im[i];
        rows.last_re[i] = re;
        rows.last_im[i] = im;
      }
    }
  }
}

}  // namespace

void add_facets(std::span<const std::array<Vec3d, 3>> facets, const GravityBatch& points, GravitySums& sums) {
  for (const auto& [a, b, c] : facets) {
    add_facet(layer::make_facet(a, b, c), points.x.data(), points.y.data(), points.z.data(),
              sums.layers[0].data(), sums.layers[1].data(), sums.layers[2].data(), sums.work.data());
  }
}

void add_multipoles(const GravityNode& node, const GravityMultipoles& multipoles, int order,
                    const GravityBatch& points, GravitySums& sums) {
  HarmonicRows rows;
  Row dx, dy, dz;
  for (std::size_t i = 0; i < kPointBatch; ++i) {
    dx[i] = points.x[i] - node.center.x;
    dy[i] = points.y[i] - node.center.y;
    dz[i] = points.z[i] - node.center.z;
    const double square = dx[i] * dx[i] + dy[i] * dy[i] + dz[i] * dz[i], inverse = 1.0 / square;
    rows.x[i] = dx[i] * inverse;
    rows.y[i] = dy[i] * inverse;
    rows.z[i] = dz[i] * inverse;
    rows.inverse[i] = inverse;
    rows.diagonal_re[i] = __builtin_sqrt(inverse);
    rows.diagonal_im[i] = 0.0;
  }
  for (Row& sum : rows.sums) sum.fill(0.0);
  sum_harmonics(multipoles, order, rows);
  for (std::size_t i = 0; i < kPointBatch; ++i) {
    for (std::size_t k = 0; k < 3; ++k) sums.layers[k][i] += rows.sums[k][i];
    sums.work[i] +=
        rows.sums[3][i] - (dx[i] * rows.sums[0][i] + dy[i] * rows.sums[1][i] + dz[i] * rows.sums[2][i]);
  }
}

}  // namespace astrolith
