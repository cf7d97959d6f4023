#include "synthesis/relief/relief_matching.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "numerics/hash_random.h"
#include "synthesis/relief/patch_features.h"
#include "synthesis/relief/patch_samples.h"
#include "synthesis/relief/sliced_transport.h"

namespace astrolith {
namespace {

constexpr std::size_t kFewestPatches = 100;
// Squared edges: surfaces without relief are not matched.
constexpr double kLeastSquares = 1e-6;

double mean_square(const auto& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

// The values of a drawn surface, which follow from the change of its coefficients.
class DrawnSurface {
 public:
  DrawnSurface(const SurfaceValues& drawn, const ReliefValues& blend)
      : drawn_(drawn), blend_(blend), change_(drawn.values.size(), 0.0) {}

  const ReliefPoints& points() const { return drawn_.points; }
  std::vector<double> values() const {
    std::vector<double> values = blend_.evaluate(change_);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] += drawn_.values[i];
    return values;
  }
  void add(double step, const std::vector<double>& wanted) {
    for (std::size_t i = 0; i < change_.size(); ++i) change_[i] += step * wanted[i];
  }
  std::vector<double> take() { return std::move(change_); }

 private:
  const SurfaceValues& drawn_;
  const ReliefValues& blend_;
  std::vector<double> change_;
};

// A count of patches that grows with the root of the number of places: small bodies need many for their
// statistics, and on large ones patches that cover all of the surface many times would take too long.
std::size_t patches_for(const ReliefPoints& points, double per_root, std::size_t most) {
  const auto count = static_cast<std::size_t>(per_root * std::sqrt(static_cast<double>(points.size())));
  return std::clamp(count, 2 * kFewestPatches, most);
}

// Steps fall to a tenth.
double fall(int step, int steps) {
  return 1.0 - 0.9 * static_cast<double>(step) / static_cast<double>(steps);
}

std::uint32_t step_hash(std::uint32_t hash, int step) {
  return hash_append(hash, 16 + static_cast<std::uint32_t>(step));
}

// Patches of one width, and how they move.
struct PatchScale {
  PatchSamples samples;
  PlaceMeans means;
  SlicedTransport transport;
};

std::vector<PatchScale> make_scales(const SurfaceValues& measured, const ReliefPoints& points, double edge,
                                    std::uint32_t hash) {
  constexpr std::array<double, 3> kApart = {3.0, 2.0, 1.0};  // edges
  constexpr double kWidestReach = 2.0, kRidge = 1e-4;
  std::vector<PatchScale> scales;
  const std::size_t count = patches_for(points, 16.0, 12000);
  for (const double apart : kApart) {
    const PatchGrid grid{8, apart * edge, std::min(apart, kWidestReach) * edge};
    const PatchSamples theirs(measured.points, grid, count, hash = hash_append(hash, 0));
    PatchSamples samples(points, grid, count, hash = hash_append(hash, 1));
    if (std::min(theirs.patches(), samples.patches()) < kFewestPatches) continue;
    PlaceMeans means(samples, points.size());
    scales.push_back({std::move(samples),
                      std::move(means),
                      {theirs.of(measured.values, 1.0 / edge), grid.samples(), kRidge}});
  }
  return scales;
}

// Moves patches themselves.
void match_patches(const SurfaceValues& measured, double edge, std::uint32_t hash, DrawnSurface& surface) {
  constexpr int kSteps = 60;
  const std::vector<PatchScale> scales = make_scales(measured, surface.points(), edge, hash);
  if (scales.empty()) return;
  for (int step = 0; step < kSteps; ++step) {
    const PatchScale& scale = scales[static_cast<std::size_t>(step) % scales.size()];
    const std::vector<float> patches = scale.samples.of(surface.values(), 1.0 / edge),
                             changes = scale.transport.changes(patches, step_hash(hash, step));
    surface.add(fall(step, kSteps) * edge, scale.means.of(changes));
  }
}

// The patches of which a step measures features: some that were measured, others in each step, and those of
// the drawn surface in three batches.
struct FeaturePatches {
  static constexpr std::uint32_t kBatches = 3;
  PatchGrid grid;
  std::vector<float> measured;
  std::size_t shown;  // values of those measured
  std::vector<PatchSamples> batches;
  std::vector<PlaceMeans> means;  // of each batch

