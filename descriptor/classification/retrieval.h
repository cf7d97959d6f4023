// Retrieval: each shape in turn asks for the others of its class. This shows how good a descriptor is without
// any training.
//
// Among the first K entries of a ranked list, precision is the share of entries that are relevant. Recall is
// the share of all relevant entries that are among them.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "descriptor/classification/principal_components.h"

namespace astrolith {

// The number of recall levels of a curve: 0, 0.05, ... 1.
inline constexpr int kRecallLevels = 21;
using PrecisionCurve = std::array<double, kRecallLevels>;

struct PrecisionRecall {
  // The sum over the list of (recall step) x (precision there). This is the area under the curve, and 1 when
  // all relevant entries come first.
  double average_precision = 0;
  // At each level: the highest precision that is reached at this recall or a higher one.
  PrecisionCurve curve{};
};

// Ranks entries by `scores` (n), the highest first; relevant (n). Entries of equal score come together, so
// that their order does not matter. Everything is 0 when no entry is relevant.
PrecisionRecall precision_recall(std::span<const double> scores, const std::vector<bool>& relevant);

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
