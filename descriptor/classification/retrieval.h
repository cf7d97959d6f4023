// Retrieval: each shape in turn asks for the others of its class. This shows how good a descriptor is without
// any training.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "descriptor/classification/precision_recall.h"
#include "descriptor/classification/principal_components.h"

namespace astrolith {

struct Retrieval {
  double mean_average_precision = 0;  // over the shapes that have others of their class
  double nearest_accuracy = 0;        // share of these shapes whose nearest other is of their class
  PrecisionCurve curve{};             // mean over these shapes
};

using FeatureDistance = std::function<double(std::span<const float>, std::span<const float>)>;

// Every shape ranks all others by their distance to it. labels (#rows) name the classes. Takes time O(#rows^2
// #features).
Retrieval retrieve(const FeatureRows& rows, std::span<const int> labels, const FeatureDistance& distance);

}  // namespace astrolith
