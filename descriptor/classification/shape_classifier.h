// Learns to tell classes of shapes apart from labelled feature vectors.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "descriptor/classification/principal_components.h"
#include "descriptor/classification/random_forest.h"
#include "descriptor/classification/shape_features.h"

namespace astrolith {

struct LabelledFeatures {
  std::vector<std::string> classes;  // names
  FeatureRows rows;                  // (#shapes x #features)
  std::vector<int> labels;           // (#shapes) indices into classes
};

struct TrainingOptions {
  int components = 0;  // principal components that the forest sees in place of the features; 0 = none
  ForestOptions forest;
};

struct ShapeClassifier {
  FeatureOptions features;
  std::vector<std::string> classes;
  std::optional<PrincipalComponents> components;
  RandomForest forest;

  // (#classes) shares of the trees, of a feature vector of the options above.
  std::vector<double> votes(std::span<const float> shape) const;
};

// Throws InputError as train_forest and principal_components do.
ShapeClassifier train_classifier(const LabelledFeatures& data, const FeatureOptions& features,
                                 const TrainingOptions& options);

}  // namespace astrolith
