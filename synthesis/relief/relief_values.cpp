#include "synthesis/relief/relief_values.h"

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

ReliefValues::ReliefValues(const ReliefPoints& points, const ReliefShares& shares) : rows_(points.size()) {
  for_each_place(rows_.size(), [&](std::size_t i) {
    shares.add(to_float(points.at(i)), rows_[i].places, rows_[i].shares);
  });
}

std::vector<double> ReliefValues::values_of(const std::vector<double>& coefficients) const {
  std::vector<double> values(rows_.size());
  for_each_place(rows_.size(), [&](std::size_t i) {
    const Row& row = rows_[i];
    double sum = row.places.empty() ? coefficients[i] : 0.0;
    for (std::size_t k = 0; k < row.places.size(); ++k) {
      sum += double{row.shares[k]} * coefficients[row.places[k]];
    }
    values[i] = sum;
  });
  return values;
}

std::vector<double> ReliefValues::coefficients_of(const std::vector<double>& values) const {
  constexpr int kIterations = 10;
  constexpr double kDamping = 1.5;
  std::vector<double> coefficients = values;
  for (int pass = 0; pass < kIterations; ++pass) {
    const std::vector<double> reached = values_of(coefficients);
    for (std::size_t i = 0; i < values.size(); ++i) coefficients[i] += kDamping * (values[i] - reached[i]);
  }
  return coefficients;
}

}  // namespace astrolith
