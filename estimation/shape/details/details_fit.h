// Fits surface details to a fitted base (thesis section 4.3.5): fractal layers of Perlin, simplex and Worley
// noise. An optimiser chooses their 34 parameters by the fitness of detail_fitness.h.
//
// A histogram with few bins determines amplitudes and frequencies only loosely, and 34 parameters are many
// for two thousand evaluations. The search therefore starts from a good candidate. For each noise alone, and
// for each number of octaves, roughness.h gives the amplitude, frequency and gain that reproduce the target's
// roughness over the base. The best of these noises is one of the optimiser's first candidates. The recipe of
// base and details is measured by a mesh of it.
#pragma once

#include <cstdint>
#include <vector>

#include "estimation/optimize/evaluation_log.h"
#include "estimation/shape/details/detail_fitness.h"
#include "estimation/shape/fit/fit_check.h"
#include "recipe/recipe.h"

namespace astrolith {

// Like check_fit, for a whole recipe. The recipe is in the frame and the unit of the target's file; the check
// is in the target's frame.
FitCheck check_recipe(const TargetBody& target, const Recipe& recipe, int resolution, std::int64_t samples,
                      std::uint64_t seed);

struct DetailsFitOptions {
  OptimizerAlgorithm optimizer = OptimizerAlgorithm::pso;
  int population = 20;    // > 0
  int generations = 100;  // population * generations evaluations, > 0
  std::uint64_t seed = 1;
  FitnessOptions fitness;
  // The log of the search, or null. A search with a log that holds values continues where the log ends.
  EvaluationLog* log = nullptr;
  // Evaluates whole generations of the search, or null. Without it the CPU does, with the same bits.
  CandidateEvaluator* evaluator = nullptr;
};

struct DetailsFitResult {
  std::vector<FractalLayer> layers;  // in the target's frame; none if the bare base is best
  PlainNoise start;                  // the first candidate of the search
  DetailRanges ranges;               // the ranges of the search
  DetailScore base_score, start_score, score;
  std::vector<double> lags;                         // fractions of the diagonal, ascending
  std::vector<double> target_roughness, roughness;  // (#lags) fractions of the diagonal
  OptimizeResult optimization;
  bool interrupted = false;  // progress asked to stop; the layers are the best so far
};

// `base` is in the target's frame. The same target, base and options give the same layers for every number of
// threads. Throws InputError "parameter: range" for an option out of range.
DetailsFitResult fit_details(const TargetBody& target, const MetaballBody& base,
                             const DetailsFitOptions& options, const Progress& progress = {});

// Moves layers from the target's frame into the frame and unit of the target's file. Numbers are rounded as a
// recipe stores them.
std::vector<FractalLayer> layers_in_file_frame(std::vector<FractalLayer> layers, const TargetBody& target);

}  // namespace astrolith
