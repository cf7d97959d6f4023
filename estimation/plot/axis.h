// The axes of a diagram: a range, its ticks and a label.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace astrolith {

struct Axis {
  double low = 0.0, high = 1.0;                       // values at the two ends; high may lie below low
  std::vector<std::pair<double, std::string>> ticks;  // value, text
  std::string label;
};

// An axis from low to high (low < high) with about five ticks at multiples of 1, 2 or 5 times a power of ten.
// Ticks are at least `smallest_step` apart.
Axis linear_axis(double low, double high, const std::string& label, double smallest_step = 0.0);

// An axis of log10(value), whose ticks name the values 1, 2 and 5 times a power of ten between low and high.
// The range is widened to whole ticks. Both ends are positive values, low <= high.
Axis logarithmic_axis(double low, double high, const std::string& label);

}  // namespace astrolith
