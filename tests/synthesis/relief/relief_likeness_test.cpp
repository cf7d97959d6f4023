#include "synthesis/relief/relief_likeness.h"

#include <cmath>
#include <set>
#include <utility>

#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "numerics/parallel_for.h"
#include "synthesis/relief/patch_features.h"
#include "synthesis/relief/patch_samples.h"
#include "synthesis/relief/relief_donors.h"
#include "synthesis/relief/relief_patches.h"
#include "synthesis/relief/relief_values.h"
#include "synthesis/relief/sliced_transport.h"
#include "tests/support/refusal.h"
#include "tests/synthesis/bodies.h"
#include "tests/synthesis/reliefs.h"

namespace astrolith {
namespace {

using testing::find_places;
using testing::position;
using testing::potato_recipe;

constexpr double kSpacing = 0.018, kEdge = kSpacing / 1.2;

// A body with heights at its places: waves of many lengths, rough on the side of +x.
struct Rough {
  Recipe recipe;
  ArrayStore arrays;
  BodyTables body = make_body(*recipe.body, recipe.seed, arrays);
  ReachingMetaballs metaballs = all_metaballs(body, arrays.view());
  BodyGround ground{body, arrays.view(), metaballs.lists()};
  std::vector<ReliefPlace> places = find_places(recipe, kSpacing);
  ReliefTiles tiles = make_relief_tiles(places, "test");
  std::vector<double> heights;

