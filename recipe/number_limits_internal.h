// Limits of a number in a list of fields.
#pragma once

#include <string_view>

#include "recipe/limits.h"
#include "recipe/place_internal.h"

namespace astrolith {

struct NumberLimits {
  double low, high;
  std::string_view words;  // the limits in a message, where {0} is `low` and {1} is `high`
  bool low_is_allowed = true;
};
struct IntegerLimits {
  int low, high;
};

constexpr NumberLimits range(double low, double high) { return {low, high, "from {0:g} to {1:g}"}; }
constexpr IntegerLimits range(int low, int high) { return {low, high}; }
constexpr NumberLimits above_one(double high) { return {1.0, high, "above {0:g} and at most {1:g}", false}; }
inline constexpr NumberLimits kAnyNumber = range(-kMaxNumber, kMaxNumber);
inline constexpr NumberLimits kNotNegative = range(0.0, kMaxNumber);
inline constexpr NumberLimits kPositive = {kMinPositive, kMaxNumber, "above 0 (from {0:g} to {1:g})"};
inline constexpr NumberLimits kShare = range(0.0, 1.0);

// Both functions throw InputError at `place` for a value outside the limits. NaN lies outside.
void expect(double value, const NumberLimits& limits, const Place& place);
void expect(int value, const IntegerLimits& limits, const Place& place);

}  // namespace astrolith
