// Labelled feature vectors that are easy to tell apart: class c lies around the point c in every feature.
#pragma once

#include "descriptor/classification/shape_classifier.h"
#include "numerics/hash_random.h"

namespace astrolith::testing {

// Classes a, b, ...; spread is the standard deviation of each feature.
inline LabelledFeatures clusters(int classes, int shapes_each, int features, double spread,
                                 std::uint64_t seed) {
  LabelledFeatures data;
  CounterRandom random(seed);
  for (int c = 0; c < classes; ++c) {
    data.classes.push_back(std::string(1, static_cast<char>('a' + c)));
    for (int i = 0; i < shapes_each; ++i) {
      data.labels.push_back(c);
      data.rows.emplace_back();
      for (int f = 0; f < features; ++f)
        data.rows.back().push_back(static_cast<float>(c + spread * random.normal()));
    }
  }
  return data;
}

}  // namespace astrolith::testing
