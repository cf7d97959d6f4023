#include "tasks/description/feature_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "numerics/errors.h"
#include "numerics/files/output_file.h"
#include "numerics/sample_statistics.h"

namespace astrolith {
namespace {

constexpr double kLikely = 0.5;  // confidence from which a feature is drawn and measured

const char* feature_kind(BlobSign sign) { return sign == BlobSign::hollow ? "crater" : "boulder"; }

std::string features_to_csv(const FoundFeatures& found, const std::string& unit) {
  std::string text = "kind";
  for (const auto& [name, value] : feature_columns({})) text += std::string(",") + name;
  text += ",length_unit\n";
  for (const FoundFeature& f : found.features) {
    text += feature_kind(f.sign);
    for (const auto& [name, value] : feature_columns(f)) text += fmt::format(",{:.9g}", value);
    text += "," + unit + "\n";
  }
  return text;
}

std::string features_to_json(const FoundFeatures& found, const std::string& unit) {
  nlohmann::ordered_json features = nlohmann::ordered_json::array();
  for (const FoundFeature& f : found.features) {
    nlohmann::ordered_json row{{"kind", feature_kind(f.sign)}};
    for (const auto& [name, value] : feature_columns(f)) row[name] = value;
    features.push_back(row);
  }
  return nlohmann::ordered_json{{"length_unit", unit}, {"features", features}}.dump(2) + "\n";
}

// The numbers of one kind of at least each size, from the least one found up by steps of the square root
// of 2.
nlohmann::ordered_json sizes_json(const FoundFeatures& found, BlobSign sign) {
  nlohmann::ordered_json sizes = nlohmann::ordered_json::array();
  for (double least = kLeastFound * found.edge;; least *= std::sqrt(2.0)) {
    double number = 0.0, variance = 0.0;
    for (const FoundFeature& f : found.features) {
      if (f.sign != sign || f.diameter < least) continue;
      number += f.confidence;
      variance += f.confidence * (1.0 - f.confidence);
    }
    if (number < kLikely) return sizes;
    sizes.push_back({{"diameter", least}, {"number", number}, {"deviation", std::sqrt(variance)}});
  }
}

}  // namespace

std::vector<std::pair<const char*, double>> feature_columns(const FoundFeature& f) {
  return {{"x", f.place.x},
          {"y", f.place.y},
          {"z", f.place.z},
          {"center_x", f.center.x},
          {"center_y", f.center.y},
          {"center_z", f.center.z},
          {"normal_x", f.normal.x},
          {"normal_y", f.normal.y},
          {"normal_z", f.normal.z},
          {"diameter", f.diameter},
          {"depth", f.depth},
          {"rim_height", f.rim_height},
          {"freshness", f.freshness},
          {"completeness", f.completeness},
          {"confidence", f.confidence}};
}

FoundFeatures find_features(const NamedMesh& shape, const FeatureOptions& options, const Progress& progress) {
  try {
    return find_features(shape.mesh, options, progress);
  } catch (const InputError& e) {
    throw InputError(shape.name + ": " + e.what());
  }
}

void write_found_features(const FoundFeatures& found, const std::string& unit,
                          const std::filesystem::path& file) {
  write_file(file,
             file.extension() == ".json" ? features_to_json(found, unit) : features_to_csv(found, unit));
}

nlohmann::ordered_json found_json(const FoundFeatures& found, BlobSign sign) {
  std::vector<double> ratios;
  double largest = 0.0;
  std::int64_t listed = 0;
  for (const FoundFeature& f : found.features) {
    if (f.sign != sign) continue;
    ++listed;
    if (f.confidence < kLikely) continue;
    ratios.push_back(f.depth / f.diameter);
    largest = std::max(largest, f.diameter);
  }
  std::sort(ratios.begin(), ratios.end());
  nlohmann::ordered_json entry{{"points", found.points}, {"edge", found.edge},
                               {"listed", listed},       {"likely", ratios.size()},
                               {"largest", largest},     {"sizes", sizes_json(found, sign)}};
  if (ratios.empty()) return entry;
  for (const double share : {0.05, 0.25, 0.5, 0.75, 0.95})
    entry[sign == BlobSign::hollow ? "depth_over_diameter" : "height_over_diameter"].push_back(
        sorted_quantile(ratios, share));
  return entry;
}

void add_rings(const FoundFeatures& found, std::size_t most, PictureMarks& marks) {
  for (const FoundFeature& f : found.features) {
    if (f.confidence < kLikely || marks.rings.size() == most) return;
    marks.rings.push_back({f.center, f.normal, 0.5 * f.diameter, f.confidence});
  }
}

}  // namespace astrolith
