// Precision and recall of a ranked list, for retrieval and for votes.
//
// Of the first K of the list, precision is the share that is relevant, recall the share of everything
// relevant that is among them.
#pragma once

#include <array>
#include <span>
#include <vector>

namespace astrolith {

// Recall levels 0, 0.05, ... 1 of the curves.
inline constexpr int kRecallLevels = 21;
using PrecisionCurve = std::array<double, kRecallLevels>;

struct PrecisionRecall {
  // Sum over the list of (recall step) x (precision there): the area under the curve, 1 when all relevant
  // entries come first.
  double average_precision = 0;
  // At each level the highest precision reached at that recall or a higher one.
  PrecisionCurve curve{};
};

// scores and relevant (n); the highest score comes first, entries of equal score come together, so that their
// order cannot matter. All zero without a relevant entry.
PrecisionRecall precision_recall(std::span<const double> scores, const std::vector<bool>& relevant);

}  // namespace astrolith
