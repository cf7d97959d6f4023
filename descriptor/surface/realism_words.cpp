#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "descriptor/surface/realism.h"

namespace astrolith {
namespace {

enum class Side { less, alike, more };

// Where the middle of b lies beside that of a, if it is off by more than a quarter of a's spread.
Side side_of(const StatisticComparison& c) {
  const double off = c.middle_b - c.middle_a;
  if (std::fabs(off) <= 0.25 * c.spread_a) return Side::alike;
  return off < 0.0 ? Side::less : Side::more;
}

// A mean skewness beyond this shows boulders or craters.
constexpr double kClearSkewness = 0.05;

std::string skewness_words(const StatisticComparison& c) {
  const double a = c.middle_a, b = c.middle_b;
  if (b < a && a > kClearSkewness) return b < a / 3.0 ? "no boulders" : "too few boulders";
  if (b > a && a < -kClearSkewness) return b > a / 3.0 ? "no craters" : "too few craters";
  if (b > a && b > kClearSkewness) return "too many boulders";
  if (b < a && b < -kClearSkewness) return "too many craters";
  return c.spread_b < c.spread_a ? "boulders and craters stand out too little"
                                 : "boulders and craters stand out too much";
}

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

std::optional<std::string> roughness_words(const StatisticComparison& c) {
  switch (side_of(c)) {
    case Side::less:
      return "too smooth";
    case Side::more:
      return "too rough";
    default:
      return c.spread_b < c.spread_a ? "too much alike from place to place"
                                     : "too unlike from place to place";
  }
}

std::optional<std::string> radius_words(const StatisticComparison& c) {
  if (c.quantity == SurfaceQuantity::roughness) return roughness_words(c);
  const SurfaceQuantityTraits& traits = traits_of(c.quantity);
  const char* words = c.middle_b < c.middle_a ? traits.lower : traits.higher;
  return words != nullptr ? std::optional<std::string>(words) : std::nullopt;
}

std::string length_range(const Band& band, const RealismVerdict& verdict, const LengthWords& lengths) {
  return fmt::format("{} between {} and {} {}", band.words, length_in_words(band.from, verdict, lengths),
                     length_in_words(band.to, verdict, lengths), lengths.unit);
}

// Slopes between facets follow from roughness, and need no words of their own where that differs.
bool said_by_roughness(const StatisticComparison& c, const RealismVerdict& verdict) {
  return c.quantity == SurfaceQuantity::normals &&
         std::any_of(verdict.statistics.begin(), verdict.statistics.end(), [&](const auto& other) {
           return other.quantity == SurfaceQuantity::roughness && !other.correlation &&
                  other.radius == c.radius && other.differs();
         });
}

std::string slope_words(const StatisticComparison& c) {
  return fmt::format("{}: median slope {:.3g} instead of {:.3g} degrees",
                     c.middle_b < c.middle_a ? "too flat" : "too steep", c.middle_b, c.middle_a);
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
    if (!c.differs() || said_by_roughness(c, verdict)) continue;
    if (c.correlation) {
      add_once(correlation_words(c), others);
    } else if (c.quantity == SurfaceQuantity::skewness) {
      add_once(skewness_words(c), others);
    } else if (c.quantity == SurfaceQuantity::bend) {
      add_once("flat facets of a coarser mesh", others);
    } else if (c.quantity == SurfaceQuantity::slope) {
      add_once(slope_words(c), others);
    } else if (const std::optional<std::string> words = radius_words(c)) {
      add_band(*words, c.radius, bands);
    }
  }
  std::vector<std::string> all;
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
