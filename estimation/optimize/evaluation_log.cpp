#include "estimation/optimize/evaluation_log.h"

#include <bit>
#include <utility>

#include "numerics/hash_random.h"

namespace astrolith {
namespace {

// Two hashes of 32 bits with different starts. Among 10^5 points, two share all 64 bits once in 10^9 runs.
std::uint64_t hash_position(std::span<const double> x) {
  std::uint32_t low = 1, high = 2;
  for (const double value : x) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    const auto a = static_cast<std::uint32_t>(bits), b = static_cast<std::uint32_t>(bits >> 32);
    low = hash_append(hash_append(low, a), b);
    high = hash_append(hash_append(high, b), a);
  }
  return std::uint64_t{high} << 32 | low;
}

}  // namespace

std::optional<double> EvaluationLog::find(std::span<const double> x) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto found = values_.find(hash_position(x));
  return found == values_.end() ? std::nullopt : std::optional<double>(found->second);
}

void EvaluationLog::add(std::span<const double> x, double value) {
  const std::lock_guard<std::mutex> lock(mutex_);
  values_.emplace(hash_position(x), value);
}

std::size_t EvaluationLog::size() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return values_.size();
}

std::map<std::uint64_t, double> EvaluationLog::entries() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return values_;
}

void EvaluationLog::restore(std::map<std::uint64_t, double> entries) {
  const std::lock_guard<std::mutex> lock(mutex_);
  values_ = std::move(entries);
}

BatchObjective logged(const BatchObjective& objective, EvaluationLog& log) {
  return [&objective, &log](std::span<const std::vector<double>> points) {
    std::vector<double> values(points.size());
    std::vector<std::vector<double>> unknown;
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (const std::optional<double> known = log.find(points[i])) {
        values[i] = *known;
      } else {
        unknown.push_back(points[i]);
        places.push_back(i);
      }
    }
    if (unknown.empty()) return values;
    const std::vector<double> found = objective(unknown);
    for (std::size_t k = 0; k < unknown.size(); ++k) {
      values[places[k]] = found[k];
      log.add(unknown[k], found[k]);
    }
    return values;
  };
}

}  // namespace astrolith
