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

}  // namespace astrolith
