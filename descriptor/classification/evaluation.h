// Cross-validation: votes on shapes by classifiers that have not seen them, and how well votes agree with the
// true classes.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "descriptor/classification/retrieval.h"
#include "descriptor/classification/shape_classifier.h"
#include "numerics/progress.h"

namespace astrolith {

using VoteRows = std::vector<std::vector<double>>;  // (#shapes x #classes)

struct ClassScore {
  int shapes = 0;           // number of shapes of this class
  double precision = 0;     // share of true members among the shapes called this class; 0 if none
  double recall = 0;        // share of the shapes of this class that are called so
  PrecisionRecall ranking;  // all shapes, ranked by their votes for this class
};

struct Evaluation {
  int shapes = 0;
  double accuracy = 0;                      // share of shapes whose class got most votes
  double mean_average_precision = 0;        // over the classes
  std::vector<std::vector<int>> confusion;  // (#classes x #classes) [true][called]
  std::vector<ClassScore> classes;          // (#classes)
};

// Evaluates votes on shapes whose true labels (#shapes) are in 0 .. classes - 1.
Evaluation evaluate(const VoteRows& votes, std::span<const int> labels, int classes);

// (#labels) the fold 0 .. folds - 1 of each shape. The shapes of every class are shuffled and dealt out, so
// that all folds hold the classes in shares as equal as possible.
std::vector<int> stratified_folds(std::span<const int> labels, int classes, int folds, std::uint64_t seed);

// (#shapes x #classes) the votes on each shape by a classifier trained on the other folds. Principal
// components are fitted to the other folds alone too. Throws InputError unless 2 <= folds <= #shapes, and for
// a class with fewer than two shapes. Throws WorkError when progress asks to stop.
VoteRows cross_validate(const LabelledFeatures& data, const TrainingOptions& options, int folds,
                        std::uint64_t seed, const Progress& progress = {});

}  // namespace astrolith
