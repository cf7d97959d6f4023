#include "synthesis/relief/patch_samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "numerics/hash_random.h"
#include "numerics/parallel_for.h"
#include "numerics/portable_double.h"
#include "synthesis/relief/relief_patches.h"

namespace astrolith {
namespace {

// A place that looks random: places whose weight is shared with those of another axis are taken less often.
std::uint32_t draw_place(const ReliefPoints& points, std::uint32_t& hash) {
  constexpr int kMostDraws = 64;
  std::uint32_t place = 0;
  for (int draw = 0; draw < kMostDraws; ++draw) {
    hash = hash_append(hash, 3);
    place = static_cast<std::uint32_t>((std::uint64_t{hash} * points.size()) >> 32);
    if (double{unit_float(hash_append(hash, 5))} < points.weight(place)) break;
  }
  return place;
}

// 1, x, y, x^2, x y, y^2 over a square, about its middle, orthonormal.
struct Quadrics {
  static constexpr std::size_t kTerms = 6;
  std::array<std::vector<double>, kTerms> terms;

  explicit Quadrics(std::size_t side) {
    const double middle = 0.5 * static_cast<double>(side - 1);
    for (std::size_t k = 0; k < side * side; ++k) {
      const std::size_t column = k % side, row = k / side;
      const double x = static_cast<double>(column) - middle, y = static_cast<double>(row) - middle;
      const double values[kTerms] = {1.0, x, y, x * x, x * y, y * y};
      for (std::size_t t = 0; t < kTerms; ++t) terms[t].push_back(values[t]);
    }
    for (std::size_t t = 0; t < kTerms; ++t) {
      for (std::size_t before = 0; before < t; ++before) add(-along(t, terms[before]), before, t);
      const double length = std::sqrt(along(t, terms[t]));
      for (double& value : terms[t]) value /= length;
    }
  }

