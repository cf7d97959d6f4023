// The fields of a family of bodies and their rules.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "numerics/errors.h"
#include "recipe/fields_internal.h"
#include "recipe/recipe_json.h"

namespace astrolith {
namespace {

struct Parameter {
  std::string_view name;
  bool stated;
  bool needed;
};

void check_parameters(const DrawnField& drawn, const Place& place) {
  const bool choice = drawn.distribution == Distribution::kChoice;
  const bool normal = drawn.distribution == Distribution::kNormal;
  const std::string_view word = distribution_word(drawn.distribution);
  for (const Parameter& p : {Parameter{"low", drawn.low.has_value(), !choice},
                             {"high", drawn.high.has_value(), !choice},
                             {"mean", drawn.mean.has_value(), normal},
                             {"deviation", drawn.deviation.has_value(), normal},
                             {"values", !drawn.values.empty(), choice}}) {
    if (p.needed && !p.stated) place.field(p.name).fail(fmt::format("is missing; \"{}\" needs it", word));
    if (p.stated && !p.needed)
      place.field(p.name).fail(fmt::format("has no meaning for \"{}\"; leave it out", word));
  }
}

void check_range(const DrawnField& drawn, const Place& place) {
  if (!drawn.low) return;
  const double low = *drawn.low, high = *drawn.high;
  if (!(low <= high)) place.field("high").fail(fmt::format("must be at least low, {:g}, is {:g}", low, high));
  if (drawn.distribution == Distribution::kLogUniform && !(low > 0.0)) {
    place.field("low").fail(fmt::format("must be above 0 for \"log_uniform\", is {:g}", low));
  }
  if (drawn.distribution == Distribution::kInteger && !(low == std::floor(low) && high == std::floor(high))) {
    place.fail("low and high must be whole numbers for \"integer\"");
  }
  // Else nearly every draw would be thrown away.
  if (drawn.distribution != Distribution::kNormal) return;
  const double mean = *drawn.mean, deviation = *drawn.deviation;
  if (low > mean + 2.0 * deviation || high < mean - 2.0 * deviation || high - low < 0.1 * deviation) {
    place.fail(
        "low to high must be at least a tenth of the deviation wide, and reach within two deviations of the "
        "mean; widen it");
  }
}

void check_drawn_field(const DrawnField& drawn, const Place& place) {
  check_parameters(drawn, place);
  check_range(drawn, place);
}

void check_list(const Family& family, const Place& place) {
  const std::size_t size = family.fields.size();
  if (size > kMostDrawnFields) {
    place.field("fields").fail(fmt::format("must be {} at most, are {}", kMostDrawnFields, size));
  }
  for (std::size_t i = 0; i < size; ++i) {
    const std::string& field = family.fields[i].field;
    if (std::any_of(family.fields.begin(), family.fields.begin() + static_cast<std::ptrdiff_t>(i),
                    [&](const DrawnField& other) { return other.field == field; })) {
      place.field("fields").element(i).field("field").fail("is drawn twice: " + quote_text(field));
    }
  }
}

// Sets the numbers whose paths are wanted while it walks through a recipe.
class NumberSetter final : public FieldVisitor {
 public:
  NumberSetter(const Place& place, const std::vector<std::string_view>& fields,
               const std::vector<double>& numbers, bool only_asks = false)
      : FieldVisitor(Task::kDescribe, place),
        fields_(fields),
        numbers_(numbers),
        found_(fields.size(), false),
        whole_(fields.size(), false),
        only_asks_(only_asks) {}

  int first_missing() const {
    const auto missing = std::find(found_.begin(), found_.end(), false);
    return missing == found_.end() ? -1 : static_cast<int>(missing - found_.begin());
  }
  // Whether a field holds a whole number.
  bool is_whole(std::size_t i) const { return whole_[i]; }

 private:
  void visit_number(double& number, const NumberLimits&) override {
    if (const double* wanted = wanted_here()) number = *wanted;
  }
  void visit_integer(int& number, const IntegerLimits& limits) override {
    if (const double* wanted = wanted_whole()) {
      number = static_cast<int>(whole(*wanted, limits.low, limits.high));
    }
  }
  void visit_seed(std::uint64_t& number) override {
    if (const double* wanted = wanted_whole()) {
      number = static_cast<std::uint64_t>(whole(*wanted, 0.0, 0x1.0p53 - 1.0));
    }
  }

  double whole(double value, double low, double high) const {
    if (value != std::floor(value) || value < low || value > high) {
      place().fail(
          fmt::format("must be an integer from {:.0f} to {:.0f}, is drawn as {:g}", low, high, value));
    }
    return value;
  }

