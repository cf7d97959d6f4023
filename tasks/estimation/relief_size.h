// How fine the heights of a relief are: as the model, at a spacing that is given, or as bytes allow.
#pragma once

#include <cstddef>
#include <string>

#include "estimation/shape/relief/relief_fit.h"
#include "estimation/shape/target/target_body.h"
#include "numerics/progress.h"
#include "recipe/recipe.h"
#include "tasks/job/option_table.h"

namespace astrolith {

// A spacing as a person writes it: "auto", "12.5" in the mesh's unit, "3 m", "0.01km", or "1.5edges", mean
// edges of the model. The rule refuses other words.
ValueRule relief_spacing_words();
// Its length in `unit`, of a model with this mean edge; 0 for "auto". Expects words that the rule allows.
double parse_relief_spacing(const std::string& words, const std::string& unit, double mean_edge);

// Whether the target has facets enough for heights.
bool can_have_relief(const TargetBody& target);
// Throws what add_relief() would throw where it has not.
void expect_relief(const TargetBody& target);

// Adds the heights of the target's surface over the recipe's body (in the file's frame) as a relief layer,
// with the spacing of `words`, unless the work was asked to stop before there were heights. Throws as
// fit_relief().
ReliefFit add_relief(const TargetBody& target, const std::string& words, const Progress& progress,
                     Recipe& recipe);

// Adds heights as above, as many as the model gives reason for and a compact recipe of at most `bytes` bytes
// holds. Throws InputError "bytes: ..." where they leave no room for heights.
ReliefFit add_relief_within(const TargetBody& target, std::size_t bytes, const Progress& progress,
                            Recipe& recipe);

}  // namespace astrolith
