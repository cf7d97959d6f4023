// Measures how well votes agree with the true classes.
#pragma once

#include <span>
#include <vector>

#include "descriptor/classification/precision_recall.h"

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

}  // namespace astrolith
