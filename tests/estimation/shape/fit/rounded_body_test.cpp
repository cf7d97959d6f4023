#include "estimation/shape/fit/rounded_body.h"

#include <algorithm>
#include <cmath>

#include "estimation/shape/model/metaball_model.h"
#include "estimation/shape/refinement/rounding.h"
#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "numerics/parallel_for.h"
#include "recipe/recipe_json.h"
#include "tests/support/meshes.h"

namespace astrolith {
namespace {

constexpr int kMetaballs = 40;

// A rough ball of wide metaballs that overlap, and points on its surface.
struct RoughBall {
  TargetBody target = prepare_target(testing::icosphere(4, 250.0, {10, 20, 30}), "ball");
  MetaballModel model;
  FitPoints points;
  RoundingOptions options;

  RoughBall() {
    CounterRandom random(5);
    for (const Vec3d& p : target.mesh.vertices) points.on_surface.push_back(p);
    model.sharpness = 1.5;
    for (int i = 0; i < kMetaballs; ++i) {
      const Vec3d direction{random.normal(), random.normal(), random.normal()};
      model.spheres.push_back({direction * (0.12 / norm(direction)), random.uniform(0.05, 0.15), i % 5 == 4});
    }
    RefinementOptions& refinement = options.refinement;
    refinement.loss_scale = 1e-3;
    refinement.max_iterations = 80;
    static const MetaballModel refined = refine(model, points, refinement).model;  // the same in every test
    model = refined;
    options.length_unit = "m";
    options.check_resolution = 32;
  }
  double model_distance(const MetaballModel& of) const {
    double sum = 0.0;
    for (const double s : model_distances(of, points.on_surface)) sum += std::abs(s);
    return sum / static_cast<double>(points.on_surface.size());
  }
  RoundedBody rounded(std::size_t bytes) {
    options.bytes = bytes;
    return round_body(target, model, points, options);
  }
};

std::size_t compact_bytes(const MetaballBody& body) {
  Recipe recipe;
  recipe.length_unit = "m";
  recipe.body = body;
  return recipe_to_compact(recipe).size();
}

// The model with each number rounded by itself, in units of the file.
MetaballModel rounded_one_by_one(const MetaballModel& model, const TargetBody& target, double step) {
  MetaballModel rounded = model;
  const auto nearest = [&](double x) { return std::round(x / step) * step; };
  for (ModelSphere& s : rounded.spheres) {
    const Vec3d p = target.center + target.diagonal * s.center;
    s.center = (Vec3d{nearest(p.x), nearest(p.y), nearest(p.z)} - target.center) * (1.0 / target.diagonal);
    s.radius = std::max(nearest(target.diagonal * s.radius), step) / target.diagonal;
  }
  return rounded;
}

TEST(RoundedBody, KeepsWithinItsBytes) {
  RoughBall ball;
  double last = 1.0;
  for (const std::size_t bytes : {140u, 200u, 300u}) {
    const RoundedBody rounded = ball.rounded(bytes);
    EXPECT_LE(compact_bytes(rounded.body), bytes);
    EXPECT_GT(compact_bytes(rounded.body), bytes - 8u);
    EXPECT_EQ(rounded.body.num_metaballs(), static_cast<std::size_t>(kMetaballs));
    EXPECT_LT(rounded.mean_distance, last);
    last = rounded.mean_distance;
  }
}

TEST(RoundedBody, MakesUpForMostOfTheRounding) {
  RoughBall ball;
  constexpr double kStep = 4.0;
  const MetaballModel alone = rounded_one_by_one(ball.model, ball.target, kStep);
  const MetaballModel together = ModelRounding(ball.model, ball.points, ball.options.refinement, 1e-2)
                                     .rounded({ball.target.center, ball.target.diagonal}, kStep);
  EXPECT_LT(ball.model_distance(together), 0.6 * ball.model_distance(alone));
}

TEST(RoundedBody, NumbersStandOnTheirStep) {
  RoughBall ball;
  const RoundedBody rounded = ball.rounded(200);
  Recipe recipe;
  recipe.length_unit = "m";
  recipe.body = rounded.body;
  const Recipe from_json = parse_recipe(recipe_to_json(recipe), "r.json");
  EXPECT_EQ(recipe_to_compact(from_json), recipe_to_compact(recipe));
  EXPECT_EQ(recipe_to_json(parse_recipe(recipe_to_compact(recipe), "r.astro")), recipe_to_json(recipe));
}

// Hygiea's fit has this sharpness, the least that the refinement allows.
TEST(RoundedBody, KeepsTheSharpnessOfTheSoftestBlend) {
  RoughBall ball;
  ball.model.sharpness = 0.3;
  EXPECT_EQ(ball.rounded(300).body.blend_exponent, 0.3);
}

TEST(RoundedBody, SameForOneAndTwoThreads) {
  RoughBall ball;
  std::vector<std::string> texts;
  for (const int threads : {1, 2}) {
    const ThreadLimit limit(threads);
    Recipe recipe;
    recipe.body = ball.rounded(180).body;
    texts.push_back(recipe_to_json(recipe));
  }
  EXPECT_EQ(texts[0], texts[1]);
}

std::string to_text(const MetaballBody& body) {
  Recipe recipe;
  recipe.length_unit = "m";
  recipe.body = body;
  return recipe_to_json(recipe);
}

TEST(RoundedBody, KeepsTheDigitsThatMatter) {
  RoughBall ball;
  std::size_t last = 0;
  for (const double loss : {2.0, 0.2, 0.02}) {
    const auto rounded = round_body_to_digits(ball.target, ball.model, ball.points, ball.options, loss);
    ASSERT_TRUE(rounded);
    EXPECT_LE(rounded->mean_distance, (1.0 + loss) * ball.model_distance(ball.model));
    EXPECT_EQ(rounded->body.num_metaballs(), static_cast<std::size_t>(kMetaballs));
    EXPECT_GE(to_text(rounded->body).size(), last);
    last = to_text(rounded->body).size();
  }
}

TEST(RoundedBody, TheDigitsThatMatterAreFewerThanSeven) {
  RoughBall ball;
  const auto rounded = round_body_to_digits(ball.target, ball.model, ball.points, ball.options, 0.2);
  ASSERT_TRUE(rounded);
  MetaballModel in_file = ball.model;
  for (ModelSphere& s : in_file.spheres) {
    s.center = ball.target.center + ball.target.diagonal * s.center;
    s.radius *= ball.target.diagonal;
  }
  // This ball is fitted within a few millionths, so that more digits matter than on a body of rock.
  EXPECT_LT(to_text(rounded->body).size(), to_text(metaball_body(in_file)).size());
}

TEST(RoundedBody, NoDigitsAreEnoughForNoLoss) {
  RoughBall ball;
  EXPECT_FALSE(round_body_to_digits(ball.target, ball.model, ball.points, ball.options, -0.5));
}

TEST(RoundedBody, TooFewBytesAreRefused) {
  RoughBall ball;
  EXPECT_THROW(ball.rounded(60), InputError);
}

}  // namespace
}  // namespace astrolith
