#include "estimation/shape/relief/relief_solver.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>

#include "numerics/parallel_for.h"
#include "numerics/sample_statistics.h"

namespace astrolith {
namespace {

constexpr double kPull = 2e-3;  // towards the local mean
constexpr int kIterations = 30;
constexpr std::int64_t kGrain = 2048;

// The samples by places: the transpose of their shares.
struct SharesOfPlaces {
  std::vector<std::uint32_t> first, samples;
  std::vector<float> shares;

  SharesOfPlaces(const ReliefSamples& s, std::size_t num_places)
      : first(num_places + 1, 0), samples(s.shares.size()), shares(s.shares.size()) {
    for (const std::uint32_t place : s.places) ++first[place + 1];
    for (std::size_t i = 0; i < num_places; ++i) first[i + 1] += first[i];
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    for (std::size_t i = 0; i < s.size(); ++i) {
      for (std::uint32_t k = s.first[i]; k < s.first[i + 1]; ++k) {
        const std::uint32_t to = next[s.places[k]]++;
        samples[to] = static_cast<std::uint32_t>(i);
        shares[to] = s.shares[k];
      }
    }
  }
};

std::vector<double> blended(const ReliefSamples& s, const std::vector<double>& heights) {
  std::vector<double> values(s.size());
  parallel_for(
      0, static_cast<std::int64_t>(s.size()),
      [&](std::int64_t i) {
        double sum = 0.0;
        for (std::uint32_t k = s.first[static_cast<std::size_t>(i)];
             k < s.first[static_cast<std::size_t>(i) + 1]; ++k) {
          sum += double{s.shares[k]} * heights[s.places[k]];
        }
        values[static_cast<std::size_t>(i)] = sum;
      },
      kGrain);
  return values;
}

std::vector<double> collected(const SharesOfPlaces& t, const std::vector<double>& values) {
  std::vector<double> sums(t.first.size() - 1);
  parallel_for(
      0, static_cast<std::int64_t>(sums.size()),
      [&](std::int64_t i) {
        double sum = 0.0;
        for (std::uint32_t k = t.first[static_cast<std::size_t>(i)];
             k < t.first[static_cast<std::size_t>(i) + 1]; ++k) {
          sum += double{t.shares[k]} * values[t.samples[k]];
        }
        sums[static_cast<std::size_t>(i)] = sum;
      },
      kGrain);
  return sums;
}

}  // namespace

std::vector<double> relief_residuals(const ReliefSamples& samples, const std::vector<double>& heights) {
  std::vector<double> residuals = blended(samples, heights);
  for (std::size_t i = 0; i < residuals.size(); ++i)
    residuals[i] = std::fabs(residuals[i] - samples.height[i]);
  return residuals;
}

std::vector<double> solve_relief(const ReliefSamples& samples, std::size_t num_places,
                                 const Progress& progress) {
  const SharesOfPlaces transposed(samples, num_places);
  // The means, and the diagonal of the normal equations.
  std::vector<double> heights(num_places, 0.0), diagonal(num_places, 0.0);
  for (std::size_t p = 0; p < num_places; ++p) {
    double shares = 0.0, sum = 0.0;
    for (std::uint32_t k = transposed.first[p]; k < transposed.first[p + 1]; ++k) {
      const double share = transposed.shares[k];
      shares += share;
      sum += share * samples.height[transposed.samples[k]];
      diagonal[p] += share * share;
    }
    if (shares > 0.0) heights[p] = sum / shares;
  }
  const double pull =
      kPull * std::accumulate(diagonal.begin(), diagonal.end(), 0.0) / static_cast<double>(num_places);
  std::vector<double> errors = blended(samples, heights);
  for (std::size_t i = 0; i < errors.size(); ++i) errors[i] = samples.height[i] - errors[i];

  // Conjugate gradients for the change, preconditioned by the diagonal.
  std::vector<double> residual = collected(transposed, errors), change(num_places, 0.0), scaled(num_places);
  const auto scale = [&] {
    for (std::size_t p = 0; p < num_places; ++p)
      scaled[p] = diagonal[p] > 0.0 ? residual[p] / (diagonal[p] + pull) : 0.0;
  };
  scale();
  std::vector<double> direction = scaled;
  double energy = sum_of_products(residual, scaled);
  const double enough = 1e-12 * energy;
  for (int i = 0; i < kIterations && energy > enough; ++i) {
    if (!report(progress, static_cast<double>(i) / kIterations, "relief")) break;
    std::vector<double> image = collected(transposed, blended(samples, direction));
    for (std::size_t p = 0; p < num_places; ++p) image[p] += pull * direction[p];
    const double step = energy / sum_of_products(direction, image);
    for (std::size_t p = 0; p < num_places; ++p) {
      change[p] += step * direction[p];
      residual[p] -= step * image[p];
    }
    scale();
    const double next = sum_of_products(residual, scaled);
    for (std::size_t p = 0; p < num_places; ++p) direction[p] = scaled[p] + next / energy * direction[p];
    energy = next;
  }
  for (std::size_t p = 0; p < num_places; ++p) heights[p] += change[p];
  return heights;
}

}  // namespace astrolith
