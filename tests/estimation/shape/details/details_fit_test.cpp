#include "estimation/shape/details/details_fit.h"

#include <cmath>

#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "synthesis/field/implicit_field.h"
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

}  // namespace
}  // namespace astrolith