  explicit Rough(Recipe of = potato_recipe(60, 5)) : recipe(std::move(of)) {
    for (const ReliefPlace& p : places) {
      const Vec3d at = position(p, kSpacing);
      const double wide = std::sin(17.0 * at.x) * std::sin(15.0 * at.y) * std::sin(16.0 * at.z);
      const double narrow = std::sin(80.0 * at.x + 7.0 * at.y) * std::sin(75.0 * at.y - 9.0 * at.z);
      heights.push_back(0.004 * wide + (at.x > 0.0 ? 0.004 : 0.001) * narrow);
    }
  }
  ReliefPatches patches(double edge = kEdge) const {
    return {{ground, places, tiles, heights}, kSpacing, edge};
  }
  std::vector<double> like(std::uint32_t seed, double edge = kEdge) const {
    return like_heights(places, tiles, patches(edge), false, kSpacing, {0.3, false, seed}, "test");
  }
};

double mean_square(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v * v;
  return sum / static_cast<double>(values.size());
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum / static_cast<double>(a.size()) / std::sqrt(mean_square(a) * mean_square(b));
}

// The mean square of the heights on the side of +x, over that on the other.
double contrast(const Rough& rough, const std::vector<double>& heights) {
  std::vector<double> front, back;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const double x = position(rough.places[i], kSpacing).x;
    if (std::fabs(x) > 0.2) (x > 0.0 ? front : back).push_back(heights[i]);
  }
  return mean_square(front) / mean_square(back);
}

TEST(ReliefLikeness, DrawsHeightsOfTheSameSizeForOtherPlaces) {
  const Rough rough;
  const std::vector<double> like = rough.like(1), other = rough.like(2);
  EXPECT_NEAR(std::sqrt(mean_square(like) / mean_square(rough.heights)), 1.0, 0.2);
  EXPECT_LT(std::fabs(correlation(like, rough.heights)), 0.2);
  EXPECT_LT(std::fabs(correlation(like, other)), 0.2);
}

TEST(ReliefLikeness, KeepsRoughRegionsWhereTheyAre) {
  const Rough rough;
  EXPECT_GT(contrast(rough, rough.like(1)), 1.5);
  EXPECT_GT(contrast(rough, rough.like(2)), 1.5);
}

// The body with the smooth ground of a side that no camera saw.
struct HalfSeen : Rough {
  HalfSeen() {
    for (std::size_t i = 0; i < heights.size(); ++i) {
      if (position(places[i], kSpacing).x < 0.0) heights[i] = 0.0;
    }
  }
};

TEST(ReliefLikeness, FillsUnseenGroundAndKeepsWhatWasSeen) {
  const HalfSeen rough;
  const std::vector<double> filled = filled_heights(rough.patches(), kSpacing, {0.3, true, 5});
  std::vector<double> far_side, near_side;
  double moved = 0.0;
  for (std::size_t i = 0; i < filled.size(); ++i) {
    const double x = position(rough.places[i], kSpacing).x;
    if (x < -0.3) far_side.push_back(filled[i]);
    if (x > 0.25)
      near_side.push_back(rough.heights[i]), moved = std::max(moved, std::fabs(filled[i] - rough.heights[i]));
  }
  EXPECT_LT(moved, 1e-9);
  EXPECT_NEAR(std::sqrt(mean_square(far_side) / mean_square(near_side)), 1.0, 0.35);
}

TEST(ReliefLikeness, DrawsUnseenGroundFromSeenGround) {
  const HalfSeen rough;
  const auto far_side = [&](bool fill) {
    std::vector<double> heights;
    for (std::uint32_t seed = 5; seed < 8; ++seed) {
      const std::vector<double> like = like_heights(rough.places, rough.tiles, rough.patches(), false,
                                                    kSpacing, {0.3, fill, seed}, "test");
      for (std::size_t i = 0; i < like.size(); ++i) {
        if (position(rough.places[i], kSpacing).x < -0.3) heights.push_back(like[i]);
      }
    }
    return std::sqrt(mean_square(heights) / mean_square(rough.heights));
  };
  EXPECT_LT(far_side(false), 0.35);  // the bends of the base, in other places
  EXPECT_GT(far_side(true), 0.8);
}

TEST(ReliefLikeness, LeavesGroundThatWasSeenEverywhereAsItIs) {
  const Rough rough;
  EXPECT_EQ(filled_heights(rough.patches(), kSpacing, {0.3, true, 5}), rough.heights);
}

TEST(ReliefLikeness, KeepsAConstantHeightOnABaseWithoutBends) {
  Rough even(testing::sphere_recipe(0.4));
  even.heights.assign(even.places.size(), 0.01);
  const std::vector<double> like = even.like(3);
  for (std::size_t i = 0; i < like.size(); ++i) {
    if (even.places[i].weight < 32768) continue;  // others count for little
    ASSERT_NEAR(like[i], 0.01, 3e-4);
  }
}

TEST(ReliefLikeness, LaysTheHeightsOnAnotherBody) {
  const Rough rough;
  Recipe ball = testing::sphere_recipe(0.4);
  const std::vector<ReliefPlace> places = find_places(ball, kSpacing);
  const ReliefTiles tiles = make_relief_tiles(places, "test");
  double squares = 0.0;
  for (std::uint32_t seed = 0; seed < 3; ++seed) {
    const std::vector<double> heights =
        like_heights(places, tiles, rough.patches(), true, kSpacing, {0.3, false, seed}, "test");
    ASSERT_EQ(heights.size(), places.size());
    squares += mean_square(heights) / 3.0;
  }
  EXPECT_NEAR(std::sqrt(squares / mean_square(rough.heights)), 1.0, 0.3);
}

// Rows of numbers with a mean and correlated columns, some of them skewed.
std::vector<float> skewed_rows(std::size_t n, float mean, float slope, std::uint64_t seed) {
  CounterRandom random(seed, 1);
  std::vector<float> rows;
  for (std::size_t r = 0; r < n; ++r) {
    const auto a = static_cast<float>(random.normal()), b = static_cast<float>(random.normal());
    rows.insert(rows.end(), {mean + a, slope * a + 0.5f * b, slope * a * a});
  }
  return rows;
}

// The mean of one column, and of the product of two.
std::pair<double, double> moments(const std::vector<float>& rows, std::size_t first, std::size_t second) {
  double mean = 0.0, product = 0.0;
  for (std::size_t r = 0; r < rows.size(); r += 3)
    mean += double{rows[r + first]}, product += double{rows[r + first]} * double{rows[r + second]};
  const double n = static_cast<double>(rows.size()) / 3.0;
  return {mean / n, product / n};
}

TEST(SlicedTransport, MovesRowsUntilTheyAreDistributedAsMeasured) {
  const std::vector<float> measured = skewed_rows(3000, 2.0f, 1.5f, 1);
  const SlicedTransport transport(measured, 3, 0.0);
  std::vector<float> rows = skewed_rows(2000, -1.0f, 0.2f, 2);
  for (std::uint32_t step = 0; step < 40; ++step) {
    const std::vector<float> changes = transport.changes(rows, step);
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i] += changes[i];
  }
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = 0; b < 3; ++b) {
      EXPECT_NEAR(moments(rows, a, b).first, moments(measured, a, b).first, 0.05);
      EXPECT_NEAR(moments(rows, a, b).second, moments(measured, a, b).second, 0.2);
    }
  }
}

