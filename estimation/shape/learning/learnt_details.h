// Learns the details of a body's surface: noise that varies over the body, and boulders or craters where the
// target shows them.
//
//   Recipe recipe;  recipe.body = fit.body;                     // the fitted base, in the file's frame
//   const LearntDetails learnt = learn_details(target, recipe, {});
//   recipe = learnt.recipe;
//
// The steps: 1. Noise is made as rough as the target at each scale, and rough and smooth regions differ as
// much as the target's. 2. CMA-ES searches the five numbers of the noise, on synthesised meshes, by the
// distance of surface statistics (candidate_measure.h). 3. If the target's residuals over a local quadric
// are clearly skewed beside the noise's, boulders (skewed upwards) or craters are added and all nine numbers
// are searched. 4. Fresh seeds of the noise decide. Noise is kept if it is nearer than the bare base.
// Landforms are kept if the distance, the held-out statistic and the histogram's similarity all improve.
// Ground that no camera saw (imaged_ground.h) gets no details, unless they are wanted everywhere.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "estimation/optimize/evaluation_log.h"
#include "estimation/shape/learning/candidate_measure.h"
#include "estimation/shape/learning/surface_model.h"

namespace astrolith {

struct LearningOptions {
  int noise_evaluations = 24;     // of the search of step 2, > 0
  int landform_evaluations = 40;  // of the search of step 3, > 0
  int search_draws = 2;           // of the noise, over which a candidate of the search is measured, > 0
  int deciding_seeds = 3;         // fresh seeds of the noise, > 0
  OptimizerAlgorithm optimizer = OptimizerAlgorithm::cmaes;
  std::uint64_t seed = 1;
  bool everywhere = false;  // details on ground that is smooth in the target, too
  CandidateOptions candidate;
  // The log of both searches, or null. A search with a log that holds values continues where the log ends.
  EvaluationLog* log = nullptr;
};

// A candidate that fresh seeds judged; figures are means over them.
struct JudgedCandidate {
  std::string name;  // "bare base", "noise", "boulders" or "craters"
  SurfaceModel model;
  double distance = 0.0, held_out = 0.0, similarity = 0.0, variance_ratio = 0.0;
  double components = 0.0, genus = 0.0;
  bool kept = false;
  std::string reason;  // why it was not kept, for people
};

struct LearntDetails {
  SurfaceModel model;          // that was taken; without amplitude and landforms where the bare base is best
  Recipe recipe;               // the base with the learnt layers
  double smooth_share = 0.0;   // of the surface, without details since the target has none there
  double edge = 0.0;           // that the model's lengths count in, the file's unit
  double skewness_lack = 0.0;  // mean skewness within 3 and 6 edges, of the target less that of the noise
  std::vector<JudgedCandidate> candidates;
  std::int64_t evaluations = 0;
  std::vector<double> history;  // best distance after each generation, of both searches
  bool interrupted = false;     // progress asked to stop; the layers are the best so far
};

// `base` holds the fitted body in the file's frame; its seed is the noise's. The same target, base and
// options give the same layers for every number of threads. Throws InputError "parameter: range" for an
// option out of range, and as surface_statistics() does for a target that it refuses.
LearntDetails learn_details(const TargetBody& target, const Recipe& base, const LearningOptions& options,
                            const Progress& progress = {});

// What was learnt, in sentences for people. `scale` times a length of the recipe is one in `unit`.
std::vector<std::string> learnt_words(const LearntDetails& learnt, double scale, const std::string& unit);

}  // namespace astrolith
