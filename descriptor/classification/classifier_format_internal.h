// Constants that the reader and the writer of classifier files share.
#pragma once

#include <cstdint>

namespace astrolith {

inline constexpr const char* kClassifierFormat = "astrolith classifier";
inline constexpr int kClassifierVersion = 1;
// A parsed file takes up to about twenty times the memory of its size.
inline constexpr std::uintmax_t kMaxClassifierBytes = std::uintmax_t{128} << 20;

}  // namespace astrolith
