// A classifier that learns classes of shapes from labelled feature vectors.
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
  int components = 0;  // principal components in place of the features; 0 = none
  ForestOptions forest;
};

struct ShapeClassifier {
  FeatureOptions features;
  std::vector<std::string> classes;
  std::optional<PrincipalComponents> components;
  RandomForest forest;

  // (#classes) the share of the trees that vote for each class. `shape` is a feature vector made with the
  // options above.
  std::vector<double> votes(std::span<const float> shape) const;
};

// Trains a classifier. Throws InputError as train_forest and principal_components do.
ShapeClassifier train_classifier(const LabelledFeatures& data, const FeatureOptions& features,
                                 const TrainingOptions& options);

}  // namespace astrolith
