#include "descriptor/classification/random_forest.h"

#include <algorithm>
#include <opencv2/ml.hpp>
#include <string>

#include "descriptor/classification/forest_conversion_internal.h"
#include "descriptor/classification/row_matrix_internal.h"
#include "numerics/errors.h"

namespace astrolith {
namespace {

// The columns that vary over the rows. Most of 15,625 bins stay empty in every shape, and features drawn from
// them would be wasted.
std::vector<int> varying_columns(const FeatureRows& rows) {
  std::vector<int> columns;
  for (std::size_t c = 0; c < rows.front().size(); ++c) {
    const auto differs = [&](const std::vector<float>& row) { return row[c] != rows.front()[c]; };
    if (std::any_of(rows.begin(), rows.end(), differs)) columns.push_back(static_cast<int>(c));
  }
  return columns;
}

FeatureRows only_columns(const FeatureRows& rows, const std::vector<int>& columns) {
  FeatureRows kept(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    kept[i].reserve(columns.size());
    for (const int c : columns) kept[i].push_back(rows[i][static_cast<std::size_t>(c)]);
  }
  return kept;
}

cv::Ptr<cv::ml::RTrees> untrained(const ForestOptions& options) {
  cv::Ptr<cv::ml::RTrees> trees = cv::ml::RTrees::create();
  trees->setMaxDepth(options.depth);
  trees->setMinSampleCount(2);
  trees->setActiveVarCount(0);  // the square root of the number of features
  trees->setTermCriteria(cv::TermCriteria(cv::TermCriteria::MAX_ITER, options.trees, 0));
  return trees;
}

}  // namespace

void check(const ForestOptions& options) {
  if (options.trees < 1 || options.trees > 10000) {
    throw InputError("forest: " + std::to_string(options.trees) + " trees; give between 1 and 10000");
  }
  if (options.depth < 1 || options.depth > 60) {
    throw InputError("forest: depth " + std::to_string(options.depth) + "; give between 1 and 60");
  }
}

std::vector<double> RandomForest::votes(std::span<const float> features) const {
  std::vector<double> counts(static_cast<std::size_t>(classes), 0.0);
  for (const DecisionTree& tree : trees) {
    std::size_t at = 0;
    while (tree[at].feature >= 0) {
      const bool left = features[static_cast<std::size_t>(tree[at].feature)] <= tree[at].threshold;
      at = left ? at + 1 : static_cast<std::size_t>(tree[at].next);
    }
    ++counts[static_cast<std::size_t>(tree[at].next)];
  }
  for (double& count : counts) count /= static_cast<double>(trees.size());
  return counts;
}

int winner(std::span<const double> votes) {
  return static_cast<int>(std::max_element(votes.begin(), votes.end()) - votes.begin());
}

RandomForest train_forest(const FeatureRows& rows, std::span<const int> labels, int classes,
                          const ForestOptions& options) {
  check(options);
  if (classes < 2 || rows.size() < 2 || rows.size() != labels.size()) {
    throw InputError("forest: " + std::to_string(rows.size()) + " shapes of " + std::to_string(classes) +
                     " classes; give at least two classes, and a label for each shape");
  }
  const std::vector<int> columns = varying_columns(rows);
  if (columns.empty()) throw InputError("forest: all shapes have the same features; give shapes that differ");
  cv::Mat responses(static_cast<int>(labels.size()), 1, CV_32S);
  std::copy(labels.begin(), labels.end(), responses.begin<int>());
  const cv::Ptr<cv::ml::RTrees> trees = untrained(options);
  cv::theRNG().state = options.seed * 0x9e3779b97f4a7c15u + 1;  // never 0, from which OpenCV's numbers stay 0
  try {
    trees->train(
        cv::ml::TrainData::create(row_matrix(only_columns(rows, columns)), cv::ml::ROW_SAMPLE, responses));
  } catch (const cv::Exception& e) {
    throw WorkError(std::string("forest: training failed: ") + e.what());
  }
  return converted(*trees, columns, classes);
}

}  // namespace astrolith
