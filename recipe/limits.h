// What numbers of a recipe may be. No number exceeds kMaxNumber in magnitude and "> 0" means at least
// kMinPositive, which keeps absurd files out; combinations at the ends of both ranges can still leave what a
// float holds.
#pragma once

namespace astrolith {

inline constexpr double kMaxNumber = 1e12;
inline constexpr double kMinPositive = 1e-12;

}  // namespace astrolith
