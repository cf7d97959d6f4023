#include "descriptor/classification/shape_features.h"

#include <gtest/gtest.h>

#include <numeric>

#include "geometry/surface/mesh_sampling.h"
#include "numerics/errors.h"
#include "tests/support/meshes.h"

namespace astrolith {
namespace {

class EveryKind : public ::testing::TestWithParam<FeatureKind> {
 protected:
  FeatureOptions options() const {
    FeatureOptions o = default_features(GetParam());
    o.points = 1500;
    return o;
  }
};

TEST_P(EveryKind, HasItsNameAndSize) {
  EXPECT_EQ(feature_kind_from_name(name_of(GetParam())), GetParam());
  const std::vector<float> features = shape_features(testing::torus(1, 0.4), options());
  EXPECT_EQ(features.size(), feature_count(options()));
  // The mean feature is exactly 1 for histograms and about 1 for spectra.
  const double mean =
      std::accumulate(features.begin(), features.end(), 0.0) / static_cast<double>(features.size());
  EXPECT_NEAR(mean, 1, GetParam() == FeatureKind::shapedna ? 0.5 : 1e-5);
}

// Size, place and sampling change a vector little compared with another shape. The same holds for points
// instead of the mesh.
TEST_P(EveryKind, IsNearerToItselfThanToAnother) {
  const TriangleMesh torus = testing::torus(1, 0.4, 96, 48);
  TriangleMesh moved = torus;
  for (Vec3d& p : moved.vertices) p = Vec3d{3, 2, 1} + 5.0 * Vec3d{p.z, p.x, p.y};
  FeatureOptions other_seed = options();
  other_seed.seed = 2;
  const std::vector<float> a = shape_features(torus, options()), b = shape_features(moved, other_seed),
                           c = shape_features(testing::icosphere(4), options());
  const SurfaceSamples s = sample_poisson_disk(torus, 1500, 3);
  const std::vector<float> of_points = point_features(s.points, s.normals, options());
  const double itself = feature_distance(GetParam(), a, b), another = feature_distance(GetParam(), a, c);
  EXPECT_LT(4 * itself, another);
  EXPECT_LT(2 * feature_distance(GetParam(), a, of_points), another);
  EXPECT_EQ(feature_distance(GetParam(), a, a), 0);
  EXPECT_EQ(shape_features({s.points, {}, s.normals}, options()), of_points);
}

TEST_P(EveryKind, RefusesNumbersOutOfRange) {
  FeatureOptions o = options();
  o.points = 3;
  EXPECT_THROW(shape_features(testing::icosphere(2), o), InputError);
  o = options();
  o.bins = 100000;
  EXPECT_THROW(check(o), InputError);
  o = options();
  o.eigenvalues = 0;
  EXPECT_THROW(check(o), InputError);
}

INSTANTIATE_TEST_SUITE_P(Kinds, EveryKind,
                         ::testing::Values(FeatureKind::wahl, FeatureKind::ahd, FeatureKind::d2,
                                           FeatureKind::shapedna),
                         [](const auto& kind) { return name_of(kind.param); });

TEST(ShapeFeatures, OtherNamesAreRefused) { EXPECT_THROW(feature_kind_from_name("d3"), InputError); }

}  // namespace
}  // namespace astrolith
