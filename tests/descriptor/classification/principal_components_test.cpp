#include "descriptor/classification/principal_components.h"

#include <gtest/gtest.h>

#include <cmath>

#include "numerics/errors.h"
#include "numerics/hash_random.h"

namespace astrolith {
namespace {

// Points vary along (3, 4, 0) / 5, less along (0, 0, 1), and along no other direction.
TEST(PrincipalComponents, FindTheDirectionsOfMostVariance) {
  CounterRandom random(1);
  FeatureRows rows;
  for (int i = 0; i < 200; ++i) {
    const double s = 10 * random.normal(), t = random.normal();
    rows.push_back(
        {static_cast<float>(1 + 0.6 * s), static_cast<float>(2 + 0.8 * s), static_cast<float>(3 + t)});
  }
  const PrincipalComponents pca = principal_components(rows, 2);
  ASSERT_EQ(pca.axes.size(), 2u);
  EXPECT_NEAR(std::fabs(0.6f * pca.axes[0][0] + 0.8f * pca.axes[0][1]), 1, 1e-3);
  EXPECT_NEAR(std::fabs(pca.axes[1][2]), 1, 1e-3);
  // Two components hold all variation, so that they give a point back.
  const std::vector<float> c = pca.apply(rows[7]);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(pca.mean[i] + c[0] * pca.axes[0][i] + c[1] * pca.axes[1][i], rows[7][i], 1e-3);
  }
}

TEST(PrincipalComponents, OfMoreFeaturesThanShapes) {
  FeatureRows rows(4, std::vector<float>(1000, 0.0f));
  for (std::size_t i = 0; i < 4; ++i) rows[i][i] = 1;
  EXPECT_EQ(principal_components(rows, 3).axes.size(), 3u);
  EXPECT_THROW(principal_components(rows, 4), InputError);
  EXPECT_THROW(principal_components(rows, 0), InputError);
  EXPECT_THROW(principal_components({}, 1), InputError);
}

}  // namespace
}  // namespace astrolith
