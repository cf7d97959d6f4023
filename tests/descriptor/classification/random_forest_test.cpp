#include <cmath>
#include <numeric>
#include <opencv2/ml.hpp>

#include "descriptor/classification/forest_conversion_internal.h"
#include "descriptor/classification/principal_components.h"
#include "descriptor/classification/random_forest.h"
#include "descriptor/classification/row_matrix_internal.h"
#include "descriptor/classification/shape_features.h"
#include "geometry/surface/mesh_sampling.h"
#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "numerics/parallel_for.h"
#include "tests/descriptor/classification/clusters.h"
#include "tests/support/meshes.h"

namespace astrolith {
namespace {

using testing::clusters;

bool same(const RandomForest& a, const RandomForest& b) {
  if (a.trees.size() != b.trees.size()) return false;
  for (std::size_t t = 0; t < a.trees.size(); ++t) {
    if (a.trees[t].size() != b.trees[t].size()) return false;
    for (std::size_t i = 0; i < a.trees[t].size(); ++i) {
      const TreeNode &m = a.trees[t][i], &n = b.trees[t][i];
      if (m.feature != n.feature || m.threshold != n.threshold || m.next != n.next) return false;
    }
  }
  return true;
}

TEST(RandomForest, VotesAsOpenCvDoes) {
  const LabelledFeatures data = clusters(4, 25, 6, 0.8, 1), others = clusters(4, 25, 6, 1.2, 2);
  const cv::Ptr<cv::ml::RTrees> trees = cv::ml::RTrees::create();
  trees->setMinSampleCount(2);
  trees->setTermCriteria(cv::TermCriteria(cv::TermCriteria::MAX_ITER, 40, 0));
  cv::Mat labels(100, 1, CV_32S);
  std::copy(data.labels.begin(), data.labels.end(), labels.begin<int>());
  trees->train(cv::ml::TrainData::create(row_matrix(data.rows), cv::ml::ROW_SAMPLE, labels));
  std::vector<int> columns(6);
  std::iota(columns.begin(), columns.end(), 0);
  const RandomForest forest = converted(*trees, columns, 4);
  ASSERT_EQ(forest.trees.size(), 40u);
  for (const LabelledFeatures* set : {&data, &others}) {
    cv::Mat counts;  // a row of labels, then a row of votes for each sample
    trees->getVotes(row_matrix(set->rows), counts, 0);
    for (int i = 0; i < 100; ++i) {
      const std::vector<double> votes = forest.votes(set->rows[static_cast<std::size_t>(i)]);
      for (int c = 0; c < 4; ++c) {
        EXPECT_EQ(std::lround(40 * votes[static_cast<std::size_t>(c)]), counts.at<int>(i + 1, c));
      }
    }
  }
}

TEST(RandomForest, TellsClustersApart) {
  const LabelledFeatures data = clusters(3, 20, 5, 0.1, 1);
  const RandomForest forest = train_forest(data.rows, data.labels, 3, {50, 25, 1});
  const LabelledFeatures fresh = clusters(3, 20, 5, 0.1, 9);
  for (std::size_t i = 0; i < fresh.rows.size(); ++i) {
    const std::vector<double> votes = forest.votes(fresh.rows[i]);
    EXPECT_EQ(winner(votes), fresh.labels[i]);
    EXPECT_NEAR(std::accumulate(votes.begin(), votes.end(), 0.0), 1, 1e-12);
  }
}

TEST(RandomForest, LabelsMayBeMissing) {
  LabelledFeatures data = clusters(3, 20, 5, 0.1, 1);
  for (int& label : data.labels) label = label == 0 ? 1 : label == 1 ? 3 : 4;  // no label is 0 or 2
  const RandomForest forest = train_forest(data.rows, data.labels, 6, {20, 25, 1});
  for (std::size_t i = 0; i < data.rows.size(); ++i)
    EXPECT_EQ(winner(forest.votes(data.rows[i])), data.labels[i]);
}

TEST(RandomForest, SameTreesForAnyThreadCountAndNoOtherSeed) {
  const LabelledFeatures data = clusters(3, 30, 40, 1, 1);
  const RandomForest first = train_forest(data.rows, data.labels, 3, {30, 25, 5});
  std::vector<RandomForest> more(8);
  parallel_for(0, 8, [&](std::int64_t i) {
    more[static_cast<std::size_t>(i)] = train_forest(data.rows, data.labels, 3, {30, 25, 5});
  });
  for (const RandomForest& forest : more) EXPECT_TRUE(same(forest, first));
  EXPECT_FALSE(same(train_forest(data.rows, data.labels, 3, {30, 25, 6}), first));
  train_forest(data.rows, data.labels, 3, {5, 25, 0x61c8864680b583ebu});  // a seed whose hash would be 0
}

TEST(RandomForest, DepthIsABound) {
  const LabelledFeatures data = clusters(3, 30, 5, 2, 1);
  for (const DecisionTree& tree : train_forest(data.rows, data.labels, 3, {10, 1, 1}).trees) {
    EXPECT_LE(tree.size(), 3u);
  }
}

// Only one feature tells the classes apart. A draw of sqrt(#features) of all features would nearly always
// miss it.
TEST(RandomForest, FeaturesThatNeverVaryAreNotDrawn) {
  LabelledFeatures data = clusters(2, 20, 1, 0.05, 1);
  for (auto& row : data.rows) row.insert(row.begin(), 5000, 3.0f);
  const RandomForest forest = train_forest(data.rows, data.labels, 2, {20, 25, 1});
  for (std::size_t i = 0; i < data.rows.size(); ++i)
    EXPECT_EQ(winner(forest.votes(data.rows[i])), data.labels[i]);
}

TEST(RandomForest, RefusesWhatCannotBeLearned) {
  const LabelledFeatures data = clusters(2, 5, 3, 0.1, 1);
  EXPECT_THROW(train_forest(data.rows, data.labels, 1, {}), InputError);
  EXPECT_THROW(train_forest({}, {}, 2, {}), InputError);
  EXPECT_THROW(train_forest(data.rows, data.labels, 2, {0, 25, 1}), InputError);
  EXPECT_THROW(train_forest(data.rows, data.labels, 2, {10, 0, 1}), InputError);
  const FeatureRows equal(10, std::vector<float>(3, 1.0f));
  EXPECT_THROW(train_forest(equal, data.labels, 2, {}), InputError);
}

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

class EveryKind : public ::testing::TestWithParam<FeatureKind> {
 protected:
  FeatureOptions options() const {
    FeatureOptions o = default_features(GetParam());
    o.points = 1500;
    return o;
  }
};

TEST_P(EveryKind, HasItsNameAndSize) {
  EXPECT_EQ(feature_kind_from_name(feature_name(GetParam())), GetParam());
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
  const std::vector<float> point_values = point_features(s.points, s.normals, options());
  EXPECT_EQ(shape_features({s.points, {}, s.normals}, options()), point_values);
  const double itself = feature_distance(GetParam(), a, b), another = feature_distance(GetParam(), a, c);
  EXPECT_LT(4 * itself, another);
  EXPECT_LT(2 * feature_distance(GetParam(), a, point_values), another);
  EXPECT_EQ(feature_distance(GetParam(), a, a), 0);
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
                         [](const auto& kind) { return feature_name(kind.param); });

TEST(ShapeFeatures, OtherNamesAreRefused) { EXPECT_THROW(feature_kind_from_name("d3"), InputError); }

}  // namespace
}  // namespace astrolith
