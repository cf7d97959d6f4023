#include <algorithm>

#include "gravity/facet_layer.h"
#include "gravity/gravity_tree.h"
#include "numerics/host_device.h"

namespace astrolith {
namespace {

ASTROLITH_SIMD_CLONES void add_facet(const layer::Facet& facet, const GravityBatch& points,
                                     const PointRow& on, GravitySums& sums) {
  const layer::Facet f = facet;
#pragma omp simd
  for (int i = 0; i < kPointBatch; ++i) {
    const layer::LayerValue value = layer::layer_potential(f, points.x[i], points.y[i], points.z[i]);
    const double potential = on[i] * value.potential;
    sums.layers[0][i] += f.normal.x * potential;
    sums.layers[1][i] += f.normal.y * potential;
    sums.layers[2][i] += f.normal.z * potential;
    sums.work[i] += value.height * potential;
  }
}

// What rounds: the terms of the facet's own potential, its height, and the sums so far.
ASTROLITH_SIMD_CLONES void add_rounded_facet(const layer::Facet& facet, const GravityBatch& points,
                                             const PointRow& on, GravitySums& sums, RoundedSquares& rounded) {
  const layer::Facet f = facet;
#pragma omp simd
  for (int i = 0; i < kPointBatch; ++i) {
    const layer::LayerValue value = layer::layer_potential(f, points.x[i], points.y[i], points.z[i]);
    const double potential = on[i] * value.potential;
    const double x = sums.layers[0][i] + f.normal.x * potential,
                 y = sums.layers[1][i] + f.normal.y * potential,
                 z = sums.layers[2][i] + f.normal.z * potential,
                 work = sums.work[i] + value.height * potential;
    sums.layers[0][i] = x, sums.layers[1][i] = y, sums.layers[2][i] = z;
    sums.work[i] = work;
    rounded.layers[i] += on[i] * value.rounded + (x * x + y * y + z * z);
    rounded.work[i] +=
        on[i] * (value.square * value.rounded + value.square * potential * potential) + work * work;
  }
}

using Row = PointRow;

// The irregular harmonics of one m, and the sums of all l, point after point.
struct HarmonicRows {
  Row x, y, z, inverse;          // coordinates over r^2, and 1 / r^2
  Row diagonal_re, diagonal_im;  // S_mm
  Row now_re, now_im, last_re, last_im;
  Row order;  // the last l of each point
  std::array<Row, 4> sums;
};

ASTROLITH_SIMD_CLONES void sum_harmonics(const GravityMultipoles& multipoles, int most, HarmonicRows& rows) {
  for (int m = 0; m <= most; ++m) {
    const double turn = -(2.0 * m - 1.0);
#pragma omp simd
    for (int i = 0; i < kPointBatch; ++i) {
      const double re = rows.diagonal_re[i], im = rows.diagonal_im[i];
      const double next_re = turn * (rows.x[i] * re - rows.y[i] * im),
                   next_im = turn * (rows.x[i] * im + rows.y[i] * re);
      rows.diagonal_re[i] = m > 0 ? next_re : re;
      rows.diagonal_im[i] = m > 0 ? next_im : im;
      const bool on = rows.order[i] >= m;
      rows.now_re[i] = on ? rows.diagonal_re[i] : 0.0;
      rows.now_im[i] = on ? rows.diagonal_im[i] : 0.0;
      rows.last_re[i] = rows.last_im[i] = 0.0;
    }
    for (int l = m; l <= most; ++l) {
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
        const bool on = rows.order[i] > l;
        rows.now_re[i] = on ? a * re - b * rows.last_re[i] : 0.0;
        rows.now_im[i] = on ? a * im - b * rows.last_im[i] : 0.0;
        rows.last_re[i] = re;
        rows.last_im[i] = im;
      }
    }
  }
}

// The points about the centre, and the sums of the multipoles.
struct CenteredSums {
  Row x, y, z;
  std::array<Row, 4> sums;
};

CenteredSums sums_about(const Vec3d& center, const GravityMultipoles& multipoles, const Row& order,
                        const GravityBatch& points) {
  CenteredSums at;
  HarmonicRows rows;
  for (std::size_t i = 0; i < kPointBatch; ++i) {
    at.x[i] = points.x[i] - center.x;
    at.y[i] = points.y[i] - center.y;
    at.z[i] = points.z[i] - center.z;
    const double square = at.x[i] * at.x[i] + at.y[i] * at.y[i] + at.z[i] * at.z[i], inverse = 1.0 / square;
    rows.x[i] = at.x[i] * inverse;
    rows.y[i] = at.y[i] * inverse;
    rows.z[i] = at.z[i] * inverse;
    rows.inverse[i] = inverse;
    rows.diagonal_re[i] = __builtin_sqrt(inverse);
    rows.diagonal_im[i] = 0.0;
  }
  rows.order = order;
  for (Row& sum : rows.sums) sum.fill(0.0);
  sum_harmonics(multipoles, static_cast<int>(*std::max_element(order.begin(), order.end())), rows);
  at.sums = rows.sums;
  return at;
}

}  // namespace

void add_facets(std::span<const std::array<Vec3d, 3>> facets, const GravityBatch& points, const PointRow& on,
                GravitySums& sums) {
  for (const auto& [a, b, c] : facets) add_facet(layer::make_facet(a, b, c), points, on, sums);
}

void add_facets(std::span<const std::array<Vec3d, 3>> facets, const GravityBatch& points, const PointRow& on,
                GravitySums& sums, RoundedSquares& rounded) {
  for (const auto& [a, b, c] : facets)
    add_rounded_facet(layer::make_facet(a, b, c), points, on, sums, rounded);
}

void add_multipoles(const GravityNode& node, const GravityMultipoles& multipoles, const PointRow& order,
                    const GravityBatch& points, GravitySums& sums) {
  const CenteredSums at = sums_about(node.center, multipoles, order, points);
  for (std::size_t i = 0; i < kPointBatch; ++i) {
    if (!(order[i] >= 0.0)) continue;
    for (std::size_t k = 0; k < 3; ++k) sums.layers[k][i] += at.sums[k][i];
    sums.work[i] +=
        at.sums[3][i] - (at.x[i] * at.sums[0][i] + at.y[i] * at.sums[1][i] + at.z[i] * at.sums[2][i]);
  }
}

void add_far_body(const GravityTree& tree, const PointRow& on, const GravityBatch& points,
                  GravitySums& sums) {
  PointRow order;
  for (std::size_t i = 0; i < kPointBatch; ++i) order[i] = on[i] > 0.0 ? tree.most_order : -1.0;
  const CenteredSums at = sums_about(tree.nodes.front().center, tree.far, order, points);
  for (std::size_t i = 0; i < kPointBatch; ++i) {
    if (!(on[i] > 0.0)) continue;
    for (std::size_t k = 0; k < 3; ++k) sums.layers[k][i] += at.sums[k][i];
    sums.work[i] += at.sums[3][i];
  }
}

}  // namespace astrolith
