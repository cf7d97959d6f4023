#include "synthesis/relief/relief_values.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tests/synthesis/bodies.h"
#include "tests/synthesis/reliefs.h"

namespace astrolith {
namespace {

using testing::find_places;

// A body with the places of a relief.
struct Ground {
  Recipe recipe;
  double spacing;
  ArrayStore arrays;
  BodyTables body = make_body(*recipe.body, recipe.seed, arrays);
  ReachingMetaballs metaballs = all_metaballs(body, arrays.view());
  BodyGround ground{body, arrays.view(), metaballs.lists()};
  std::vector<ReliefPlace> places = find_places(recipe, spacing);
  ReliefPoints points{places, spacing};
  std::vector<double> own = std::vector(places.size(), 0.0);

  Ground(Recipe of, double apart) : recipe(std::move(of)), spacing(apart) {}

  std::vector<double> kept(double height, double scale = 1.0) const {
    std::vector<double> heights(places.size(), height);
    keep_room(ground, points, scale, own, heights);
    return heights;
  }
};

// A ball of radius 1 has room for heights of a tenth. For a change of 1.5 it would need 4.5, and has 2 at
// most.
TEST(ReliefRoom, EndsOnTheOtherSideOfABall) {
  const Ground ball{testing::sphere_recipe(1.0), 0.1};
  for (const double height : ball.kept(-0.1)) EXPECT_EQ(height, -0.1);
  for (const double height : ball.kept(0.1)) EXPECT_EQ(height, 0.1);
  const double most = 1.5 * std::pow((2.0 / 4.5 - 0.3) / 0.7, 2.0);
  for (const double wanted : {-1.5, 1.5}) {
    for (const double height : ball.kept(wanted)) EXPECT_LE(std::fabs(height), most);
  }
  const std::vector<double> whole = ball.kept(-1.5), half = ball.kept(-0.75, 2.0);
  for (std::size_t i = 0; i < whole.size(); ++i) EXPECT_NEAR(2.0 * half[i], whole[i], 1e-9);
}

TEST(ReliefRoom, KeepsOwnHeightsWhereABodyIsThin) {
  Recipe recipe = testing::sphere_recipe(1.0);
  recipe.body->spheres.push_back({{2.2, 0.0, 0.0}, 1.0});  // a neck
  Ground dumbbell{recipe, 0.05};
  std::fill(dumbbell.own.begin(), dumbbell.own.end(), 0.01);
  const std::vector<double> heights = dumbbell.kept(-0.5);
  double thinnest = 1.0;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    thinnest = std::min(thinnest, std::fabs(heights[i] - 0.01));
    if (dumbbell.points.at(i).x < 0.0) {
      EXPECT_LT(heights[i], -0.4);
    }
  }
  EXPECT_LT(thinnest, 0.3);
}

// Where sheets share places, iterations would diverge: here on a plate about as thick as the spacing.
TEST(ReliefValues, StayNearTheValuesOfAThinBody) {
  Recipe recipe = testing::sphere_recipe(1.0);
  recipe.body->spheres.push_back({{0.0, 0.0, 2.02}, 1.02});
  recipe.body->spheres.push_back({{0.9, 0.0, 0.9}, 0.08});
  const Ground plate{recipe, 0.05};
  const ReliefValues blend(plate.points,
                           ReliefShares(plate.places, make_relief_tiles(plate.places, "test"), 0.05));
  std::vector<double> values;
  for (std::size_t i = 0; i < plate.places.size(); ++i)
    values.push_back(std::sin(17.0 * plate.points.at(i).x) * std::sin(40.0 * plate.points.at(i).z));
  for (const double c : blend.solve(values)) EXPECT_LE(std::fabs(c), 3.0);
}

}  // namespace
}  // namespace astrolith
