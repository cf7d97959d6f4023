// Votes on shapes by classifiers that have not seen them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "descriptor/classification/evaluation.h"
#include "descriptor/classification/shape_classifier.h"
#include "numerics/progress.h"

namespace astrolith {

// (#labels) a fold 0 .. folds - 1 for each shape: every class is shuffled and dealt out, so that folds hold
// the classes in equal shares as nearly as can be.
std::vector<int> stratified_folds(std::span<const int> labels, int classes, int folds, std::uint64_t seed);

// (#shapes x #classes) of each shape the votes of a classifier trained on the other folds; principal
// components, too, know the other folds alone. Stopped by its progress it throws WorkError. Throws
// InputError unless 2 <= folds <= #shapes, and for a class with fewer than two shapes.
VoteRows cross_validate(const LabelledFeatures& data, const TrainingOptions& options, int folds,
                        std::uint64_t seed, const Progress& progress = {});

}  // namespace astrolith
