#include "tasks/description/surface_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "numerics/errors.h"
#include "numerics/files/output_file.h"
#include "numerics/sample_statistics.h"

namespace astrolith {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<double, 5> kShares{0.05, 0.25, 0.5, 0.75, 0.95};

Json distribution_json(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  Json quantiles = Json::array();
  for (const double share : kShares) {
    quantiles.push_back(sorted_quantile(values, share));
  }
  const auto n = static_cast<double>(values.size());
  double mean = 0.0, squares = 0.0;
  for (const double v : values) mean += v / n;
  for (const double v : values) squares += (v - mean) * (v - mean) / n;
  return {{"quantiles", quantiles}, {"mean", mean}, {"deviation", std::sqrt(squares)}};
}

// The radii of the local statistics, each with what was measured within it.
Json radii_json(const SurfaceStatistics& surface) {
  Json radii = Json::array();
  for (const LocalStatistic& statistic : surface.local) {
    if (!(statistic.radius > 0.0)) continue;
    if (radii.empty() || radii.back()["edges"] != statistic.radius) {
      radii.push_back({{"edges", statistic.radius}, {"length", statistic.radius * surface.edge}});
    }
    radii.back()[quantity_name(statistic.quantity)] = distribution_json(statistic.values);
  }
  return radii;
}

Json regions_json(const SurfaceStatistics& surface) {
  Json lags = Json::array();
  for (std::size_t lag = 0; lag < kCovarianceLags.size(); ++lag) {
    const auto [low, high] = kCovarianceLags[lag];
    lags.push_back({{"from", low * surface.edge},
                    {"to", high * surface.edge},
                    {"correlation", surface.regions.correlation(lag)}});
  }
  return {{"count", kRegions},
          {"variance", surface.regions.variance},
          {"variance_between", surface.regions.between},
          {"correlations", lags}};
}

Json lags_json(const SurfaceStatistics& surface) {
  Json lags = Json::array();
  for (const RoughnessAtLag& at : surface.lags) {
    lags.push_back({{"lag", at.lag * surface.edge}, {"difference", at.difference}});
  }
  return lags;
}

Json bands_json(const SurfaceStatistics& surface) {
  Json bands = Json::array();
  for (const HeightBand& band : surface.heights.bands) {
    bands.push_back(
        {{"from", band.from * surface.edge}, {"to", band.to * surface.edge}, {"rms_edges", band.rms}});
  }
  return bands;
}

Json statistic_json(const StatisticComparison& c, double edge) {
  Json entry{{"statistic", c.correlation ? "correlation" : quantity_name(c.quantity)}};
  if (c.correlation) {
    entry["from"] = c.radius * edge;
    entry["to"] = c.reach * edge;
  } else if (c.radius > 0.0) {
    entry["edges"] = c.radius;
    entry["radius"] = c.radius * edge;
  }
  entry["distance"] = c.distance;
  entry["p"] = c.p;
  entry["counts_in_p"] = c.counts_in_p;
  entry["counts_in_distance"] = c.counts_in_distance;
  entry["a"] = c.middle_a;
  entry["b"] = c.middle_b;
  return entry;
}

// The verdict for people, some lines: whether b passes, the figures that decide it, and the relief by scale.
std::vector<std::string> realism_lines(const RealismVerdict& verdict, const LengthWords& lengths) {
  const auto length = [&](double edges) { return length_in_words(edges, verdict, lengths); };
  const std::vector<std::string> words = realism_words(verdict, lengths);
  std::vector<std::string> lines{
      fmt::format("surface: {}{}",
                  verdict.passes || verdict.too_coarse ? "" : "does not pass: ", fmt::join(words, "; "))};
  lines.push_back(fmt::format("p {:.3f}; at least {} to pass", verdict.p, kPassingP));
  if (const StatisticComparison* c = verdict.farthest()) {
    const std::string within = c->radius > 0.0 ? " within " + length(c->radius) + " " + lengths.unit : "";
    lines.push_back(fmt::format("largest distance {:.3f}, of {}{}; at most {} to pass", c->distance,
                                quantity_name(c->quantity), within, kPassingDistance));
  } else {
    lines.emplace_back("no distance counts on so few points");
  }
  std::string ratios;
  for (const BandRatio& band : verdict.bands) {
    ratios += fmt::format("{}{:.2f} ({} to {} {})", ratios.empty() ? "" : ", ", band.ratio, length(band.from),
                          length(band.to), lengths.unit);
  }
  if (!ratios.empty()) lines.push_back("relief over A's, by scale: " + ratios);
  if (verdict.coupling_ratio) {
    lines.push_back(fmt::format("coupling of scales over A's: {:.2f}", *verdict.coupling_ratio));
  }
  for (const std::string& said : band_words(verdict, lengths)) lines.push_back("note: " + said);
  return lines;
}

}  // namespace

