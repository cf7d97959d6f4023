// Precision and recall of a ranked list, for retrieval and for votes.
//
// Among the first K entries of the list, precision is the share of entries that are relevant. Recall is the
// share of all relevant entries that are among them.
#pragma once

#include <array>
#include <span>
#include <vector>

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

}  // namespace astrolith
