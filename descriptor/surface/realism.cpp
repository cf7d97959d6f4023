#include "descriptor/surface/realism.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "numerics/reported_loop.h"
#include "numerics/sample_statistics.h"

namespace astrolith {
namespace {

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

struct Summary {
  double middle, spread;
};

Summary summarize(const LocalStatistic& statistic) {
  std::vector<double> sorted = statistic.values;
  std::sort(sorted.begin(), sorted.end());
  const double spread = sorted_quantile(sorted, 0.75) - sorted_quantile(sorted, 0.25);
  if (!quantity_traits(statistic.quantity).has_mean) return {median(sorted), spread};
  double mean = 0.0;
  for (const double v : sorted) mean += v / static_cast<double>(sorted.size());
  return {mean, spread};
}

void check_alike(const SurfaceStatistics& a, const SurfaceStatistics& b) {
  if (a.points != b.points) {
    throw InputError("realism: the surfaces were sampled at " + std::to_string(a.points) + " and " +
                     std::to_string(b.points) + " points; sample both at as many");
  }
}

// A statistic that both surfaces have, and its distance for any labels of regions.
struct StatisticTest {
  StatisticComparison comparison;
  std::function<double(const RegionLabels&)> distance;
};

// The share of places that are flatter than all but kFlatShare of a's: other bends become equal. Meshes
// differ in the bends that their triangles leave, but a facet that is flat for several edges is no surface.
constexpr double kFlatShare = 0.02;
std::vector<double> flat_part(std::vector<double> bends, double limit) {
  for (double& bend : bends) bend = std::min(bend, limit);
  return bends;
}

// Other triangles of one surface leave up to so much more of it flat, which is no difference of the surfaces.
constexpr double kFlatTolerance = 0.05;

std::function<double(const RegionLabels&)> make_distance(const LocalStatistic& a, const LocalStatistic& b,
                                                         const Regions& regions_a, const Regions& regions_b) {
  if (!quantity_traits(a.quantity).only_flat) {
    return KolmogorovSmirnov({a.values, regions_a.region_index}, {b.values, regions_b.region_index});
  }
  std::vector<double> sorted = a.values;
  std::sort(sorted.begin(), sorted.end());
  const double limit = sorted_quantile(sorted, kFlatShare);
  const std::vector<double> flat_a = flat_part(a.values, limit), flat_b = flat_part(b.values, limit);
  const KolmogorovSmirnov distance({flat_a, regions_a.region_index}, {flat_b, regions_b.region_index});
  return [distance](const RegionLabels& first) { return std::max(0.0, distance(first) - kFlatTolerance); };
}

StatisticTest make_test(const LocalStatistic& a, const LocalStatistic& b, const SurfaceStatistics& surface_a,
                        const SurfaceStatistics& surface_b) {
  StatisticTest test;
  StatisticComparison& c = test.comparison;
  c.quantity = a.quantity;
  c.radius = c.reach = a.radius;
  const double body_radius = std::min(surface_a.body_radius, surface_b.body_radius);
  c.counts_in_p = regions_hold(a.radius, body_radius);
  c.counts_in_distance =
      quantity_traits(a.quantity).counts_in_distance && body_holds_discs(a.radius, body_radius);
  const Summary sa = summarize(a), sb = summarize(b);
  c.middle_a = sa.middle, c.middle_b = sb.middle, c.spread_a = sa.spread, c.spread_b = sb.spread;
  test.distance = make_distance(a, b, surface_a.regions, surface_b.regions);
  return test;
}

StatisticTest make_test(const Regions& a, const Regions& b, std::size_t lag) {
  StatisticTest test;
  StatisticComparison& c = test.comparison;
  c.correlation = true;
  c.counts_in_p = true;
  c.radius = kCovarianceLags[lag].low;
  c.reach = kCovarianceLags[lag].high;
  c.middle_a = a.correlation(lag);
  c.middle_b = b.correlation(lag);
  test.distance = CovarianceDifference(a, b, lag);
  return test;
}

std::vector<StatisticTest> all_tests(const SurfaceStatistics& a, const SurfaceStatistics& b) {
  check_alike(a, b);
  std::vector<StatisticTest> tests;
  for (const LocalStatistic& statistic_a : a.local) {
    const LocalStatistic* statistic_b = b.find(statistic_a.quantity, statistic_a.radius);
    if (statistic_b != nullptr) tests.push_back(make_test(statistic_a, *statistic_b, a, b));
  }
  for (std::size_t lag = 0; lag < kCovarianceLags.size(); ++lag) {
    tests.push_back(make_test(a.regions, b.regions, lag));
  }
  for (StatisticTest& test : tests) test.comparison.distance = test.distance(own_regions());
  return tests;
}

// (#permutations x #tests) the distances with exchanged regions.
std::vector<double> exchanged_distances(const std::vector<StatisticTest>& tests, const Regions& a,
                                        const Regions& b, const RealismOptions& options,
                                        const Progress& progress) {
  const std::size_t count = tests.size();
  std::vector<double> distances(static_cast<std::size_t>(options.permutations) * count);
  reported_parallel_for(
      {0, options.permutations, options.permutations}, progress, "permutations", [&](std::int64_t k) {
        const auto row = static_cast<std::size_t>(k);
        const RegionLabels labels = exchanged_regions(a.groups, b.groups, options.seed, row);
        for (std::size_t t = 0; t < count; ++t) {
          distances[row * count + t] = tests[t].distance(labels);
        }
      });
  return distances;
}

// (1 + how many values are at least `own`) / (1 + their number). Rounding makes no difference.
double share_as_large(double own, std::span<const double> values) {
  const auto as_large =
      std::count_if(values.begin(), values.end(), [&](double v) { return v >= own * (1.0 - 1e-12); });
  return (1.0 + static_cast<double>(as_large)) / (1.0 + static_cast<double>(values.size()));
}

// The largest ratio of a distance to its 95 % quantile, of the surfaces themselves and of each permutation.
struct LargestRatios {
  double own = 0.0;
  std::vector<double> exchanged;
};

void add_ratios(double own, const std::vector<double>& exchanged, LargestRatios& largest) {
  std::vector<double> sorted = exchanged;
  std::sort(sorted.begin(), sorted.end());
  // A distance that no exchange reaches is large, and not undefined.
  constexpr double kLeastUsual = 1e-3;
  const double usual = std::max(sorted_quantile(sorted, 0.95), kLeastUsual);
  largest.own = std::max(largest.own, own / usual);
  for (std::size_t k = 0; k < exchanged.size(); ++k) {
    largest.exchanged[k] = std::max(largest.exchanged[k], exchanged[k] / usual);
  }
}

// Decides by the figures that stand in the verdict.
void decide(RealismVerdict& verdict) {
  const bool alike = verdict.p >= kPassingP && verdict.largest_distance <= kPassingDistance;
  verdict.too_coarse = alike && verdict.points < kFewestJudged;
  verdict.passes = alike && !verdict.too_coarse;
}

std::vector<BandRatio> band_ratios(const HeightBands& a, const HeightBands& b) {
  std::vector<BandRatio> ratios;
  for (std::size_t k = 0; k < std::min(a.bands.size(), b.bands.size()); ++k) {
    const HeightBand& band = a.bands[k];
    if (band.rms > 0.0) ratios.push_back({band.from, band.to, b.bands[k].rms / band.rms});
  }
  return ratios;
}

std::optional<double> coupling_ratio(const HeightBands& a, const HeightBands& b) {
  if (!a.coupling || !b.coupling || !(*a.coupling > 0.0)) return std::nullopt;
  return *b.coupling / *a.coupling;
}

}  // namespace

RegionLabels own_regions() {
  RegionLabels labels{};
  std::fill_n(labels.begin(), kRegions, true);
  return labels;
}

RegionLabels exchanged_regions(const RegionGroups& first_groups, const RegionGroups& second_groups,
                               std::uint64_t seed, std::uint64_t k) {
  std::array<bool, 2 * kRegionGroups> is_first{};
  std::fill_n(is_first.begin(), kRegionGroups, true);
  CounterRandom random(seed, k);
  for (std::size_t i = 0; i < kRegionGroups; ++i) {
    std::swap(is_first[i], is_first[i + random.below(is_first.size() - i)]);
  }
  RegionLabels labels{};
  for (std::size_t r = 0; r < kRegions; ++r) {
    labels[r] = is_first[first_groups[r]];
    labels[r + kRegions] = is_first[second_groups[r] + std::size_t{kRegionGroups}];
  }
  return labels;
}

KolmogorovSmirnov::KolmogorovSmirnov(const RegionalValues& a, const RegionalValues& b) {
  sorted_.reserve(a.values.size() + b.values.size());
  for (std::size_t i = 0; i < a.values.size(); ++i) sorted_.push_back({a.values[i], a.regions[i]});
  for (std::size_t i = 0; i < b.values.size(); ++i) {
    sorted_.push_back({b.values[i], static_cast<std::uint8_t>(b.regions[i] + kRegions)});
  }
  std::stable_sort(sorted_.begin(), sorted_.end(),
                   [](const Entry& x, const Entry& y) { return x.value < y.value; });
}

double KolmogorovSmirnov::operator()(const RegionLabels& first) const {
  std::int64_t firsts = 0;
  for (const Entry& e : sorted_) firsts += first[e.region] ? 1 : 0;
  const std::int64_t others = static_cast<std::int64_t>(sorted_.size()) - firsts;
  if (firsts == 0 || others == 0) return 0.0;
  // Counts of both samples up to a value, each times the size of the other sample: whole numbers.
  std::int64_t difference = 0, largest = 0;
  for (std::size_t i = 0; i < sorted_.size(); ++i) {
    difference += first[sorted_[i].region] ? others : -firsts;
    const bool is_last_equal = i + 1 == sorted_.size() || sorted_[i].value < sorted_[i + 1].value;
    if (is_last_equal) largest = std::max(largest, std::abs(difference));
  }
  return static_cast<double>(largest) / (static_cast<double>(firsts) * static_cast<double>(others));
}

CovarianceDifference::CovarianceDifference(const Regions& a, const Regions& b, std::size_t lag)
    : variance_(0.5 * (a.variance + b.variance)) {
  for (std::size_t r = 0; r < kRegions; ++r) {
    sums_[r] = a.pairs[r][lag];
    sums_[r + kRegions] = b.pairs[r][lag];
  }
}

double CovarianceDifference::operator()(const RegionLabels& first) const {
  std::array<PairSum, 2> totals{};
  for (std::size_t r = 0; r < sums_.size(); ++r) {
    PairSum& total = totals[first[r] ? 0 : 1];
    total.products += sums_[r].products;
    total.pairs += sums_[r].pairs;
  }
  if (!(totals[0].pairs > 0.0) || !(totals[1].pairs > 0.0) || !(variance_ > 0.0)) return 0.0;
  return std::fabs(totals[0].products / totals[0].pairs - totals[1].products / totals[1].pairs) / variance_;
}

const StatisticComparison* RealismVerdict::farthest() const {
  const StatisticComparison* found = nullptr;
  for (const StatisticComparison& c : statistics) {
    if (c.counts_in_distance && (found == nullptr || c.distance > found->distance)) found = &c;
  }
  return found;
}

std::vector<StatisticComparison> statistic_distances(const SurfaceStatistics& a, const SurfaceStatistics& b) {
  std::vector<StatisticComparison> statistics;
  for (const StatisticTest& test : all_tests(a, b)) statistics.push_back(test.comparison);
  return statistics;
}

double largest_distance(std::span<const StatisticComparison> statistics) {
  double largest = 0.0;
  for (const StatisticComparison& c : statistics) {
    if (c.counts_in_distance) largest = std::max(largest, c.distance);
  }
  return largest;
}

RealismVerdict judge_realism(const SurfaceStatistics& a, const SurfaceStatistics& b,
                             const RealismOptions& options, const Progress& progress) {
  if (options.permutations < 19 || options.permutations > 99999) {
    throw InputError("realism: permutations: " + std::to_string(options.permutations) +
                     " is outside 19 to 99999");
  }
  const std::vector<StatisticTest> tests = all_tests(a, b);
  const std::vector<double> distances = exchanged_distances(tests, a.regions, b.regions, options, progress);
  const auto permutations = static_cast<std::size_t>(options.permutations);
  RealismVerdict verdict;
  LargestRatios ratios{0.0, std::vector<double>(permutations, 0.0)};
  for (std::size_t t = 0; t < tests.size(); ++t) {
    StatisticComparison c = tests[t].comparison;
    std::vector<double> exchanged;
    for (std::size_t k = 0; k < permutations; ++k) exchanged.push_back(distances[k * tests.size() + t]);
    c.p = share_as_large(c.distance, exchanged);
    if (c.counts_in_p) add_ratios(c.distance, exchanged, ratios);
    verdict.statistics.push_back(c);
  }
  verdict.p = share_as_large(ratios.own, ratios.exchanged);
  verdict.largest_distance = largest_distance(verdict.statistics);
  verdict.points = a.points;
  decide(verdict);
  verdict.edge = a.edge;
  verdict.variance_ratio = a.regions.between > 0.0 ? b.regions.between / a.regions.between : 0.0;
  verdict.bands = band_ratios(a.heights, b.heights);
  verdict.coupling_ratio = coupling_ratio(a.heights, b.heights);
  return verdict;
}

RealismVerdict median_verdict(std::span<const RealismVerdict> verdicts) {
  RealismVerdict result = verdicts.front();
  const auto median_figure = [&](const auto& figure) {
    std::vector<double> values;
    for (const RealismVerdict& verdict : verdicts) values.push_back(figure(verdict));
    return median(values);
  };
  for (std::size_t s = 0; s < result.statistics.size(); ++s) {
    for (double StatisticComparison::*figure :
         {&StatisticComparison::distance, &StatisticComparison::p, &StatisticComparison::middle_b,
          &StatisticComparison::spread_b}) {
      result.statistics[s].*figure =
          median_figure([&](const RealismVerdict& verdict) { return verdict.statistics[s].*figure; });
    }
  }
  // A surface of a little less area may lack the largest band.
  for (const RealismVerdict& v : verdicts) {
    result.bands.resize(std::min(result.bands.size(), v.bands.size()));
    if (!v.coupling_ratio) result.coupling_ratio.reset();
  }
  for (std::size_t k = 0; k < result.bands.size(); ++k) {
    result.bands[k].ratio = median_figure([&](const RealismVerdict& v) { return v.bands[k].ratio; });
  }
  if (result.coupling_ratio) {
    result.coupling_ratio = median_figure([](const RealismVerdict& v) { return *v.coupling_ratio; });
  }
  result.p = median_figure([](const RealismVerdict& v) { return v.p; });
  result.largest_distance = median_figure([](const RealismVerdict& v) { return v.largest_distance; });
  result.variance_ratio = median_figure([](const RealismVerdict& v) { return v.variance_ratio; });
  decide(result);
  return result;
}

}  // namespace astrolith
