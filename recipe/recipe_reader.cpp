#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>

#include "numerics/edit_distance.h"
#include "recipe/compact_document_internal.h"
#include "recipe/fields_internal.h"
#include "recipe/json_document_internal.h"
#include "recipe/recipe_json.h"

namespace astrolith {
namespace {

using nlohmann::json;

// A value of the file in words, such as "an object" or "the string "Km"".
std::string description(const json& value) {
  switch (value.type()) {
    case json::value_t::null:
      return "null";
    case json::value_t::object:
      return "an object";
    case json::value_t::array:
      return fmt::format("an array of {}", value.size());
    case json::value_t::string:
      return "the string " + quote_text(value.get_ref<const std::string&>());
    default:
      return value.dump();
  }
}

[[noreturn]] void fail_type(const json& value, const Place& place, std::string_view wanted) {
  place.fail(fmt::format("must be {}, is {}", wanted, description(value)));
}

// An integer in [low, high], which may be written as 8.0 or 1e3. Doubles must hold both bounds exactly.
double integral(const json& value, const Place& place, double low, double high) {
  if (!value.is_number()) fail_type(value, place, "an integer");
  const double number = value.get<double>();
  if (number != std::floor(number)) fail_type(value, place, "an integer");
  if (number < low || number > high) {
    fail_type(value, place, fmt::format("an integer from {:.0f} to {:.0f}", low, high));
  }
  return number;
}

// Names in the list of fields of an object that is being read.
struct ObjectNames {
  std::vector<std::string_view> known, missing;
};

[[noreturn]] void fail_unknown(const std::string& name, const std::vector<std::string_view>& known,
                               const Place& place) {
  const std::string_view shown = std::string_view(name).substr(0, 64);  // a hostile name costs no more
  const auto nearest = std::min_element(known.begin(), known.end(), [&](auto a, auto b) {
    return edit_distance(shown, a) < edit_distance(shown, b);
  });
  const std::string inner = quote_text(name);
  const Place here = place.field(std::string_view(inner).substr(1, inner.size() - 2));
  if (edit_distance(shown, *nearest) <= std::max<std::size_t>(2, nearest->size() / 3)) {
    here.fail(fmt::format("unknown field; did you mean '{}'?", *nearest));
  }
  here.fail(fmt::format("unknown field; known are {}", fmt::join(known, ", ")));
}

// Reads values from a JSON document and reports missing, mistyped and unknown fields. validate_recipe checks
// the limits.
class FieldReader final : public FieldVisitor {
 public:
  FieldReader(const json& document, const Place& place)
      : FieldVisitor(Task::kRead, place), values_{&document} {}

 private:
  void visit_number(double& number, const NumberLimits&) override {
    if (!current().is_number()) fail_type(current(), place(), "a number");
    number = current().get<double>();
  }
  void visit_integer(int& number, const IntegerLimits&) override {
    constexpr std::numeric_limits<int> kRange;
    number = static_cast<int>(integral(current(), place(), kRange.min(), kRange.max()));
  }
  void visit_seed(std::uint64_t& number) override {
    number = static_cast<std::uint64_t>(integral(current(), place(), 0.0, 0x1.0p53 - 1.0));
  }
  void visit_flag(bool& flag) override {
    if (!current().is_boolean()) fail_type(current(), place(), "true or false");
    flag = current().get<bool>();
  }
  void visit_text(std::string& text) override {
    if (!current().is_string()) fail_type(current(), place(), "a string");
    text = current().get<std::string>();
  }

  bool enter(std::string_view name, bool required, bool) override {
    objects_.back().known.push_back(name);
    const json& object = current();
    if (const auto found = object.find(name); found != object.end()) {
      values_.push_back(&*found);
      return true;
    }
    if (required) objects_.back().missing.push_back(name);
    return false;
  }
  void enter_element(std::size_t index) override { values_.push_back(&current()[index]); }
  void leave() override { values_.pop_back(); }

  void begin_object() override {
    if (!current().is_object()) fail_type(current(), place(), "an object");
    objects_.emplace_back();
  }
  // Unknown fields come first, since a misspelt name is also a missing one.
  void end_object() override {
    const auto& [known, missing] = objects_.back();
    for (const auto& [name, unused] : current().items()) {
      if (std::find(known.begin(), known.end(), name) == known.end()) fail_unknown(name, known, place());
    }
    if (!missing.empty()) place().field(missing.front()).fail("is missing; add it");
    objects_.pop_back();
  }
  std::vector<std::string> begin_members() override {
    begin_object();
    std::vector<std::string> names;
    for (const auto& [name, unused] : current().items()) names.push_back(name);
    return names;
  }
  void end_members() override { objects_.pop_back(); }

  std::size_t begin_array(std::size_t, std::span<const std::string_view> names, bool) override {
    if (!names.empty() && (!current().is_array() || current().size() != names.size())) {
      fail_type(current(), place(), fmt::format("[{}]", fmt::join(names, ", ")));
    }
    if (!current().is_array()) fail_type(current(), place(), "an array");
    return current().size();
  }

  const json& current() const { return *values_.back(); }

  std::vector<const json*> values_;  // from the document to the value at place()
  std::vector<ObjectNames> objects_;
};

}  // namespace

static json parse_document(std::string_view text, const std::string& name) {
  return is_compact(text) ? parse_compact(text, name) : parse_json(text, name);
}

Recipe parse_recipe(std::string_view text, const std::string& name) {
  const json document = parse_document(text, name);
  const Place place(name);
  Recipe recipe;
  FieldReader(document, place).visit(recipe);
  validate_recipe(recipe, name);
  return recipe;
}

Recipe read_recipe(const std::filesystem::path& file) {
  return parse_recipe(read_json_text(file), file.string());
}

std::vector<std::string> named_images(const std::filesystem::path& file) {
  const json document = parse_document(read_json_text(file), file.string());
  std::vector<std::string> names;
  const auto layers = document.find("layers");
  if (!document.is_object() || layers == document.end()) return names;
  for (const json& layer : *layers) {
    const auto image = layer.find("image");
    if (layer.is_object() && image != layer.end() && image->is_string()) names.push_back(*image);
  }
  return names;
}

}  // namespace astrolith
