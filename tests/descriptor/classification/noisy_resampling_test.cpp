#include "descriptor/classification/noisy_resampling.h"

#include <gtest/gtest.h>

#include <cmath>

#include "numerics/errors.h"
#include "tests/support/meshes.h"

namespace astrolith {
namespace {

TEST(NoisyResampling, HasTheStatedNoiseAndSize) {
  const TriangleMesh sphere = testing::icosphere(5);  // 10242 vertices
  const double diagonal = 2 * std::sqrt(3.0);
  ResamplingOptions options;
  options.noise = 0.01;
  for (std::uint64_t seed = 1; seed < 4; ++seed) {
    const NoisyResampling r = noisy_resampling(sphere, options, seed);
    EXPECT_GE(r.fraction, 0.0999);
    EXPECT_LE(r.fraction, 0.2001);
    EXPECT_EQ(r.points.size(), r.normals.size());
    double squares = 0, agreement = 0;
    for (std::size_t i = 0; i < r.points.size(); ++i) {
      squares += (norm(r.points[i]) - 1) * (norm(r.points[i]) - 1);
      agreement += dot(r.normals[i], normalized(r.points[i]));
    }
    const auto n = static_cast<double>(r.points.size());
    EXPECT_NEAR(std::sqrt(squares / n) / (0.01 * diagonal), 1, 0.1);
    EXPECT_GT(agreement / n, 0.9);
  }
}

TEST(NoisyResampling, DependsOnTheSeedAlone) {
  const TriangleMesh torus = testing::torus(1, 0.4);
  const NoisyResampling a = noisy_resampling(torus, {}, 1), b = noisy_resampling(torus, {}, 1),
                        c = noisy_resampling(torus, {}, 2);
  ASSERT_EQ(a.points.size(), b.points.size());
  for (std::size_t i = 0; i < a.points.size(); ++i) EXPECT_EQ(a.points[i], b.points[i]);
  EXPECT_FALSE(a.points[0] == c.points[0]);
}

TEST(NoisyResampling, SmallMeshesGetSixtyFourPoints) {
  EXPECT_EQ(noisy_resampling(testing::octahedron(), {}, 1).points.size(), 64u);
}

TEST(NoisyResampling, RefusesFractionsOutOfOrder) {
  const TriangleMesh mesh = testing::octahedron();
  EXPECT_THROW(noisy_resampling(mesh, {0.2, 0.1, 0.01, 12}, 1), InputError);
  EXPECT_THROW(noisy_resampling(mesh, {0.1, 0.2, -0.01, 12}, 1), InputError);
  EXPECT_THROW(noisy_resampling(mesh, {0.1, 0.2, std::nan(""), 12}, 1), InputError);
  EXPECT_THROW(noisy_resampling({}, {}, 1), InputError);
}

}  // namespace
}  // namespace astrolith
