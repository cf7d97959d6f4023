#include "gravity/facet_layer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "numerics/hash_random.h"

namespace astrolith {
namespace {

// Units in the last place of the truth.
double ulps(double value, long double truth) {
  const double size = std::fabs(static_cast<double>(truth));
  return static_cast<double>(std::fabs(value - truth)) /
         (std::nextafter(size, std::numeric_limits<double>::infinity()) - size);
}

double random_unit(int i, int which) { return unit_float(hash_cell(7u, i, which, 0)); }

TEST(FacetLayer, AnglesAreWithinTwoUlp) {
  double worst = 0.0;
  for (int i = 0; i < 200000; ++i) {
    const double x = (2 * random_unit(i, 0) - 1) * std::exp2(40 * random_unit(i, 2) - 20);
    const double y = (2 * random_unit(i, 1) - 1) * std::exp2(40 * random_unit(i, 3) - 20);
    if (x == 0.0 || y == 0.0) continue;
    worst = std::max(worst, ulps(layer::angle_of(y, x), atan2l(y, x)));
  }
  EXPECT_LE(worst, 2.0);
  EXPECT_EQ(layer::angle_of(0, 0), 0.0);
  EXPECT_EQ(layer::angle_of(0, 1), 0.0);
  EXPECT_DOUBLE_EQ(layer::angle_of(0, -1), std::numbers::pi);
}

// Short wires take the series, long ones the quotient.
TEST(FacetLayer, WirePotentialsAreWithinTwoUlp) {
  double worst = 0.0;
  for (int i = 0; i < 200000; ++i) {
    const double sum = 1.0 + random_unit(i, 0), edge = sum * std::exp2(-40 * random_unit(i, 1)) * 0.999;
    const double above = sum + edge, below = sum - edge;
    // The arguments are exact only as far as their sums are.
    if (above - sum != edge || sum - below != edge) continue;
    const double quotient = above / below;
    const long double truth =
        quotient > std::sqrt(2.0) ? logl(quotient) : 2 * atanhl(static_cast<long double>(edge) / sum);
    worst = std::max(worst, ulps(layer::wire_potential(above, below, edge, sum), truth));
  }
  EXPECT_LE(worst, 2.0);
  EXPECT_TRUE(std::isfinite(layer::wire_potential(1.0, 0.0, 1.0, 1.0)));
  EXPECT_TRUE(std::isfinite(layer::wire_potential(0.0, 0.0, 0.0, 0.0)));
}

// A square of side 2 seen from distance 1 above its centre: 4 (2 log((1 + sqrt 3) / sqrt 2) - pi / 6).
TEST(FacetLayer, PotentialOfASquare) {
  const double truth = 4 * (std::log(2 + std::sqrt(3.0)) - std::numbers::pi / 6);
  double sum = 0.0;
  for (const layer::Facet& f : {layer::make_facet({-1, -1, 0}, {1, -1, 0}, {1, 1, 0}),
                                layer::make_facet({-1, -1, 0}, {1, 1, 0}, {-1, 1, 0})}) {
    sum += layer::layer_potential(f, 0, 0, 1).potential;
  }
  EXPECT_NEAR(sum, truth, 1e-15 * 10);
}

// On the plane the layer of a right triangle with legs 1 at its right corner: sqrt(1/2) log(3 + 2 sqrt 2).
TEST(FacetLayer, AtACorner) {
  const layer::Facet f = layer::make_facet({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const double truth = std::sqrt(0.5) * std::log(3 + 2 * std::sqrt(2.0));
  EXPECT_NEAR(layer::layer_potential(f, 0, 0, 0).potential, truth, 1e-15);
}

TEST(FacetLayer, NothingOfATriangleWithoutArea) {
  for (const layer::Facet& f : {layer::make_facet({0, 0, 0}, {1, 0, 0}, {2, 0, 0}),
                                layer::make_facet({1, 1, 1}, {1, 1, 1}, {1, 1, 1})}) {
    EXPECT_EQ(layer::layer_potential(f, 0.5, 0.0, 0.0).potential, 0.0);
    EXPECT_EQ(layer::layer_potential(f, 0.5, 1.0, 2.0).potential, 0.0);
  }
}

}  // namespace
}  // namespace astrolith
