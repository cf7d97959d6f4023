#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "descriptor/classification/classifier_file.h"
#include "descriptor/classification/classifier_format_internal.h"
#include "numerics/errors.h"
#include "numerics/files/output_file.h"

namespace astrolith {
namespace {

// JSON whose numbers are floats, written with as many digits as a float needs.
using FloatJson = nlohmann::basic_json<nlohmann::ordered_map, std::vector, std::string, bool, std::int64_t,
                                       std::uint64_t, float>;

FloatJson to_json(const DecisionTree& tree) {
  FloatJson rows = FloatJson::array();
  for (const TreeNode& node : tree) {
    if (node.feature < 0) {
      rows.push_back({node.next});
    } else {
      rows.push_back({node.feature, node.threshold, node.next});
    }
  }
  return rows;
}

FloatJson to_json(const ShapeClassifier& classifier, const std::string& tool) {
  const FeatureOptions& f = classifier.features;
  FloatJson json;
  json["format"] = kClassifierFormat;
  json["version"] = kClassifierVersion;
  json["tool"] = tool;
  json["features"] = {{"kind", name_of(f.kind)},
                      {"bins", f.bins},
                      {"eigenvalues", f.eigenvalues},
                      {"points", f.points},
                      {"seed", f.seed}};
  json["classes"] = classifier.classes;
  if (classifier.components) {
    json["components"] = {{"mean", classifier.components->mean}, {"axes", classifier.components->axes}};
  }
  json["forest"] = FloatJson::array();
  for (const DecisionTree& tree : classifier.forest.trees) json["forest"].push_back(to_json(tree));
  return json;
}

}  // namespace

void write_classifier(const ShapeClassifier& classifier, const std::string& tool,
                      const std::filesystem::path& file) {
  const std::string text =
      to_json(classifier, tool).dump(-1, ' ', false, FloatJson::error_handler_t::replace) + "\n";
  if (text.size() > kMaxClassifierBytes) {
    throw InputError(file.string() + ": would be larger than " + std::to_string(kMaxClassifierBytes >> 20) +
                     " MiB; take fewer trees, bins or components");
  }
  write_file(file, text);
}

}  // namespace astrolith
