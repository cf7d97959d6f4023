#include <cmath>

#include "cuda/candidates_on_gpu.h"
#include "cuda/device.h"
#include "estimation/shape/details/detail_fitness.h"
#include "estimation/shape/details/detail_parameters.h"
#include "estimation/shape/details/details_fit.h"
#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "recipe/recipe_json.h"
#include "synthesis/field/implicit_field.h"
#include "tests/cuda/host_backend.h"
#include "tests/estimation/shape/details/known_details.h"

namespace astrolith {
namespace {

using testing::measured;
using testing::MeasuredLayers;
using testing::three_spheres;
using testing::with_details;

DetailsFitOptions quick(int generations) {
  DetailsFitOptions options;
  options.population = 8;
  options.generations = generations;
  options.fitness.samples = 600;
  options.fitness.lines = 1500;
  return options;
}

FractalLayer hills(Noise noise, double amplitude, double frequency) {
  FractalLayer layer;
  layer.noise = noise;
  layer.amplitude = amplitude;
  layer.frequency = frequency;
  layer.octaves = 1;
  return layer;
}

// The body is about 4.2 long.
TEST(DetailsFit, FindsAmplitudeAndFrequencyAgain) {
  for (const Noise noise : {Noise::kPerlin, Noise::kSimplex}) {
    const FractalLayer truth = hills(noise, 0.05, 3.0);
    const TargetBody target = with_details({truth}, 90);
    DetailsFitOptions options = quick(2);
    options.fitness.samples = 2000;
    const DetailsFitResult fit = fit_details(target, in_target_frame(target, three_spheres()), options);
    const MeasuredLayers wanted = measured({truth}),
                         found = measured(layers_in_file_frame(fit.layers, target));
    EXPECT_NEAR(found.height / wanted.height, 1.0, 0.1);
    EXPECT_NEAR(found.frequency / wanted.frequency, 1.0, 0.1);
    EXPECT_GT(fit.score.similarity, fit.base_score.similarity);
  }
}

TEST(DetailsFit, ASmoothBodyGetsNoDetailsThatShow) {
  const TargetBody target = with_details({}, 60);
  const DetailsFitResult fit = fit_details(target, in_target_frame(target, three_spheres()), quick(3));
  double amplitude = 0.0;
  for (const FractalLayer& layer : fit.layers) amplitude += std::fabs(layer.amplitude * layer.weight);
  EXPECT_LT(amplitude, 1e-3);
}

TEST(DetailsFit, SameLayersForOneAndTwoThreads) {
  const TargetBody target = with_details({hills(Noise::kSimplex, 0.03, 4.0)}, 60);
  const MetaballBody base = in_target_frame(target, three_spheres());
  for (const auto optimizer : {OptimizerAlgorithm::pso, OptimizerAlgorithm::crs2}) {
    std::vector<DetailsFitResult> fits;
    for (const int threads : {1, 2}) {
      const ThreadLimit limit(threads);
      DetailsFitOptions options = quick(3);
      options.optimizer = optimizer;
      fits.push_back(fit_details(target, base, options));
    }
    EXPECT_EQ(fits[0].optimization.x, fits[1].optimization.x);
    EXPECT_EQ(fits[0].optimization.history, fits[1].optimization.history);
  }
}

TEST(DetailsFit, ALogLetsARunGoOnWhereItStopped) {
  const TargetBody target = with_details({hills(Noise::kSimplex, 0.03, 4.0)}, 60);
  const MetaballBody base = in_target_frame(target, three_spheres());
  const DetailsFitResult whole = fit_details(target, base, quick(6));
  EvaluationLog log;
  DetailsFitOptions options = quick(6);
  options.log = &log;
  int generations = 0;
  const DetailsFitResult part =
      fit_details(target, base, options, [&](double, std::string_view) { return ++generations < 3; });
  EXPECT_TRUE(part.interrupted);
  EXPECT_EQ(log.size(), 24u);
  const DetailsFitResult rest = fit_details(target, base, options);
  EXPECT_EQ(rest.optimization.x, whole.optimization.x);
  EXPECT_EQ(rest.optimization.value, whole.optimization.value);
  EXPECT_EQ(rest.optimization.history, whole.optimization.history);
}

TEST(DetailsFit, LayersMeanTheSameInTheFilesFrame) {
  const TargetBody target = with_details({hills(Noise::kSimplex, 0.03, 4.0)}, 60);
  FractalLayer layer = hills(Noise::kPerlin, 0.01, 20.0);
  layer.scale = {1.2, 0.8, 1.1};
  layer.bias = {0.3, -0.2, 0.5};
  const std::vector<FractalLayer> in_file = layers_in_file_frame({layer}, target);
  Recipe a, b;
  a.body = in_target_frame(target, three_spheres());
  b.body = three_spheres();
  a.layers.push_back(layer);
  b.layers.push_back(in_file[0]);
  const ImplicitField in_frame(a), in_file_frame(b);
  for (int i = 0; i < 50; ++i) {
    const Vec3d p{0.1 * std::sin(i), 0.1 * std::cos(3 * i), 0.1 * std::sin(2 * i)};
    EXPECT_NEAR(in_frame.value(p) * target.diagonal, in_file_frame.value(target.center + target.diagonal * p),
                2e-4);
  }
}

TEST(DetailsFit, RefusesOptionsOutOfRange) {
  const TargetBody target = with_details({}, 40);
  EXPECT_THROW(fit_details(target, in_target_frame(target, three_spheres()), quick(0)), InputError);
}

FractalLayer make_layer(Noise noise, double amplitude, double frequency) {
  FractalLayer layer;
  layer.noise = noise;
  layer.amplitude = amplitude;
  layer.frequency = frequency;
  layer.octaves = 3;
  if (!is_worley(noise)) layer.gradient_modulation = 0.3;
  return layer;
}

// Candidates with each of the noises alone, with no layer, and with several layers.
std::vector<std::vector<FractalLayer>> swarm() {
  std::vector<std::vector<FractalLayer>> candidates{{}};
  for (int noise = 0; noise < 5; ++noise) {
    candidates.push_back({make_layer(static_cast<Noise>(noise), 0.002 + 0.001 * noise, 10.0 + 5.0 * noise)});
  }
  candidates.push_back({make_layer(Noise::kSimplex, 0.004, 8.0), make_layer(Noise::kPerlin, 0.003, 20.0),
                        make_layer(Noise::kWorleyF1, 0.002, 15.0)});
  return candidates;
}

void expect_cpu_scores(CandidateEvaluator& evaluator) {
  const TargetBody target = with_details({make_layer(Noise::kSimplex, 0.03, 4.0)}, 50);
  FitnessOptions options;
  options.samples = 500;
  options.lines = 300;
  const DetailFitness fitness(target, in_target_frame(target, three_spheres()), options);
  const auto candidates = swarm();
  const std::vector<DetailScore> scores = fitness.scores(candidates, evaluator);
  ASSERT_EQ(scores.size(), candidates.size());
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const DetailScore one = fitness.score(candidates[i]);
    EXPECT_EQ(scores[i].similarity, one.similarity) << i;
    EXPECT_EQ(scores[i].roughness_misfit, one.roughness_misfit) << i;
    EXPECT_EQ(scores[i].steepness, one.steepness) << i;
  }
}

TEST(DetailFitness, ASwarmHasTheScoresOfItsCandidates) {
  CandidateEvaluatorOn<HostBackend> twin{HostBackend()};
  expect_cpu_scores(twin);
}

TEST(DetailFitnessOnGpu, ASwarmHasTheScoresOfItsCandidates) {
  const DeviceStatus status = probe_device();
  if (!status.usable) GTEST_SKIP() << "no GPU here: " << status.reason;
  expect_cpu_scores(*candidates_on_gpu());
}

DetailRanges some_ranges() { return {8.0, 80.0, 1e-5, 1e-2, 1.0}; }

TEST(DetailParameters, AreThirtyFourWithinTheirBounds) {
  const Bounds bounds = detail_bounds(some_ranges());
  ASSERT_EQ(bounds.lower.size(), kDetailParameters);
  for (std::size_t which = 0; which < 3; ++which) {
    const auto x = detail_parameters({which, 1e-3, 20.0, 3, 0.4}, some_ranges());
    ASSERT_EQ(x.size(), kDetailParameters);
    for (std::size_t d = 0; d < x.size(); ++d) {
      EXPECT_GE(x[d], bounds.lower[d]) << d;
      EXPECT_LE(x[d], bounds.upper[d]) << d;
    }
  }
}

TEST(DetailParameters, APlainNoiseBecomesOneLayer) {
  for (std::size_t which = 0; which < 3; ++which) {
    const auto layers =
        detail_layers(detail_parameters({which, 1e-3, 10.0, 3, 0.4}, some_ranges()), some_ranges());
    ASSERT_EQ(layers.size(), 1u);
    EXPECT_EQ(layers[0].noise, kDetailNoises[which]);
    EXPECT_NEAR(layers[0].amplitude * layers[0].weight, 1e-3, 1e-12);
    EXPECT_NEAR(layers[0].frequency, 10.0, 1e-9);
    EXPECT_EQ(layers[0].octaves, 3);
    EXPECT_EQ(layers[0].gain, 0.4);
    EXPECT_NEAR(norm(layers[0].scale - Vec3d{1, 1, 1}), 0.0, 1e-12);
  }
}

TEST(DetailParameters, NoOctaveIsFinerThanTheRangesAllow) {
  const auto layers = detail_layers(detail_parameters({0, 1e-3, 30.0, 8, 0.4}, some_ranges()), some_ranges());
  ASSERT_EQ(layers.size(), 1u);
  EXPECT_EQ(layers[0].octaves, 2);  // 30 and 58.5; 114 would be above 80
}

TEST(DetailParameters, SteepnessBoundsTheSlope) {
  FractalLayer layer;
  layer.amplitude = 0.01;
  layer.frequency = 10.0;
  layer.octaves = 2;
  layer.gain = 0.5;
  layer.lacunarity = 2.0;
  EXPECT_NEAR(steepness(std::vector<FractalLayer>{layer}), 2 * 7.0 * 0.1, 1e-12);
  EXPECT_EQ(steepness({}), 0.0);
}

TEST(DetailParameters, EveryCornerOfTheBoxIsAValidRecipe) {
  const Bounds bounds = detail_bounds(some_ranges());
  for (const auto& corner : {bounds.lower, bounds.upper}) {
    Recipe recipe;
    recipe.body.emplace().spheres.push_back({{0, 0, 0}, 1.0});
    for (const FractalLayer& layer : detail_layers(corner, some_ranges())) recipe.layers.push_back(layer);
    EXPECT_NO_THROW(validate_recipe(recipe, "corner"));
  }
}

}  // namespace
}  // namespace astrolith
