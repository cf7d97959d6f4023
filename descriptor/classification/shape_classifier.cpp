#include "descriptor/classification/shape_classifier.h"

namespace astrolith {

std::vector<double> ShapeClassifier::votes(std::span<const float> shape) const {
  return components ? forest.votes(components->apply(shape)) : forest.votes(shape);
}

ShapeClassifier train_classifier(const LabelledFeatures& data, const FeatureOptions& features,
                                 const TrainingOptions& options) {
  ShapeClassifier classifier{features, data.classes, {}, {}};
  const int classes = static_cast<int>(data.classes.size());
  if (options.components == 0) {
    classifier.forest = train_forest(data.rows, data.labels, classes, options.forest);
    return classifier;
  }
  classifier.components = principal_components(data.rows, options.components);
  FeatureRows reduced;
  for (const std::vector<float>& row : data.rows) reduced.push_back(classifier.components->apply(row));
  classifier.forest = train_forest(reduced, data.labels, classes, options.forest);
  return classifier;
}

}  // namespace astrolith
