#include "estimation/shape/relief/relief_solver.h"

#include <cstddef>
#include <numeric>

#include "numerics/sample_statistics.h"

namespace astrolith {
namespace {

constexpr double kPull = 2e-3;  // towards the local mean
// More of them bring the surface hardly nearer, and make heights that take more bytes.
constexpr int kIterations = 12;

}  // namespace

std::vector<double> solve_relief(const ReliefBlend& blend, const Progress& progress) {
  // The means, and the diagonal of the normal equations.
  const std::vector<double> shares = blend.sums(SampleSum::kOne, {}),
                            diagonal = blend.sums(SampleSum::kShare, {});
  std::vector<double> heights = blend.sums(SampleSum::kHeight, {});
  const std::size_t n = heights.size();
  for (std::size_t p = 0; p < n; ++p) heights[p] = shares[p] > 0.0 ? heights[p] / shares[p] : 0.0;
  const double pull = kPull * std::accumulate(diagonal.begin(), diagonal.end(), 0.0) / static_cast<double>(n);

  // Conjugate gradients for the change, preconditioned by the diagonal.
  std::vector<double> residual = blend.sums(SampleSum::kError, heights), change(n, 0.0), scaled(n);
  const auto scale = [&] {
    for (std::size_t p = 0; p < n; ++p)
      scaled[p] = diagonal[p] > 0.0 ? residual[p] / (diagonal[p] + pull) : 0.0;
  };
  scale();
  std::vector<double> direction = scaled;
  double energy = sum_of_products(residual, scaled);
  const double enough = 1e-12 * energy;
  for (int i = 0; i < kIterations && energy > enough; ++i) {
    if (!report(progress, static_cast<double>(i) / kIterations, "relief")) break;
    std::vector<double> image = blend.sums(SampleSum::kBlend, direction);
    for (std::size_t p = 0; p < n; ++p) image[p] += pull * direction[p];
    const double step = energy / sum_of_products(direction, image);
    for (std::size_t p = 0; p < n; ++p) {
      change[p] += step * direction[p];
      residual[p] -= step * image[p];
    }
    scale();
    const double next = sum_of_products(residual, scaled);
    for (std::size_t p = 0; p < n; ++p) direction[p] = scaled[p] + next / energy * direction[p];
    energy = next;
  }
  for (std::size_t p = 0; p < n; ++p) heights[p] += change[p];
  return heights;
}

}  // namespace astrolith
