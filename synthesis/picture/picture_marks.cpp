#include "synthesis/picture/picture_marks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "numerics/sample_statistics.h"

namespace astrolith {

ValueRange value_range(std::span<const double> values) {
  std::vector<double> sorted(values.begin(), values.end());
  std::erase_if(sorted, [](double value) { return !std::isfinite(value); });
  if (sorted.empty()) sorted = {0.0};
  std::sort(sorted.begin(), sorted.end());
  const double low = sorted_quantile(sorted, 0.01), high = sorted_quantile(sorted, 0.99);
  return {low, high > low ? high : low + 1.0, sorted.front(), sorted.back()};
}

std::string column_title(const std::string& name) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 8> kUnits{{{"_m_s2", "m/s2"},
                                                                                 {"_J_kg", "J/kg"},
                                                                                 {"_deg", "deg"},
                                                                                 {"_km", "km"},
                                                                                 {"_cm", "cm"},
                                                                                 {"_mm", "mm"},
                                                                                 {"_m", "m"},
                                                                                 {"_s", "s"}}};
  std::string words = name, unit;
  for (const auto& [ending, symbol] : kUnits) {
    if (!unit.empty() || !name.ends_with(ending) || name.size() == ending.size()) continue;
    words.resize(name.size() - ending.size());
    unit = " [" + std::string(symbol) + "]";
  }
  std::replace(words.begin(), words.end(), '_', ' ');
  return words + unit;
}

}  // namespace astrolith
