#include "estimation/shape/details/detail_fitness.h"

#include "cuda/candidates_on_gpu.h"
#include "cuda/device.h"
#include "tests/cuda/host_backend.h"
#include "tests/estimation/shape/details/known_details.h"

namespace astrolith {
namespace {

using testing::three_spheres;
using testing::with_details;

FractalLayer layer_of(Noise noise, double amplitude, double frequency) {
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
    candidates.push_back({layer_of(static_cast<Noise>(noise), 0.002 + 0.001 * noise, 10.0 + 5.0 * noise)});
  }
  candidates.push_back({layer_of(Noise::kSimplex, 0.004, 8.0), layer_of(Noise::kPerlin, 0.003, 20.0),
                        layer_of(Noise::kWorleyF1, 0.002, 15.0)});
  return candidates;
}

void expect_the_scores_of_the_cpu(CandidateEvaluator& evaluator) {
  const TargetBody target = with_details({layer_of(Noise::kSimplex, 0.03, 4.0)}, 50);
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
  expect_the_scores_of_the_cpu(twin);
}

TEST(DetailFitnessOnGpu, ASwarmHasTheScoresOfItsCandidates) {
  const DeviceStatus status = probe_device();
  if (!status.usable) GTEST_SKIP() << "no GPU here: " << status.reason;
  expect_the_scores_of_the_cpu(*candidates_on_gpu());
}

}  // namespace
}  // namespace astrolith
