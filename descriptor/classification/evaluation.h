// How well votes agree with the truth.
#pragma once

#include <span>
#include <vector>

#include "descriptor/classification/precision_recall.h"

namespace astrolith {

using VoteRows = std::vector<std::vector<double>>;  // (#shapes x #classes)

struct ClassScore {
  int shapes = 0;           // of this class
  double precision = 0;     // of those called this class, the share that is; 0 where none is called so
  double recall = 0;        // of this class, the share called so
  PrecisionRecall ranking;  // of all shapes by their votes for this class
};

struct Evaluation {
  int shapes = 0;
  double accuracy = 0;                      // share of shapes whose class got most votes
  double mean_average_precision = 0;        // over the classes
  std::vector<std::vector<int>> confusion;  // (#classes x #classes) [true][called]
  std::vector<ClassScore> classes;          // (#classes)
};

// labels (#shapes) in 0 .. classes - 1.
Evaluation evaluate(const VoteRows& votes, std::span<const int> labels, int classes);

}  // namespace astrolith
