#include "descriptor/features/found_features.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "numerics/parallel_for.h"
#include "tests/support/meshes.h"
#include "tests/support/refusal.h"

namespace astrolith {
namespace {

struct Bowl {
  Vec3d direction;
  double diameter, depth, rim;

  // The profile of recipe/landforms.h on the unit sphere, by the chord from the crater's centre.
  double height(const Vec3d& p) const {
    const double t = 2.0 * norm(p - normalized(direction)) / diameter;
    if (t < 1.0) return (depth + rim) * t * t - depth;
    return t < 2.5 ? rim * std::pow((2.5 - t) / 1.5, 3.0) : 0.0;
  }
};

const std::vector<Bowl> kBowls{
    {{1, 0.2, 0.1}, 0.5, 0.06, 0.018}, {{-0.3, 1, 0.4}, 0.36, 0.04, 0.012}, {{-1, -1, 0.3}, 0.7, 0.08, 0.02}};

template <int levels = 5>
TriangleMesh cratered_sphere(const std::vector<Bowl>& bowls) {
  TriangleMesh mesh = testing::icosphere(levels);
  for (Vec3d& p : mesh.vertices) {
    double height = 0.0;
    for (const Bowl& bowl : bowls) height += bowl.height(p);
    p *= 1.0 + height;
  }
  return mesh;
}

std::vector<FoundFeature> likely(const TriangleMesh& mesh, const FeatureOptions& options = {}) {
  std::vector<FoundFeature> found = find_features(mesh, options).features;
  std::erase_if(found, [](const FoundFeature& f) { return f.confidence < 0.5; });
  std::sort(found.begin(), found.end(),
            [](const FoundFeature& a, const FoundFeature& b) { return a.diameter < b.diameter; });
  return found;
}

TEST(FoundFeatures, ACraterHasItsPlaceAndSizes) {
  const Bowl& bowl = kBowls.front();
  const std::vector<FoundFeature> found = likely(cratered_sphere({bowl}));
  ASSERT_EQ(found.size(), 1u);
  const FoundFeature& f = found.front();
  EXPECT_NEAR(f.diameter, bowl.diameter, 0.05 * bowl.diameter);
  EXPECT_NEAR(f.depth, bowl.depth, 0.15 * bowl.depth);
  EXPECT_NEAR(f.rim_height, bowl.rim, 0.5 * bowl.rim);
  EXPECT_LT(norm(f.place - (1.0 - bowl.depth) * normalized(bowl.direction)), 0.03 * bowl.diameter);
  EXPECT_GT(dot(f.normal, normalized(bowl.direction)), 0.99);
  EXPECT_NEAR(f.freshness, (bowl.depth + bowl.rim) / (0.2 * bowl.diameter), 0.1);
  EXPECT_EQ(f.completeness, 1.0);
  EXPECT_GT(f.confidence, 0.9);
}

TEST(FoundFeatures, ASmoothBodyHasNone) {
  EXPECT_TRUE(likely(testing::icosphere(5)).empty());
  EXPECT_TRUE(likely(testing::torus(3.0, 1.0, 160, 64)).empty());
}

TEST(FoundFeatures, ABumpIsNoCrater) {
  const Bowl& bowl = kBowls.front();
  EXPECT_TRUE(likely(cratered_sphere({{bowl.direction, bowl.diameter, -bowl.depth, -bowl.rim}})).empty());
}

// Half an egg on the ground, between two craters.
TEST(FoundFeatures, ABoulderIsFoundWhereAsked) {
  const Vec3d place = normalized(Vec3d{0.2, -0.3, 1.0});
  TriangleMesh mesh = cratered_sphere({kBowls[0], kBowls[1]});
  for (Vec3d& p : mesh.vertices) {
    const double t = norm(normalized(p) - place) / 0.16;
    if (t < 1.0) p *= 1.0 + 0.1 * std::sqrt(1.0 - t * t);
  }
  FeatureOptions options;
  EXPECT_EQ(likely(mesh, options).size(), 2u);
  options.boulders = true;
  std::vector<FoundFeature> found = likely(mesh, options);
  std::erase_if(found, [](const FoundFeature& f) { return f.sign == BlobSign::hollow; });
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found.front().diameter, 0.32, 0.08);
  EXPECT_NEAR(found.front().depth, 0.1, 0.03);
  EXPECT_LT(norm(found.front().place - 1.1 * place), 0.05);
}

TEST(FoundFeatures, ATurnedAndScaledBodyOfOtherTrianglesHasTheSameCraters) {
  constexpr double kScale = 250.0;
  FeatureOptions options;
  options.points = 12000;
  const std::vector<FoundFeature> found = likely(cratered_sphere(kBowls), options);
  TriangleMesh mesh = cratered_sphere<6>(kBowls);
  const auto turned = [](const Vec3d& p) {
    return kScale * Vec3d{0.6 * p.x - 0.8 * p.z, p.y, 0.8 * p.x + 0.6 * p.z};
  };
  for (Vec3d& p : mesh.vertices) p = turned(p);
  const std::vector<FoundFeature> others = likely(mesh, options);
  ASSERT_EQ(found.size(), kBowls.size());
  ASSERT_EQ(others.size(), kBowls.size());
  for (std::size_t k = 0; k < kBowls.size(); ++k) {
    const double diameter = kScale * found[k].diameter;
    EXPECT_NEAR(others[k].diameter, diameter, 0.04 * diameter);
    EXPECT_LT(norm(others[k].place - turned(found[k].place)), 0.03 * diameter);
    EXPECT_NEAR(others[k].depth, kScale * found[k].depth, 0.1 * kScale * found[k].depth);
  }
}

TEST(FoundFeatures, ThreadsChangeNothing) {
  const TriangleMesh mesh = cratered_sphere(kBowls);
  const auto bits = [&](int threads) {
    const ThreadLimit limit(threads);
    std::vector<double> values;
    for (const FoundFeature& f : find_features(mesh, {}).features)
      for (const double v :
           {f.place.x, f.center.y, f.normal.z, f.diameter, f.depth, f.rim_height, f.confidence})
        values.push_back(v);
    return values;
  };
  const std::vector<double> one = bits(1);
  EXPECT_FALSE(one.empty());
  EXPECT_EQ(bits(2), one);
}

TEST(FoundFeatures, RefusesWhatIsNoSurface) {
  const auto find = [](const TriangleMesh& mesh, std::int64_t points) {
    FeatureOptions options;
    options.points = points;
    find_features(mesh, options);
  };
  EXPECT_EQ(testing::refusal_text([&] { find(testing::icosphere(2), 0); }),
            "features: needs a mesh of 1000 triangles or more; this one has 320");
  EXPECT_EQ(testing::refusal_text([&] { find(testing::icosphere(4), 10); }),
            "features: points must be 0, or 500 to 1000000");
}

}  // namespace
}  // namespace astrolith