TEST(SlicedTransport, WantsNothingOfRowsThatHaveNoSpread) {
  const SlicedTransport transport(std::vector<float>(300, 1.0f), 3, 0.0);
  EXPECT_EQ(transport.changes({5.0f, 6.0f, 7.0f}, 1), std::vector<float>(3, 0.0f));
}

std::vector<float> random_patches(std::size_t n, std::uint64_t seed) {
  CounterRandom random(seed, 1);
  std::vector<float> patches(n * PatchFeatures::kSamples);
  for (float& value : patches) value = static_cast<float>(random.normal());
  return patches;
}

TEST(PatchFeatures, HaveTheGradientOfTheirDifferences) {
  const PatchFeatures features(random_patches(40, 1), 7);
  std::vector<float> patch = random_patches(1, 2), by(PatchFeatures::kColumns);
  for (std::size_t j = 0; j < by.size(); ++j) by[j] = 0.1f * static_cast<float>(j % 5) - 0.2f;
  const auto sum = [&] {
    const std::vector<float> values = features.of(patch);
    double total = 0.0;
    for (std::size_t j = 0; j < by.size(); ++j) total += double{by[j]} * double{values[j]};
    return total;
  };
  const std::vector<float> gradient = features.gradient(patch, by);
  constexpr float kStep = 5e-3f;
  for (std::size_t k = 3; k < PatchFeatures::kSamples; k += 41) {
    const float at = patch[k];
    patch[k] = at + kStep;
    const double above = sum();
    patch[k] = at - kStep;
    const double below = sum();
    patch[k] = at;
    EXPECT_NEAR(gradient[k], (above - below) / (2.0 * double{kStep}), 3e-3);
  }
}

TEST(PatchSamples, LeaveOutWhatAQuadricHasAndGiveBackMeans) {
  const Rough rough(testing::sphere_recipe(0.4));
  const ReliefPoints points(rough.places, kSpacing);
  const PatchSamples samples(points, {8, kEdge, kEdge}, 300, 5);
  EXPECT_GT(samples.patches(), 280u);
  std::vector<double> slope;
  for (std::size_t i = 0; i < points.size(); ++i)
    slope.push_back(1.0 + 0.2 * points.at(i).x + 0.2 * points.at(i).y);
  const std::vector<float> left = samples.of(slope, 1.0);
  EXPECT_LT(mean_square({left.begin(), left.end()}), 2e-6);
  const std::vector<double> means =
      PlaceMeans(samples, points.size()).of(std::vector<float>(samples.patches() * 64, 3.0f));
  for (const double mean : means) ASSERT_TRUE(mean == 0.0 || std::fabs(mean - 3.0) < 1e-5);
}

