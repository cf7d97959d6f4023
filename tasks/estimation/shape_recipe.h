// The steps from a body to its recipe: the base, its details, and the figures of both.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "cuda/candidate_evaluator.h"
#include "estimation/shape/details/details_fit.h"
#include "estimation/shape/fit/shape_fit.h"
#include "estimation/shape/relief/relief_fit.h"
#include "recipe/recipe.h"
#include "tasks/estimation/fit_checkpoint.h"

namespace astrolith {

// The finished base from the checkpoint, or a new one, which the checkpoint keeps unless the fit was
// interrupted or `interrupted` says so.
ShapeFitResult fit_base(const TargetBody& target, const ShapeFitOptions& options, FitCheckpoint& checkpoint,
                        const StageProgress& progress, const std::function<bool()>& interrupted);

// Adds the layers that a search finds to the recipe (in the file's frame, with its body). The optimiser and
// its population are the base fit's; candidates that the log knows are not measured again. `evaluator`
// measures candidates; null: the CPU does.
DetailsFitResult add_searched_details(const TargetBody& target, const ShapeFitOptions& options,
                                      int generations, EvaluationLog& log, CandidateEvaluator* evaluator,
                                      const Progress& progress, Recipe& recipe);

// Measures the whole recipe as the fit measured its base: the fit's check becomes that of the recipe.
void measure_recipe(const TargetBody& target, const Recipe& recipe, const ShapeFitOptions& options,
                    ShapeFitResult& fit);

// Writes the figures of the fit into the provenance, rounded to seven digits.
void note_achieved(const ShapeFitResult& fit, Recipe& recipe);

// The figures of a fit, for summaries. Distances are fractions of the bounding-box diagonal.
nlohmann::ordered_json fit_figures(const ShapeFitResult& fit);

// The figures of a relief: heights, spacing, step, mean distances before and after, lengths in the recipe's
// unit.
nlohmann::ordered_json relief_json(const ReliefFit& relief);

// Another body of the kind of a recipe with a relief, as a report shows it; in the recipe's frame. Empty for
// recipes without a relief, and where a model is too small for patches.
TriangleMesh likeness_for_report(const Recipe& recipe);

// The figures of a search: its evaluations and scores, and the roughness of target and details at each lag.
nlohmann::ordered_json details_json(const DetailsFitResult& details);

}  // namespace astrolith
