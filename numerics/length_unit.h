// Units of length by their names.
#pragma once

#include <string_view>

namespace astrolith {

// Whether the length of the unit is known, so that lengths in it can be converted.
constexpr bool has_known_length(std::string_view unit) {
  return unit == "m" || unit == "km" || unit == "cm" || unit == "mm";
}

// The metres of "m", "km", "cm" or "mm"; 1 for a unit whose length is unknown.
constexpr double metres_per_unit(std::string_view unit) {
  return unit == "km" ? 1000.0 : unit == "cm" ? 0.01 : unit == "mm" ? 0.001 : 1.0;
}

}  // namespace astrolith