std::string column_name(const LocalStatistic& statistic) {
  const std::string name = quantity_name(statistic.quantity);
  return statistic.radius > 0.0 ? fmt::format("{}_{:g}", name, statistic.radius) : name;
}

LengthWords words_for_lengths(const std::string& unit, double length) {
  if (unit == "km" && length < 1.0) return {1000.0, "m"};
  return {1.0, unit.empty() ? "units" : unit};
}

SurfaceStatistics describe_surface(const NamedMesh& shape, const SurfaceStatisticsOptions& options,
                                   const Progress& progress) {
  try {
    return surface_statistics(shape.mesh, options, progress);
  } catch (const InputError& e) {
    throw InputError(shape.name + ": " + e.what());
  }
}

nlohmann::ordered_json surface_json(const SurfaceStatistics& surface) {
  Json entry{{"points", surface.points},        {"edge", surface.edge},
             {"places", surface.places.size()}, {"undefined_places", surface.undefined},
             {"radii", radii_json(surface)},    {"roughness_at_lags", lags_json(surface)},
             {"regions", regions_json(surface)}};
  entry["height_bands"] = bands_json(surface);
  if (surface.heights.coupling) entry["band_coupling"] = *surface.heights.coupling;
  for (const LocalStatistic& statistic : surface.local) {
    const char* const list = quantity_traits(statistic.quantity).list;
    if (list != nullptr) entry[list] = distribution_json(statistic.values);
  }
  return entry;
}

void write_surface_table(const SurfaceStatistics& surface, const std::filesystem::path& file) {
  std::string text = "x,y,z,region";
  for (const LocalStatistic& statistic : surface.local) (text += ",") += column_name(statistic);
  text += "\n";
  for (std::size_t i = 0; i < surface.places.size(); ++i) {
    const Vec3d& p = surface.places[i];
    text += fmt::format("{:.9g},{:.9g},{:.9g},{}", p.x, p.y, p.z, surface.regions.region_index[i]);
    for (const LocalStatistic& statistic : surface.local) {
      text += fmt::format(",{:.9g}", statistic.values[i]);
    }
    text += "\n";
  }
  write_file(file, text);
}

nlohmann::ordered_json realism_json(const RealismVerdict& verdict, const LengthWords& lengths) {
  Json statistics = Json::array();
  for (const StatisticComparison& c : verdict.statistics) {
    statistics.push_back(statistic_json(c, verdict.edge));
  }
  Json bands = Json::array();
  for (const BandRatio& band : verdict.bands) {
    bands.push_back(
        {{"from", band.from * verdict.edge}, {"to", band.to * verdict.edge}, {"ratio", band.ratio}});
  }
  Json entry{{"passes", verdict.passes},
             {"too_coarse", verdict.too_coarse},
             {"words", realism_words(verdict, lengths)},
             {"band_words", band_words(verdict, lengths)},
             {"p", verdict.p},
             {"largest_distance", verdict.largest_distance},
             {"variance_ratio", verdict.variance_ratio},
             {"edge", verdict.edge},
             {"bands", bands}};
  if (verdict.coupling_ratio) entry["coupling_ratio"] = *verdict.coupling_ratio;
  entry["statistics"] = statistics;
  return entry;
}

SurfaceComparison judge_surfaces(const NamedMesh& a, const NamedMesh& b, SurfaceStatisticsOptions options,
                                 bool with_floor, const std::string& unit, const StageProgress& progress) {
  if (options.points == 0) options.points = common_points(a.mesh, b.mesh);
  const std::uint64_t seed = options.seed;
  const auto sampled = [&](const NamedMesh& shape, std::uint64_t which) {
    options.seed = seed + which;
    return describe_surface(shape, options, progress("surface"));
  };
  const RealismOptions test{.permutations = 999, .seed = seed};
  SurfaceComparison comparison{{}, {}, {}, sampled(a, 0), sampled(b, 1)};
  comparison.verdict = judge_realism(comparison.a, comparison.b, test, progress("permutations"));
  const LengthWords lengths = words_for_lengths(unit, 3.0 * comparison.a.edge);
  comparison.figures = realism_json(comparison.verdict, lengths);
  comparison.lines = realism_lines(comparison.verdict, lengths);
  if (with_floor) {
    const RealismVerdict again = judge_realism(comparison.a, sampled(a, 2), test, progress("permutations"));
    comparison.figures["floor"] = {{"p", again.p}, {"largest_distance", again.largest_distance}};
    comparison.lines.push_back(
        fmt::format("A sampled again: p {:.3f}, largest distance {:.3f}", again.p, again.largest_distance));
  }
  return comparison;
}

}  // namespace astrolith
