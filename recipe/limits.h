// Limits of a recipe's numbers, which keep absurd files out. No number exceeds kMaxNumber in magnitude, and
// "> 0" means at least kMinPositive. Numbers at the ends of their ranges can still combine to more than a
// float holds.
#pragma once

namespace astrolith {

inline constexpr double kMaxNumber = 1e12;
inline constexpr double kMinPositive = 1e-12;

}  // namespace astrolith
