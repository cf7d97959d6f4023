#include <fmt/format.h>

#include "recipe/fields_internal.h"
#include "recipe/recipe_json.h"

namespace astrolith {
namespace {

// Checks every number that would be written against its limits. The lists of fields call all other rules.
class FieldChecker final : public FieldVisitor {
 public:
  explicit FieldChecker(const Place& place) : FieldVisitor(Task::kCheck, place) {}

 private:
  void visit_number(double& number, const NumberLimits& limits) override { expect(number, limits, place()); }
  void visit_integer(int& number, const IntegerLimits& limits) override { expect(number, limits, place()); }
};

}  // namespace

void validate_recipe(const Recipe& recipe, const std::string& name) {
  const Place place(name);
  FieldChecker(place).inspect(recipe);
}

void expect(double value, const NumberLimits& limits, const Place& place) {
  const bool above = limits.low_is_allowed ? value >= limits.low : value > limits.low;
  if (above && value <= limits.high) return;  // NaN is outside
  const std::string words = fmt::format(fmt::runtime(limits.words), limits.low, limits.high);
  place.fail(fmt::format("must be {}, is {}; give a value in that range", words, value));
}

void expect(int value, const IntegerLimits& limits, const Place& place) {
  if (value >= limits.low && value <= limits.high) return;
  place.fail(fmt::format("must be an integer from {} to {}, is {}; give one in that range", limits.low,
                         limits.high, value));
}

}  // namespace astrolith
