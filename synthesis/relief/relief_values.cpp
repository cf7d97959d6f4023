#include "synthesis/relief/relief_values.h"

#include <algorithm>

#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

template <typename Work>
void for_each_place(std::size_t n, const Work& work) {
  constexpr std::int64_t kGrain = 256;
  parallel_for(
      0, static_cast<std::int64_t>(n), [&](std::int64_t i) { work(static_cast<std::size_t>(i)); }, kGrain);
}

}  // namespace

ReliefValues::ReliefValues(const ReliefPoints& points, const ReliefShares& shares)
    : first_(points.size() + 1, 0) {
  constexpr std::size_t kGroup = 4096;  // places whose shares are found together
  struct Rows {
    std::vector<std::uint32_t> places;
    std::vector<float> shares;
  };
  std::vector<Rows> groups((points.size() + kGroup - 1) / kGroup);
  parallel_for(0, static_cast<std::int64_t>(groups.size()), [&](std::int64_t number) {
    const auto g = static_cast<std::size_t>(number);
    Rows& rows = groups[g];
    for (std::size_t i = g * kGroup; i < std::min(points.size(), (g + 1) * kGroup); ++i) {
      shares.add(to_float(points.at(i)), rows.places, rows.shares);
      first_[i + 1] = rows.places.size();
    }
  });
  std::size_t total = 0;
  for (const Rows& rows : groups) total += rows.places.size();
  places_.reserve(total), shares_.reserve(total);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const std::size_t before = places_.size();
    places_.insert(places_.end(), groups[g].places.begin(), groups[g].places.end());
    shares_.insert(shares_.end(), groups[g].shares.begin(), groups[g].shares.end());
    groups[g] = {};
    for (std::size_t i = g * kGroup; i < std::min(points.size(), (g + 1) * kGroup); ++i)
      first_[i + 1] += before;
  }
}

std::vector<double> ReliefValues::values_of(const std::vector<double>& coefficients) const {
  std::vector<double> values(coefficients.size());
  for_each_place(values.size(), [&](std::size_t i) {
    double sum = first_[i] == first_[i + 1] ? coefficients[i] : 0.0;
    for (std::size_t k = first_[i]; k < first_[i + 1]; ++k)
      sum += double{shares_[k]} * coefficients[places_[k]];
    values[i] = sum;
  });
  return values;
}

std::vector<double> ReliefValues::coefficients_of(const std::vector<double>& values) const {
  constexpr int kIterations = 10;
  constexpr double kDamping = 1.5;
  const std::vector<Interval> limits = limits_of(values);
  std::vector<double> coefficients = values;
  for (int pass = 0; pass < kIterations; ++pass) {
    const std::vector<double> reached = values_of(coefficients);
    for (std::size_t i = 0; i < values.size(); ++i) {
      coefficients[i] =
          std::clamp(coefficients[i] + kDamping * (values[i] - reached[i]), limits[i].low, limits[i].high);
    }
  }
  return coefficients;
}

// The values that a place takes part in, and their range once more on both sides.
std::vector<Interval> ReliefValues::limits_of(const std::vector<double>& values) const {
  std::vector<Interval> limits(values.size());
  for_each_place(values.size(), [&](std::size_t i) {
    double low = values[i], high = values[i];
    for (std::size_t k = first_[i]; k < first_[i + 1]; ++k) {
      low = std::min(low, values[places_[k]]);
      high = std::max(high, values[places_[k]]);
    }
    limits[i] = {low - (high - low), high + (high - low)};
  });
  return limits;
}

}  // namespace astrolith
