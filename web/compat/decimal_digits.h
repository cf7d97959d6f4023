// Decimal texts of doubles for <charconv>, made by fmt and the C library.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <string>

namespace astrolith {

// The shortest digits that read back to equal bits, as d.ddde+xx.
inline std::string shortest_scientific_text(double value) {
  if (!(value - value == 0.0) || value == 0.0) return fmt::format("{:e}", value);
  const auto decimal = fmt::detail::dragonbox::to_decimal(value);
  std::string digits = fmt::format("{}", decimal.significand);
  const int exponent = decimal.exponent + static_cast<int>(digits.size()) - 1;
  digits.erase(digits.find_last_not_of('0') + 1);
  if (digits.size() > 1) digits.insert(1, ".");
  return fmt::format("{}{}e{}{:02d}", value < 0 ? "-" : "", digits, exponent < 0 ? '-' : '+',
                     exponent < 0 ? -exponent : exponent);
}

inline std::string shortest_text(double value) {
  if (value == 0.0) return value < 0 || 1.0 / value < 0 ? "-0" : "0";
  if (!(value - value == 0.0)) return fmt::format("{}", value);
  const std::string scientific = shortest_scientific_text(value);
  std::string fixed = fmt::format("{:.0f}", value);  // exact
  if (std::strtod(scientific.c_str(), nullptr) != value || fixed.size() > scientific.size() ||
      std::strtod(fixed.c_str(), nullptr) != value) {
    fixed.clear();
  }
  if (!fixed.empty()) return fixed;
  const std::size_t e = scientific.find('e');
  const int exponent = std::atoi(scientific.c_str() + e + 1);
  const std::size_t sign = value < 0 ? 1 : 0;
  const std::size_t decimals = e - sign - (e - sign > 1 ? 2 : 1);
  const int places = static_cast<int>(decimals) - exponent;
  if (places < 1) return scientific;
  fixed = fmt::format("{:.{}f}", value, places);
  return fixed.size() <= scientific.size() ? fixed : scientific;
}

inline std::string scientific_text(double value, int decimals) {
  return fmt::format("{:.{}e}", value, decimals);
}

// std::from_chars: unlike the C library it takes neither blanks nor a plus sign in front.
inline std::from_chars_result read_decimal(const char* first, const char* last, double& value) {
  const std::string text(first, last);
  if (text.empty() || text[0] == '+' || static_cast<unsigned char>(text[0]) <= ' ')
    return {first, std::errc::invalid_argument};
  char* end = nullptr;
  const double read = std::strtod(text.c_str(), &end);
  if (end == text.c_str()) return {first, std::errc::invalid_argument};
  value = read;
  return {first + (end - text.c_str()), std::errc{}};
}

}  // namespace astrolith
