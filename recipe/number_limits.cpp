#include "recipe/number_limits_internal.h"

#include <fmt/format.h>

namespace astrolith {

void expect(double value, const NumberLimits& limits, const Place& place) {
  const bool above = limits.low_is_allowed ? value >= limits.low : value > limits.low;
  if (above && value <= limits.high) return;  // NaN is outside
  const std::string words = fmt::format(fmt::runtime(limits.words), limits.low, limits.high);
  place.fail(fmt::format("must be {}, is {}; give a value in that range", words, value));
}

void expect(int value, const IntegerLimits& limits, const Place& place) {
  if (value >= limits.low && value <= limits.high) return;
  place.fail(fmt::format("must be an integer from {} to {}, is {}; give one in that range", limits.low,
                         limits.high, value));
}

}  // namespace astrolith
