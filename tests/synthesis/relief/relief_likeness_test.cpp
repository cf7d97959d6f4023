#include "synthesis/relief/relief_likeness.h"

#include <cmath>
#include <set>
#include <utility>

#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "synthesis/relief/relief_donors.h"
#include "synthesis/relief/relief_patches.h"
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
    const std::vector<double> like =
        like_heights(rough.places, rough.tiles, rough.patches(), false, kSpacing, {0.3, fill, 5}, "test");
    for (std::size_t i = 0; i < like.size(); ++i) {
      if (position(rough.places[i], kSpacing).x < -0.3) heights.push_back(like[i]);
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
  const std::vector<double> heights =
      like_heights(places, tiles, rough.patches(), true, kSpacing, {}, "test");
  ASSERT_EQ(heights.size(), places.size());
  EXPECT_NEAR(std::sqrt(mean_square(heights) / mean_square(rough.heights)), 1.0, 0.3);
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
