// Checks of option values whose messages a person can read: CLI11's own print the largest double in full.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <string>

namespace astrolith {

inline CLI::Validator above_zero() {
  const auto check = [](std::string& text) {
    return std::strtod(text.c_str(), nullptr) > 0.0 ? std::string() : "must be a number above 0, is " + text;
  };
  return CLI::Validator(check, "POSITIVE");
}

inline CLI::Validator zero_or_more() {
  const auto check = [](std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    return end != text.c_str() && value >= 0.0 ? std::string() : "must be a number of at least 0, is " + text;
  };
  return CLI::Validator(check, "NONNEGATIVE");
}

}  // namespace astrolith
