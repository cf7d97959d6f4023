#include "estimation/plot/axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace astrolith {
namespace {

// The smallest of 2, 5 and 10 times a power of ten that is larger than a fifth of the extent.
double round_step(double extent) {
  const double raw = extent / 5.0, power = std::pow(10.0, std::floor(std::log10(raw)));
  return power * (raw / power < 2.0 ? 2.0 : raw / power < 5.0 ? 5.0 : 10.0);
}

// Tick k of the sequence ..., 0.5, 1, 2, 5, 10, ...; tick 0 is 1.
double round_value(int k) {
  constexpr double kMantissas[] = {1.0, 2.0, 5.0};
  const int decade = k >= 0 ? k / 3 : -((2 - k) / 3);
  return kMantissas[k - 3 * decade] * std::pow(10.0, decade);
}

}  // namespace

Axis linear_axis(double low, double high, const std::string& label, double smallest_step) {
  Axis axis{low, high, {}, label};
  const double step = std::max(smallest_step, round_step(high - low));
  const double rounding = 1e-9 * step;
  const auto first = static_cast<int>(std::ceil((low - rounding) / step));
  const auto last = static_cast<int>(std::floor((high + rounding) / step));
  for (int k = first; k <= last; ++k) axis.ticks.emplace_back(k * step, fmt::format("{:g}", k * step));
  return axis;
}

Axis logarithmic_axis(double low, double high, const std::string& label) {
  constexpr double kRounding = 1.0 + 1e-9;
  int first = 3 * static_cast<int>(std::floor(std::log10(low)));
  while (round_value(first + 1) <= low * kRounding) ++first;
  int last = first + 1;
  while (round_value(last) * kRounding < high) ++last;
  Axis axis{std::log10(round_value(first)), std::log10(round_value(last)), {}, label};
  for (int k = first; k <= last; ++k) {
    axis.ticks.emplace_back(std::log10(round_value(k)), fmt::format("{:g}", round_value(k)));
  }
  return axis;
}

}  // namespace astrolith
