// Surface details for a fitted base (thesis section 4.3.5): fractal layers of Perlin, simplex and Worley
// noise whose 34 parameters an optimiser chooses by the fitness of detail_fitness.h.
//
// A histogram of few bins leaves amplitudes and frequencies loose, and 34 numbers are many for two thousand
// evaluations. So the search does not begin blind: for each noise alone, and each number of octaves, the
// amplitude, frequency and gain that give the target's roughness over the base are known in closed form
// (roughness.h), and the best of these is one of the optimiser's first candidates.
#pragma once

#include <vector>

#include "estimation/optimize/evaluation_log.h"
#include "estimation/shape/details/detail_fitness.h"

namespace astrolith {

struct DetailsFitOptions {
  OptimizerAlgorithm optimizer = OptimizerAlgorithm::pso;
  int population = 20;    // > 0
  int generations = 100;  // population * generations evaluations, > 0
  std::uint64_t seed = 1;
  FitnessOptions fitness;
  EvaluationLog* log = nullptr;  // of the search: a log that holds values begins where it ended
  CandidateEvaluator* swarm =
      nullptr;  // measures whole generations of the search; null: the CPU does, with the same bits
};

struct DetailsFitResult {
  std::vector<FractalLayer> layers;  // in the target's frame; none where the bare base is best
  PlainNoise start;                  // what the search began with
  DetailRanges ranges;               // what it searched
  DetailScore base_score, start_score, score;
  std::vector<double> lags;                         // fractions of the diagonal
  std::vector<double> target_roughness, roughness;  // of each lag, fractions of the diagonal
  OptimizeResult optimization;
  bool interrupted = false;  // progress asked to stop; the layers are the best so far
};

// `base` in the target's frame. The same target, base and options give the same layers for every number of
// threads. Throws InputError for options out of range.
DetailsFitResult fit_details(const TargetBody& target, const MetaballBody& base,
                             const DetailsFitOptions& options, const Progress& progress = {});

// From the target's frame to that of its file, numbers rounded as a recipe stores them.
std::vector<FractalLayer> layers_in_file_frame(std::vector<FractalLayer> layers, const TargetBody& target);

}  // namespace astrolith