  double along(std::size_t t, const std::vector<double>& values) const {
    return std::inner_product(values.begin(), values.end(), terms[t].begin(), 0.0);
  }
  void add(double by, std::size_t from, std::size_t to) {
    for (std::size_t k = 0; k < terms[to].size(); ++k) terms[to][k] += by * terms[from][k];
  }
};

template <std::size_t kSide>
const Quadrics& quadrics() {
  static const Quadrics of_side(kSide);
  return of_side;
}

}  // namespace

void remove_quadric(std::size_t side, float* patch) {
  const Quadrics& quadric = side == 8 ? quadrics<8>() : quadrics<16>();
  for (const std::vector<double>& term : quadric.terms) {
    double along = 0.0;
    for (std::size_t k = 0; k < term.size(); ++k) along += term[k] * double{patch[k]};
    for (std::size_t k = 0; k < term.size(); ++k) patch[k] -= static_cast<float>(along * term[k]);
  }
}

// What the samples of one patch take, in their order; nothing where one of them has no place.
struct PatchSamples::Patch {
  std::vector<std::size_t> ends;
  std::vector<std::uint32_t> places;
  std::vector<float> shares;
};

PatchSamples::Patch PatchSamples::patch_at(const ReliefPoints& points, std::uint32_t place,
                                           std::uint32_t hash) const {
  constexpr float kLeastTotal = 1e-3f;
  const double middle = grid_.middle(), reach = grid_.reach / grid_.apart,
               radius = std::sqrt(2.0) * (middle + reach) * grid_.apart;
  const ReliefAnchor anchor = anchor_at(points, place);
  const PatchTurn turn = hash_to_turn(hash);
  const auto last = static_cast<int>(grid_.side) - 1;
  const auto first_from = [&](double at) { return std::max(static_cast<int>(std::ceil(at - reach)), 0); };
  const auto last_to = [&](double at) { return std::min(static_cast<int>(std::floor(at + reach)), last); };
  struct Share {
    int sample;
    std::uint32_t place;
    float weight;
  };
  std::vector<Share> found;
  std::vector<float> totals(grid_.samples(), 0.0f);
  points.for_each_near(anchor.at, anchor.up, radius, [&](std::uint32_t k, double, double) {
    const Vec3d offset = (1.0 / grid_.apart) * (points.at(k) - anchor.at);
    const double right = dot(offset, anchor.right), ahead = dot(offset, anchor.ahead);
    const double x = turn.cosine * right + turn.sine * ahead + middle,
                 y = turn.cosine * ahead - turn.sine * right + middle;
    for (int j = first_from(y); j <= last_to(y); ++j) {
      for (int i = first_from(x); i <= last_to(x); ++i) {
        const double near = 1.0 - ((x - i) * (x - i) + (y - j) * (y - j)) / (reach * reach);
        if (near <= 0.0) continue;
        const auto weight = static_cast<float>(near * near * near * points.weight(k));
        found.push_back({j * (last + 1) + i, k, weight});
        totals[static_cast<std::size_t>(found.back().sample)] += weight;
      }
    }
  });
  Patch patch;
  if (*std::min_element(totals.begin(), totals.end()) < kLeastTotal) return patch;
  std::vector<std::size_t> next(grid_.samples() + 1, 0);
  for (const Share& share : found) ++next[static_cast<std::size_t>(share.sample) + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  patch.ends.assign(next.begin() + 1, next.end());
  patch.places.resize(found.size()), patch.shares.resize(found.size());
  for (const Share& share : found) {
    const auto sample = static_cast<std::size_t>(share.sample);
    const std::size_t at = next[sample]++;
    patch.places[at] = share.place;
    patch.shares[at] = share.weight / totals[sample];
  }
  return patch;
}

PatchSamples::PatchSamples(const ReliefPoints& points, const PatchGrid& grid, std::size_t count,
                           std::uint32_t hash)
    : grid_(grid) {
  constexpr std::size_t kTogether = 128, kMostShares = std::size_t{1} << 23;
  for (std::size_t first = 0; first < count && places_.size() < kMostShares; first += kTogether) {
    std::vector<Patch> patches(std::min(kTogether, count - first));
    parallel_for(
        0, static_cast<std::int64_t>(patches.size()),
        [&](std::int64_t k) {
          const std::size_t number = first + static_cast<std::size_t>(k);
          std::uint32_t own = hash_append(hash, static_cast<std::uint32_t>(number));
          const std::uint32_t place = draw_place(points, own);
          patches[static_cast<std::size_t>(k)] = patch_at(points, place, hash_append(own, 7));
        },
        8);
    for (const Patch& patch : patches) {
      for (const std::size_t end : patch.ends) first_.push_back(places_.size() + end);
      places_.insert(places_.end(), patch.places.begin(), patch.places.end());
      shares_.insert(shares_.end(), patch.shares.begin(), patch.shares.end());
    }
  }
}

std::vector<float> PatchSamples::of(const std::vector<double>& values, double scale) const {
  std::vector<float> samples(first_.size() - 1);
  parallel_for(
      0, static_cast<std::int64_t>(patches()),
      [&](std::int64_t number) {
        const std::size_t start = static_cast<std::size_t>(number) * grid_.samples();
        for (std::size_t i = start; i < start + grid_.samples(); ++i) {
          double sum = 0.0;
          for (std::size_t k = first_[i]; k < first_[i + 1]; ++k)
            sum += double{shares_[k]} * values[places_[k]];
          samples[i] = static_cast<float>(scale * sum);
        }
        remove_quadric(grid_.side, &samples[start]);
      },
      16);
  return samples;
}

PlaceMeans::PlaceMeans(const PatchSamples& patches, std::size_t places)
    : first_(places + 1, 0), samples_(patches.places_.size()), weights_(patches.places_.size()) {
  const PatchGrid& grid = patches.grid_;
  const double width = 0.25 * static_cast<double>(grid.side), middle = grid.middle();
  std::vector<float> window(grid.samples());
  for (std::size_t k = 0; k < window.size(); ++k) {
    const std::size_t column = k % grid.side, row = k / grid.side;
    const double x = static_cast<double>(column) - middle, y = static_cast<double>(row) - middle;
    window[k] = static_cast<float>(portable::exp(-0.5 * (x * x + y * y) / (width * width)));
  }
  for (const std::uint32_t place : patches.places_) ++first_[place + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t i = 0; i + 1 < patches.first_.size(); ++i) {
    for (std::size_t k = patches.first_[i]; k < patches.first_[i + 1]; ++k) {
      const std::size_t at = next[patches.places_[k]]++;
      samples_[at] = static_cast<std::uint32_t>(i);
      weights_[at] = window[i % window.size()] * patches.shares_[k];
    }
  }
}

std::vector<double> PlaceMeans::of(const std::vector<float>& wanted) const {
  std::vector<double> means(first_.size() - 1);
  parallel_for(
      0, static_cast<std::int64_t>(means.size()),
      [&](std::int64_t number) {
        const auto place = static_cast<std::size_t>(number);
        double sum = 0.0, total = 0.0;
        for (std::size_t k = first_[place]; k < first_[place + 1]; ++k) {
          sum += double{weights_[k]} * double{wanted[samples_[k]]};
          total += double{weights_[k]};
        }
        means[place] = total > 0.0 ? sum / total : 0.0;
      },
      1024);
  return means;
}

}  // namespace astrolith
