// A random forest (Breiman 2001): OpenCV grows the trees, plain arrays keep them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "descriptor/classification/principal_components.h"

namespace astrolith {

struct ForestOptions {
  int trees = 500;         // 1 to 10,000; more trees give steadier votes
  int depth = 25;          // most decisions in a row, 1 to 60
  std::uint64_t seed = 1;  // decides which rows and features each tree sees
};

// Throws InputError when an option is outside its range above.
void check(const ForestOptions& options);

struct TreeNode {
  std::int32_t feature = -1;  // -1 marks a leaf
  float threshold = 0;        // values up to this go left, to the node that follows; others right
  std::int32_t next = 0;      // index of the right node, or the class of a leaf
};
using DecisionTree = std::vector<TreeNode>;  // root first; each node's left side before its right one

struct RandomForest {
  int classes = 0;
  std::vector<DecisionTree> trees;

  // (classes) the share of the trees that vote for each class.
  std::vector<double> votes(std::span<const float> features) const;
};

// The class with most votes; among equals the first.
int winner(std::span<const double> votes);

// Trains a forest on rows with labels (#rows) in 0 .. classes - 1. Features that do not vary over the rows
// are ignored. Each split is the best of sqrt(#features) features, which are drawn at random. Each tree sees
// as many rows as there are, drawn with replacement. The result does not depend on the number of threads.
// Throws InputError for fewer than two classes and when no feature varies.
RandomForest train_forest(const FeatureRows& rows, std::span<const int> labels, int classes,
                          const ForestOptions& options);

}  // namespace astrolith