  FeaturePatches(const SurfaceValues& surface, const ReliefPoints& points, double edge, std::uint32_t hash)
      : grid{PatchFeatures::kSide, edge, edge} {
    const std::size_t count = patches_for(points, 4.0, 2400);
    measured =
        PatchSamples(surface.points, grid, 5 * count, hash_append(hash, 0)).of(surface.values, 1.0 / edge);
    shown = std::min(2 * count * grid.samples(), measured.size());
    for (std::uint32_t b = 0; b < kBatches; ++b) {
      batches.emplace_back(points, grid, count, hash_append(hash, 1 + b));
      means.emplace_back(batches.back(), points.size());
    }
  }

  bool enough() const {
    return std::min(measured.size() / grid.samples(), batches[0].patches()) >= kFewestPatches &&
           batches[1].patches() > 0 && batches[2].patches() > 0 && mean_square(measured) >= kLeastSquares;
  }
  std::vector<float> measured_at(std::uint32_t hash) const {
    const std::uint64_t rooms = (measured.size() - shown) / grid.samples() + 1;
    const auto first =
        measured.begin() + static_cast<std::ptrdiff_t>(((hash * rooms) >> 32) * grid.samples());
    return {first, first + static_cast<std::ptrdiff_t>(shown)};
  }
};

// What patches of the drawn surface want, so that their features are distributed as measured ones.
std::vector<float> wanted_by_features(const FeaturePatches& patches, const std::vector<float>& drawn,
                                      std::uint32_t hash) {
  constexpr double kRidge = 0.01;
  const std::vector<float> theirs = patches.measured_at(hash);
  const PatchFeatures features(theirs, hash_append(hash, 1));
  const SlicedTransport transport(features.of(theirs), PatchFeatures::kColumns, kRidge);
  std::vector<float> slopes =
      features.gradient(drawn, transport.gradient(features.of(drawn), hash_append(hash, 2)));
  for (std::size_t p = 0; p < slopes.size(); p += patches.grid.samples())
    remove_quadric(patches.grid.side, &slopes[p]);
  return slopes;
}

// Moves features of patches along gradients with momentum, over the root mean square of the last ones (Adam,
// Kingma and Ba 2015, with one second moment for the whole surface).
void match_features(const SurfaceValues& measured, double edge, std::uint32_t hash, DrawnSurface& surface) {
  constexpr int kSteps = 50;
  constexpr double kStep = 0.005, kMomentum = 0.9, kMemory = 0.97;  // a step in edges
  const FeaturePatches patches(measured, surface.points(), edge, hash);
  if (!patches.enough()) return;
  std::vector<double> momentum(surface.points().size(), 0.0);
  double squares = 0.0;
  for (int step = 0; step < kSteps; ++step) {
    const std::size_t batch = static_cast<std::size_t>(step) % patches.batches.size();
    const std::vector<float> drawn = patches.batches[batch].of(surface.values(), 1.0 / edge);
    const std::vector<double> wanted =
        patches.means[batch].of(wanted_by_features(patches, drawn, step_hash(hash, step)));
    const double now = mean_square(wanted);
    if (!(now > 0.0)) return;
    squares = step == 0 ? now : kMemory * squares + (1.0 - kMemory) * now;
    for (std::size_t i = 0; i < momentum.size(); ++i)
      momentum[i] = kMomentum * momentum[i] + (1.0 - kMomentum) * wanted[i];
    surface.add(fall(step, kSteps) * kStep * edge / std::sqrt(squares), momentum);
  }
}

}  // namespace

std::vector<double> matched_change(const SurfaceValues& measured, const SurfaceValues& drawn,
                                   const ReliefValues& blend, double edge, std::uint32_t hash) {
  DrawnSurface surface(drawn, blend);
  match_patches(measured, edge, hash_append(hash, 1), surface);
  match_features(measured, edge, hash_append(hash, 2), surface);
  return surface.take();
}

}  // namespace astrolith
