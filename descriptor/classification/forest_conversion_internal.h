// Converts OpenCV's trained trees to the arrays of RandomForest.
#pragma once

#include <algorithm>
#include <opencv2/ml.hpp>
#include <utility>
#include <vector>

#include "descriptor/classification/random_forest.h"

namespace astrolith {

inline DecisionTree converted_tree(const cv::ml::DTrees& trees, int root, const std::vector<int>& columns) {
  const auto& nodes = trees.getNodes();
  const auto& splits = trees.getSplits();
  DecisionTree tree;
  std::vector<std::pair<int, int>> open{{root, -1}};  // a node, and the parent if the node is its right side
  while (!open.empty()) {
    const auto [index, parent] = open.back();
    open.pop_back();
    if (parent >= 0) tree[static_cast<std::size_t>(parent)].next = static_cast<std::int32_t>(tree.size());
    const auto& node = nodes[static_cast<std::size_t>(index)];
    if (node.split < 0) {
      // The value of a node is the label itself, whereas classIdx counts only labels that occurred.
      tree.push_back({-1, 0, static_cast<std::int32_t>(node.value)});
      continue;
    }
    const auto& split = splits[static_cast<std::size_t>(node.split)];
    tree.push_back({columns[static_cast<std::size_t>(split.varIdx)], split.c, 0});
    open.emplace_back(node.right, static_cast<int>(tree.size()) - 1);
    open.emplace_back(node.left, -1);
  }
  return tree;
}

// columns[v] is the feature that variable v was trained on.
inline RandomForest converted(const cv::ml::DTrees& trees, const std::vector<int>& columns, int classes) {
  RandomForest forest;
  forest.classes = classes;
  for (const int root : trees.getRoots()) forest.trees.push_back(converted_tree(trees, root, columns));
  return forest;
}

}  // namespace astrolith
