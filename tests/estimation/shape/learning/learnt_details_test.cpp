#include "estimation/shape/learning/learnt_details.h"

#include <gtest/gtest.h>

#include "numerics/parallel_for.h"
#include "recipe/recipe_json.h"
#include "tests/estimation/shape/details/known_details.h"

namespace astrolith {
namespace {

using testing::three_spheres;

// A body, its mesh and what is spent on it. The small body serves all but one test, since it takes a fifth of
// the time; boulders need the fine one.
struct Size {
  int resolution, points, places;
  double edge;  // of the mesh, evened to the points
};
constexpr Size kSmall{30, 1200, 300, 0.12}, kFine{60, 4000, 600, 0.065};

Recipe known_surface(const SurfaceModel& model, const Size& size = kSmall) {
  Recipe recipe;
  recipe.seed = 77;
  recipe.body = three_spheres();
  recipe.layers = layers_of(model, size.edge);
  return recipe;
}

TargetBody target_of(const Recipe& recipe, const Size& size = kSmall) {
  const ImplicitField field(recipe);
  MeshCollector collector;
  mesh_field(field, field.bounds(), size.resolution, collector);
  return prepare_target(std::move(collector.mesh), "known surface");
}

Recipe known_base() { return known_surface({}); }

LearningOptions quick_learning(const Size& size = kSmall) {
  LearningOptions options;
  options.noise_evaluations = 8;
  options.landform_evaluations = 8;
  options.deciding_seeds = 1;
  options.candidate.most_points = size.points;
  options.candidate.places = size.places;
  return options;
}

SurfaceModel hills_in_edges() {
  SurfaceModel model;
  model.amplitude = 0.5;
  model.wavelength = 16.0;
  model.gain = 0.6;
  return model;
}

const JudgedCandidate* find_candidate(const LearntDetails& learnt, const std::string& name) {
  for (const JudgedCandidate& candidate : learnt.candidates) {
    if (candidate.name == name) return &candidate;
  }
  return nullptr;
}

TEST(LearntDetails, ASmoothBodyGetsNoDetailsThatShow) {
  const LearntDetails learnt = learn_details(target_of(known_base()), known_base(), quick_learning());
  EXPECT_EQ(learnt.model.landforms, LandformKind::none);
  EXPECT_LT(learnt.model.amplitude, 0.01);
  EXPECT_FALSE(learnt.interrupted);
}

TEST(LearntDetails, BouldersAreFoundOnABodyThatHasThemLong) {
  SurfaceModel truth = hills_in_edges();
  truth.amplitude = 0.15;
  truth.landforms = LandformKind::boulders;
  truth.count = 150;
  truth.exponent = 2.5;
  truth.least = 3.0;
  truth.greatest = 12.0;
  LearningOptions options = quick_learning(kFine);
  options.landform_evaluations = 16;
  const LearntDetails learnt =
      learn_details(target_of(known_surface(truth, kFine), kFine), known_base(), options);
  EXPECT_GT(learnt.skewness_lack, 0.05);
  const JudgedCandidate* boulders = find_candidate(learnt, "boulders");
  ASSERT_NE(boulders, nullptr);
  EXPECT_TRUE(boulders->kept) << boulders->reason;
  EXPECT_EQ(learnt.recipe.layers.size(), 3u);
}

TEST(LearntDetails, NoiseAloneGetsNoLandforms) {
  const LearntDetails learnt =
      learn_details(target_of(known_surface(hills_in_edges())), known_base(), quick_learning());
  EXPECT_EQ(learnt.model.landforms, LandformKind::none);
  const JudgedCandidate* noise = find_candidate(learnt, "noise");
  ASSERT_NE(noise, nullptr);
  EXPECT_TRUE(noise->kept) << noise->reason;
}

TEST(LearntDetails, SameLayersForOneAndTwoThreads) {
  const TargetBody target = target_of(known_surface(hills_in_edges()));
  LearningOptions options = quick_learning();
  options.noise_evaluations = 4;
  std::vector<std::string> recipes;
  for (const int threads : {1, 2}) {
    const ThreadLimit limit(threads);
    recipes.push_back(recipe_to_json(learn_details(target, known_base(), options).recipe));
  }
  EXPECT_EQ(recipes[0], recipes[1]);
}

// A search that is stopped keeps its best noise, and one with its log goes on to the same end.
TEST(LearntDetails, AStopKeepsTheBestSoFarAndTheLogGoesOn) {
  const TargetBody target = target_of(known_surface(hills_in_edges()));
  LearningOptions options = quick_learning();
  const std::string whole = recipe_to_json(learn_details(target, known_base(), options).recipe);
  EvaluationLog log;
  options.log = &log;
  const LearntDetails stopped =
      learn_details(target, known_base(), options, [&](double, std::string_view) { return log.size() < 4; });
  EXPECT_TRUE(stopped.interrupted);
  EXPECT_GT(stopped.model.amplitude, 0.0);
  EXPECT_GE(log.size(), 4u);
  const LearntDetails resumed = learn_details(target, known_base(), options);
  EXPECT_EQ(recipe_to_json(resumed.recipe), whole);
}

TEST(LearntDetails, OptionsOutOfRangeAreRefused) {
  LearningOptions options = quick_learning();
  options.deciding_seeds = 0;
  EXPECT_THROW(learn_details(target_of(known_base()), known_base(), options), InputError);
}

}  // namespace
}  // namespace astrolith
