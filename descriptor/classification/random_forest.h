// A random forest (Breiman 2001): OpenCV grows the trees, plain arrays keep them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "descriptor/classification/principal_components.h"

namespace astrolith {

struct ForestOptions {
  int trees = 500;         // the more, the steadier the votes; 1 to 10,000
  int depth = 25;          // at most so many decisions in a row, 1 to 60
  std::uint64_t seed = 1;  // of what each tree sees
};

// Throws InputError when a number is outside its range above.
void check(const ForestOptions& options);

struct TreeNode {
  std::int32_t feature = -1;  // -1: a leaf
  float threshold = 0;        // up to here go left, to the node that follows; beyond, right
  std::int32_t next = 0;      // the right node's index, or the class of a leaf
};
using DecisionTree = std::vector<TreeNode>;  // from the root, each node's left side before its right one

struct RandomForest {
  int classes = 0;
  std::vector<DecisionTree> trees;

  // (classes) the share of trees that vote for each class.
  std::vector<double> votes(std::span<const float> features) const;
};

// The class with most votes, of equal ones the first.
int winner(std::span<const double> votes);

// labels (#rows) in 0 .. classes - 1. Each split is the best of sqrt(#features) drawn features, of those that
// vary over the rows; each tree sees as many rows as there are, drawn with replacement. The same for any
// thread count. Throws InputError for fewer than two classes or when no feature varies.
RandomForest train_forest(const FeatureRows& rows, std::span<const int> labels, int classes,
                          const ForestOptions& options);

}  // namespace astrolith
