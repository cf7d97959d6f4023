// Whole numbers of JSON documents. The library converts any number to any type, without a look at its range.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

namespace astrolith {

// The whole number that a JSON value holds, which may be written as 8.0 or 1e3. None where the value is no
// number, has a fraction, lies outside [least, most], or is a float beyond 2^53, which may have been rounded.
template <class Integer, class Json>
std::optional<Integer> whole_number(const Json& value, Integer least = std::numeric_limits<Integer>::min(),
                                    Integer most = std::numeric_limits<Integer>::max()) {
  constexpr double kMostExact = 0x1p53;
  const auto within = [&](auto number) -> std::optional<Integer> {
    if (std::cmp_less(number, least) || std::cmp_greater(number, most)) return {};
    return static_cast<Integer>(number);
  };
  if (value.is_number_unsigned()) return within(value.template get<std::uint64_t>());
  if (value.is_number_integer()) return within(value.template get<std::int64_t>());
  if (!value.is_number_float()) return {};
  const double number = value.template get<double>();
  if (!(std::fabs(number) <= kMostExact) || number != std::floor(number)) return {};
  return within(static_cast<std::int64_t>(number));
}

}  // namespace astrolith
