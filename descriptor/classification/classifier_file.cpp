#include "descriptor/classification/classifier_file.h"

#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "numerics/errors.h"
#include "numerics/files/input_file.h"
#include "numerics/files/output_file.h"
#include "numerics/json_whole.h"

namespace astrolith {
namespace {

constexpr const char* kClassifierFormat = "astrolith classifier";

constexpr int kClassifierVersion = 1;

// A parsed file takes up to about twenty times the memory of its size.
constexpr std::uintmax_t kMaxClassifierBytes = std::uintmax_t{128} << 20;

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
  json["features"] = {{"kind", feature_name(f.kind)},
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

using Json = nlohmann::ordered_json;

constexpr std::int64_t kMaxClasses = 100000, kMaxComponents = 100000;

// A value in the file together with its place. Every accessor throws an InputError that names the place.
class Place {
 public:
  Place(const Json& json, std::string name) : json_(json), name_(std::move(name)) {}

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(name_ + ": " + what + "; train the classifier again");
  }
  Place field(const char* key) const {
    if (!has(key)) fail(std::string(key) + " is missing");
    return {json_[key], name_ + ": " + key};
  }
  Place at(std::size_t i) const { return {json_[i], name_ + "[" + std::to_string(i) + "]"}; }
  bool has(const char* key) const { return json_.is_object() && json_.contains(key); }
  std::size_t size() const {
    if (!json_.is_array()) fail("is no list");
    return json_.size();
  }
  std::string text() const {
    if (!json_.is_string()) fail("is no text");
    return json_.get<std::string>();
  }
  // A whole number between low and high.
  std::int64_t integer(std::int64_t low, std::int64_t high) const {
    const std::optional<std::int64_t> number = whole_number(json_, low, high);
    if (!number) fail("is no whole number between " + std::to_string(low) + " and " + std::to_string(high));
    return *number;
  }
  float number() const {
    const double value = json_.is_number() ? json_.get<double>() : std::nan("");
    if (!(std::fabs(value) <= static_cast<double>(std::numeric_limits<float>::max())))
      fail("is no finite number");
    return static_cast<float>(value);
  }

 private:
  const Json& json_;
  std::string name_;
};

std::vector<float> numbers(const Place& place, std::size_t count) {
  if (place.size() != count) {
    place.fail("has " + std::to_string(place.size()) + " numbers in place of " + std::to_string(count));
  }
  std::vector<float> values;
  for (std::size_t i = 0; i < count; ++i) values.push_back(place.at(i).number());
  return values;
}

FeatureOptions features_from(const Place& place) {
  FeatureOptions options;
  options.bins = static_cast<int>(place.field("bins").integer(2, 1024));
  options.eigenvalues = static_cast<int>(place.field("eigenvalues").integer(1, 500));
  options.points = place.field("points").integer(16, 100000);
  options.seed = static_cast<std::uint64_t>(place.field("seed").integer(0, std::int64_t{1} << 53));
  try {
    options.kind = feature_kind_from_name(place.field("kind").text());
    check(options);
  } catch (const InputError& e) {
    place.fail(e.what());
  }
  return options;
}

std::vector<std::string> classes_from(const Place& place) {
  std::vector<std::string> classes;
  std::set<std::string> seen;
  for (std::size_t i = 0; i < place.size(); ++i) {
    classes.push_back(place.at(i).text());
    if (!seen.insert(classes.back()).second) place.at(i).fail("names a class a second time");
  }
  if (classes.size() < 2 || classes.size() > kMaxClasses)
    place.fail("names fewer than two classes or too many");
  return classes;
}

PrincipalComponents components_from(const Place& place, std::size_t features) {
  PrincipalComponents components;
  components.mean = numbers(place.field("mean"), features);
  const Place axes = place.field("axes");
  if (axes.size() < 1 || axes.size() > kMaxComponents) axes.fail("holds no axes or too many");
  for (std::size_t i = 0; i < axes.size(); ++i) components.axes.push_back(numbers(axes.at(i), features));
  return components;
}

// A tree in the order of converted_tree. Nodes are read one by one, and the tree must be complete exactly at
// the end of the list.
DecisionTree tree_from(const Place& place, std::int64_t features, std::int64_t classes) {
  DecisionTree tree;
  std::vector<std::size_t> open;  // the nodes whose right side has not begun
  const std::size_t size = place.size();
  if (size == 0) place.fail("is empty");
  for (std::size_t i = 0; i < size; ++i) {
    const Place row = place.at(i);
    const bool leaf = row.size() == 1;
    if (!leaf && row.size() != 3) row.fail("has neither one nor three numbers");
    if (i > 0 && tree.back().feature < 0) {
      // A leaf is followed by the right side of the last open node.
      if (open.empty()) row.fail("does not belong to the tree");
      if (static_cast<std::size_t>(tree[open.back()].next) != i) row.fail("is not where its parent says");
      open.pop_back();
    }
    if (leaf) {
      tree.push_back({-1, 0, static_cast<std::int32_t>(row.at(0).integer(0, classes - 1))});
    } else {
      open.push_back(i);
      tree.push_back(
          {static_cast<std::int32_t>(row.at(0).integer(0, features - 1)), row.at(1).number(),
           static_cast<std::int32_t>(row.at(2).integer(0, std::numeric_limits<std::int32_t>::max()))});
    }
  }
  if (!open.empty() || tree.back().feature >= 0) place.fail("ends before all its branches do");
  return tree;
}

RandomForest forest_from(const Place& place, std::size_t features, std::size_t classes) {
  RandomForest forest{static_cast<int>(classes), {}};
  const std::size_t size = place.size();
  if (size == 0) place.fail("holds no trees");
  for (std::size_t i = 0; i < size; ++i) {
    forest.trees.push_back(
        tree_from(place.at(i), static_cast<std::int64_t>(features), static_cast<std::int64_t>(classes)));
  }
  return forest;
}

Json parse(const std::filesystem::path& file) {
  require_plain_file(file);
  const std::string name = file.string();
  if (std::filesystem::file_size(file) > kMaxClassifierBytes) {
    throw InputError(name + ": is larger than " + std::to_string(kMaxClassifierBytes >> 20) +
                     " MiB; give a file that classify train wrote");
  }
  std::ifstream in(file, std::ios::binary);
  try {
    return Json::parse(in);
  } catch (const nlohmann::json::exception& e) {
    throw InputError(name + ": " + e.what() + "; give a file that classify train wrote");
  }
}

}  // namespace

ShapeClassifier read_classifier(const std::filesystem::path& file) {
  const Json json = parse(file);
  const Place root(json, file.string());
  if (!root.has("format") || !json["format"].is_string() || json["format"] != kClassifierFormat) {
    throw InputError(file.string() + ": is no classifier; give a file that classify train wrote");
  }
  root.field("version").integer(kClassifierVersion, kClassifierVersion);
  ShapeClassifier classifier;
  classifier.features = features_from(root.field("features"));
  classifier.classes = classes_from(root.field("classes"));
  std::size_t inputs = feature_count(classifier.features);
  if (root.has("components")) {
    classifier.components = components_from(root.field("components"), inputs);
    inputs = classifier.components->axes.size();
  }
  classifier.forest = forest_from(root.field("forest"), inputs, classifier.classes.size());
  return classifier;
}

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
