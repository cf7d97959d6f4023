#include "synthesis/mesh/mesh_sample.h"

#include <numeric>

#include "numerics/hash_random.h"

namespace astrolith {
namespace {

// Below this many samples in a range of layers their number says little about the range.
constexpr int kEnoughSamples = 100;

}  // namespace

std::vector<std::size_t> evenly_chosen(std::size_t size, std::size_t count, std::uint32_t seed) {
  std::vector<std::size_t> chosen(std::min(size, count));
  std::iota(chosen.begin(), chosen.end(), std::size_t{0});
  if (size <= count) return chosen;
  const double stride = double(size) / double(count);
  const double start = stride * double(hash_append(seed, 1) >> 8) * 0x1p-24;
  for (std::size_t& i : chosen) i = std::min(static_cast<std::size_t>(start + stride * double(i)), size - 1);
  return chosen;
}

double most_in_layers(const std::vector<double>& profile, const std::vector<int>& samples, int layers) {
  double most = 0.0;
  const std::size_t size = profile.size();
  for (std::size_t first = 0; first < size; ++first) {
    double sum = 0.0;
    int seen = 0;
    std::size_t end = first;
    while (end < size && (end < first + static_cast<std::size_t>(layers) || seen < kEnoughSamples)) {
      sum += profile[end];
      seen += samples[end];
      ++end;
    }
    const double width = double(end - first);
    if (seen < kEnoughSamples && first > 0) break;  // the rest lies within ranges before it
    most = std::max(most, sum * std::min(1.0, layers / width));
  }
  return most;
}

MeshEstimate estimate_within(const std::function<MeshEstimate(const SampleSize&)>& sample, bool warm_up,
                             const SampleBudget& budget) {
  // Probes tell the cost of a block, so that a sample needs few blocks, and squares for their number.
  constexpr int kMostNodes = 768, kMostBlocks = 24;
  SampleSize size{budget.first_nodes, budget.first_blocks, warm_up};
  MeshEstimate estimate = sample(size);
  double spent = estimate.spent_seconds;
  while (!estimate.whole && size.nodes < kMostNodes) {
    const double allowed = std::max(budget.free_seconds, budget.share * estimate.seconds) - spent;
    const double growth = std::min(allowed / std::max(estimate.spent_seconds, 1e-6), 16.0);
    if (growth < 1.5) break;
    size.nodes = std::min(static_cast<int>(growth * size.nodes), kMostNodes);
    size.blocks = std::min(static_cast<int>(growth * size.blocks), kMostBlocks);
    const double sampled = estimate.sampled_blocks, evaluations = estimate.spent_evaluations;
    estimate = sample(size);
    estimate.sampled_blocks += sampled;
    estimate.sampled_windows += sampled;
    estimate.spent_evaluations += evaluations;
    spent += estimate.spent_seconds;
  }
  estimate.spent_seconds = spent;
  return estimate;
}

}  // namespace astrolith
