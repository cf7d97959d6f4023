#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "descriptor/surface/realism.h"

namespace astrolith {
namespace {

// The waves that a radius shows are about one to two radii long. Radii in which the surfaces differ alike are
// said together.
struct Band {
  std::string words;
  double from = 0.0, to = 0.0;  // edges
};

void add_band(const std::string& words, double radius, std::vector<Band>& bands) {
  for (Band& band : bands) {
    if (band.words != words) continue;
    band.to = 2.0 * radius;
    return;
  }
  bands.push_back({words, radius, 2.0 * radius});
}

std::string length_range(const Band& band, const RealismVerdict& verdict, const LengthWords& lengths) {
  return fmt::format("{} between {} and {} {}", band.words, length_in_words(band.from, verdict, lengths),
                     length_in_words(band.to, verdict, lengths), lengths.unit);
}

// Whether another statistic of the same radius differs, and shows this difference.
bool shown_by_another(const StatisticComparison& c, const RealismVerdict& verdict) {
  const std::optional<SurfaceQuantity> shown_by = quantity_traits(c.quantity).follows;
  return !c.correlation && shown_by &&
         std::any_of(verdict.statistics.begin(), verdict.statistics.end(), [&](const auto& other) {
           return other.quantity == *shown_by && !other.correlation && other.radius == c.radius &&
                  other.differs();
         });
}

std::string correlation_words(const StatisticComparison& c) {
  return c.middle_b < c.middle_a ? "no rough and smooth regions" : "rough and smooth regions differ too much";
}

void add_once(const std::string& words, std::vector<std::string>& all) {
  if (std::find(all.begin(), all.end(), words) == all.end()) all.push_back(words);
}

}  // namespace

std::string length_in_words(double edges, const RealismVerdict& verdict, const LengthWords& lengths) {
  const double length = edges * verdict.edge * lengths.scale;
  if (!(length >= 100.0 && length < 1e6)) return fmt::format("{:.2g}", length);
  double unit = 1.0;
  while (length >= 100.0 * unit) unit *= 10.0;
  return fmt::format("{:.0f}", unit * std::round(length / unit));
}

std::vector<std::string> realism_words(const RealismVerdict& verdict, const LengthWords& lengths) {
  if (verdict.too_coarse) {
    return {fmt::format("too coarse to judge: {} points; give meshes of at least {} facets", verdict.points,
                        2 * kFewestJudged)};
  }
  if (verdict.passes) return {"passes"};
  std::vector<Band> bands;
  std::vector<std::string> others;
  for (const StatisticComparison& c : verdict.statistics) {
    if (!c.differs() || shown_by_another(c, verdict)) continue;
    const SurfaceQuantityTraits& traits = quantity_traits(c.quantity);
    if (c.correlation) {
      add_once(correlation_words(c), others);
    } else if (traits.by_scale) {
      add_band(traits.words(c), c.radius, bands);
    } else {
      add_once(traits.words(c), others);
    }
  }
  std::vector<std::string> all;
  if (!verdict.other_topology.empty()) all.push_back(verdict.other_topology);
  for (const Band& band : bands) all.push_back(length_range(band, verdict, lengths));
  all.insert(all.end(), others.begin(), others.end());
  if (all.empty()) all.emplace_back("differs, and no single statistic says in what");
  return all;
}

std::vector<std::string> band_words(const RealismVerdict& verdict, const LengthWords& lengths) {
  const auto [least, most] = kWantedBandRatio;
  std::vector<std::string> all;
  for (const BandRatio& band : verdict.bands) {
    if (band.ratio >= least && band.ratio <= most) continue;
    all.push_back(fmt::format("relief at scales of {} to {} {} is {:.2f} times as high; {} to {} wanted",
                              length_in_words(band.from, verdict, lengths),
                              length_in_words(band.to, verdict, lengths), lengths.unit, band.ratio, least,
                              most));
  }
  if (verdict.coupling_ratio.value_or(1.0) < kWantedCouplingRatio) {
    all.push_back(fmt::format(
        "high relief of one scale lies less where the next scale has it: {:.2f} times the coupling; "
        "at least {} wanted",
        *verdict.coupling_ratio, kWantedCouplingRatio));
  }
  return all;
}

}  // namespace astrolith