  // The number for a field that holds a whole one. It is null while the setter only asks which fields do.
  const double* wanted_whole() {
    const double* const wanted = wanted_here();
    if (wanted == nullptr) return nullptr;
    whole_[static_cast<std::size_t>(wanted - numbers_.data())] = true;
    return only_asks_ ? nullptr : wanted;
  }

  const double* wanted_here() {
    if (place().is("format_version")) return nullptr;
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      if (!place().is(fields_[i])) continue;
      found_[i] = true;
      return &numbers_[i];
    }
    return nullptr;
  }

  const std::vector<std::string_view>& fields_;
  const std::vector<double>& numbers_;
  std::vector<bool> found_, whole_;
  bool only_asks_;
};

bool draws_whole_numbers(const DrawnField& drawn) {
  return drawn.distribution == Distribution::kInteger ||
         (drawn.distribution == Distribution::kChoice &&
          std::all_of(drawn.values.begin(), drawn.values.end(), [](double v) { return v == std::floor(v); }));
}

// A field that holds a whole number must draw one.
void check_whole_numbers(const Recipe& recipe, const Place& place) {
  const std::vector<DrawnField>& drawn = recipe.family->fields;
  std::vector<std::string_view> fields;
  for (const DrawnField& d : drawn) fields.push_back(d.field);
  const std::vector<double> ones(drawn.size(), 1.0);  // any number will do
  Recipe changed = recipe;
  const std::string name = "recipe";
  const Place root(name);
  NumberSetter setter(root, fields, ones, true);
  setter.visit(changed);
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    if (!setter.is_whole(i) || draws_whole_numbers(drawn[i])) continue;
    place.field("family")
        .field("fields")
        .element(i)
        .field("distribution")
        .fail("must be \"integer\", or a choice among whole numbers, since " + drawn[i].field +
              " is a whole number");
  }
}

using DrawnEnd = double (*)(const DrawnField&);

// The recipe must be valid where all drawn numbers are at one end of their ranges.
void check_end(const Recipe& recipe, DrawnEnd find_end, std::string_view words, const Place& place) {
  std::vector<std::string_view> fields;
  std::vector<double> numbers;
  for (const DrawnField& drawn : recipe.family->fields) {
    fields.push_back(drawn.field);
    numbers.push_back(find_end(drawn));
  }
  Recipe changed = recipe;
  changed.family.reset();
  const Place family = place.field("family");
  int missing = -1;
  try {
    missing = set_numbers(changed, fields, numbers);
    if (missing < 0) validate_recipe(changed, "recipe");
  } catch (const InputError& e) {
    const std::string_view message = e.what();
    family.fail(fmt::format("with the {} numbers, {}", words, message.substr(message.find(": ") + 2)));
  }
  if (missing < 0) return;
  family.field("fields")
      .element(static_cast<std::size_t>(missing))
      .field("field")
      .fail("names no number of this recipe: " + quote_text(fields[static_cast<std::size_t>(missing)]));
}

}  // namespace

double min_value(const DrawnField& drawn) {
  return drawn.low ? *drawn.low : *std::min_element(drawn.values.begin(), drawn.values.end());
}

double max_value(const DrawnField& drawn) {
  return drawn.high ? *drawn.high : *std::max_element(drawn.values.begin(), drawn.values.end());
}

int set_numbers(Recipe& recipe, const std::vector<std::string_view>& fields,
                const std::vector<double>& numbers) {
  const std::string name = "recipe";
  const Place place(name);
  NumberSetter setter(place, fields, numbers);
  setter.visit(recipe);
  return setter.first_missing();
}

void visit_fields(FieldVisitor& v, DrawnField& drawn) {
  v.required("field", drawn.field);
  v.word("distribution", drawn.distribution, kDistributions, distribution_word);
  v.field("low", drawn.low, kAnyNumber);
  v.field("high", drawn.high, kAnyNumber);
  v.field("mean", drawn.mean, kAnyNumber);
  v.field("deviation", drawn.deviation, kPositive);
  v.field_if(!drawn.values.empty(), "values", drawn.values, kAnyNumber);
  v.rule(check_drawn_field, drawn);
}

void visit_fields(FieldVisitor& v, Family& family) {
  v.field("fields", family.fields);
  v.field("any_view", family.any_view);
  v.field("any_sun", family.any_sun);
  v.rule(check_list, family);
}

void check_family(const Recipe& recipe, const Place& place) {
  if (!recipe.family || recipe.family->fields.empty()) return;
  check_whole_numbers(recipe, place);
  check_end(recipe, min_value, "least", place);
  check_end(recipe, max_value, "greatest", place);
}

}  // namespace astrolith
