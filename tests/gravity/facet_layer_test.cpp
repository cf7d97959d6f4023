#include "gravity/facet_layer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace astrolith {
namespace {

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
