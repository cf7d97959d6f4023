// The results of classifiers and descriptors as JSON, for summaries.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "descriptor/classification/evaluation.h"
#include "descriptor/classification/retrieval.h"
#include "descriptor/classification/shape_features.h"

namespace astrolith {

// The recall at which each number of a "precision_at_recall" stands.
inline nlohmann::ordered_json recall_levels() {
  nlohmann::ordered_json levels = nlohmann::ordered_json::array();
  for (int k = 0; k < kRecallLevels; ++k) levels.push_back(static_cast<double>(k) / (kRecallLevels - 1));
  return levels;
}

inline nlohmann::ordered_json to_json(const FeatureOptions& options) {
  nlohmann::ordered_json json{{"kind", name_of(options.kind)}};
  if (options.kind == FeatureKind::shapedna) {
    json["eigenvalues"] = options.eigenvalues;
  } else {
    json["bins"] = options.bins;
  }
  return json;
}

inline nlohmann::ordered_json to_json(const Evaluation& evaluation, const std::vector<std::string>& classes) {
  nlohmann::ordered_json json{{"shapes", evaluation.shapes},
                              {"accuracy", evaluation.accuracy},
                              {"mean_average_precision", evaluation.mean_average_precision},
                              {"classes", nlohmann::ordered_json::array()},
                              {"confusion", evaluation.confusion}};  // [true][called], classes in their order
  for (std::size_t c = 0; c < classes.size(); ++c) {
    const ClassScore& score = evaluation.classes[c];
    json["classes"].push_back({{"name", classes[c]},
                               {"shapes", score.shapes},
                               {"precision", score.precision},
                               {"recall", score.recall},
                               {"average_precision", score.ranking.average_precision},
                               {"precision_at_recall", score.ranking.curve}});
  }
  return json;
}

inline nlohmann::ordered_json to_json(const Retrieval& retrieval) {
  return {{"mean_average_precision", retrieval.mean_average_precision},
          {"nearest_accuracy", retrieval.nearest_accuracy},
          {"precision_at_recall", retrieval.curve},
          {"recall_levels", recall_levels()}};
}

}  // namespace astrolith
