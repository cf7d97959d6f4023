// What a number of a recipe must be: each throws InputError at `place` where it is not.
#pragma once

#include <fmt/format.h>

#include "numerics/vec3.h"
#include "recipe/limits.h"
#include "recipe/place_internal.h"

namespace astrolith {

inline void expect_range(double value, const Place& place, double low, double high) {
  if (value >= low && value <= high) return;  // false for NaN
  place.fail(fmt::format("must be from {:g} to {:g}, is {}; give a value in that range", low, high, value));
}
inline void expect_integer(int value, const Place& place, int low, int high) {
  if (value >= low && value <= high) return;
  place.fail(
      fmt::format("must be an integer from {} to {}, is {}; give one in that range", low, high, value));
}
inline void expect_number(double value, const Place& place) {
  expect_range(value, place, -kMaxNumber, kMaxNumber);
}
inline void expect_not_negative(double value, const Place& place) {
  expect_range(value, place, 0.0, kMaxNumber);
}
inline void expect_positive(double value, const Place& place) {
  if (value >= kMinPositive && value <= kMaxNumber) return;
  place.fail(fmt::format("must be above 0 (from {:g} to {:g}), is {}; give a value in that range",
                         kMinPositive, kMaxNumber, value));
}
inline void expect_above_one(double value, const Place& place, double high) {
  if (value > 1.0 && value <= high) return;
  place.fail(fmt::format("must be above 1 and at most {:g}, is {}; give a value in that range", high, value));
}
inline void expect_vector(const Vec3d& v, const Place& place) {
  expect_number(v.x, place.field("x"));
  expect_number(v.y, place.field("y"));
  expect_number(v.z, place.field("z"));
}

}  // namespace astrolith