TEST(ReliefLikeness, MatchesThePatchesOfTheMeasuredSurface) {
  const Rough rough(testing::sphere_recipe(0.4));
  const ReliefPoints points(rough.places, kSpacing);
  const ReliefValues blend(points, ReliefShares(rough.places, rough.tiles, kSpacing));
  const PatchSamples samples(points, {8, kEdge, kEdge}, 2000, 9);
  const SlicedTransport transport(samples.of(blend.evaluate(rough.heights), 1.0 / kEdge), 64, 1e-4);
  const auto distance = [&](bool matched) {
    double sum = 0.0;
    for (std::uint32_t seed = 1; seed <= 4; ++seed) {
      const std::vector<double> heights = like_heights(rough.places, rough.tiles, rough.patches(), false,
                                                       kSpacing, {0.3, false, seed, matched}, "test");
      const std::vector<float> patches = samples.of(blend.evaluate(heights), 1.0 / kEdge);
      for (std::uint32_t hash = 0; hash < 4; ++hash)
        for (const float change : transport.changes(patches, hash)) sum += double{change} * double{change};
    }
    return sum;
  };
  EXPECT_LT(distance(true), 0.8 * distance(false));
}

// A base that no line of the lattice meets has no places.
TEST(ReliefLikeness, HasNoHeightsOnABodySmallerThanTheSpacing) {
  const Rough rough;
  EXPECT_TRUE(like_heights({}, {}, rough.patches(), true, kSpacing, {}, "test").empty());
}

TEST(ReliefLikeness, IsTheSameForAnyThreadCount) {
  const Rough rough;
  std::vector<double> single_heights;
  {
    const ThreadLimit limit(1);
    single_heights = rough.like(1);
  }
  const ThreadLimit limit(3);
  EXPECT_EQ(rough.like(1), single_heights);
}

TEST(ReliefLikeness, RefusesABodyOfFewPatches) {
  const Rough rough;
  const std::string refused = testing::refusal_text([&] { rough.like(1, 0.1); });
  EXPECT_TRUE(testing::has(refused, "test: the body has room for 4 patches of its relief"));
}

TEST(ReliefAnchors, LieApartAndReachEveryPlace) {
  const Rough rough;
  const ReliefPoints points(rough.places, kSpacing);
  const double distance = 0.15;
  const std::vector<ReliefAnchor> anchors = relief_anchors(points, distance);
  std::set<std::uint32_t> reached;
  for (const ReliefAnchor& a : anchors) {
    EXPECT_NEAR(dot(cross(a.right, a.ahead), a.up), 1.0, 1e-6);
    points.for_each_near(a.at, a.up, distance, [&](std::uint32_t k, double, double) { reached.insert(k); });
    for (const ReliefAnchor& b : anchors) {
      const bool others = &a != &b && dot(a.up, b.up) > 0.0;
      EXPECT_TRUE(!others || norm(a.at - b.at) >= distance);
    }
  }
  EXPECT_EQ(reached.size(), points.size());
}

TEST(ReliefDonors, LieWithinReachAndAreAsRough) {
  const Rough rough;
  const ReliefPatches patches = rough.patches();
  const ReliefDonors donors(patches, patches.anchors(), 0.3, false);
  const double apart = patches.anchor_spacing().distance();
  Box box;
  for (const ReliefAnchor& a : patches.anchors()) box.extend(a.at);
  double unlike = 0.0, all = 0.0;
  for (const ReliefAnchor& a : patches.anchors()) {
    const std::vector<ReliefDonor> drawn = donors.candidates(a, 16, 7), again = donors.candidates(a, 16, 7);
    ASSERT_EQ(drawn.size(), 16u);
    EXPECT_EQ(drawn[3].middle.place, again[3].middle.place);
    for (const ReliefDonor& donor : drawn) {
      EXPECT_GE(norm(donor.middle.at - a.at), apart);
      EXPECT_LE(norm(donor.middle.at - a.at), 0.3 * box.diagonal());
      unlike += std::fabs(
          std::log(patches.squares_around()[donor.middle.place] / patches.squares_around()[a.place]));
      all += 1.0;
    }
  }
  EXPECT_LT(unlike / all, 0.35);
}

}  // namespace
}  // namespace astrolith
