// Cross-validation: votes on shapes by classifiers that have not seen them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "descriptor/classification/evaluation.h"
#include "descriptor/classification/shape_classifier.h"
#include "numerics/progress.h"

namespace astrolith {

// (#labels) the fold 0 .. folds - 1 of each shape. The shapes of every class are shuffled and dealt out, so
// that all folds hold the classes in shares as equal as possible.
std::vector<int> stratified_folds(std::span<const int> labels, int classes, int folds, std::uint64_t seed);

// (#shapes x #classes) the votes on each shape by a classifier trained on the other folds. Principal
// components are fitted to the other folds alone too. Throws InputError unless 2 <= folds <= #shapes, and for
// a class with fewer than two shapes. Throws WorkError when progress asks to stop.
VoteRows cross_validate(const LabelledFeatures& data, const TrainingOptions& options, int folds,
                        std::uint64_t seed, const Progress& progress = {});

}  // namespace astrolith
