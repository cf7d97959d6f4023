// What reader and writer of a classifier's file agree on.
#pragma once

#include <cstdint>

namespace astrolith {

inline constexpr const char* kClassifierFormat = "astrolith classifier";
inline constexpr int kClassifierVersion = 1;
// Parsed, a file takes up to some twenty times its size.
inline constexpr std::uintmax_t kMaxClassifierBytes = std::uintmax_t{128} << 20;

}  // namespace astrolith
