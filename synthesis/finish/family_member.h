// The members of a recipe's family.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "numerics/vec3.h"
#include "recipe/recipe.h"
#include "synthesis/finish/population_draw.h"

namespace astrolith {

struct FamilyMember {
  Recipe recipe;                                      // without a family, with a seed of its own
  std::vector<std::pair<std::string, double>> drawn;  // by the field's path, in the family's order
  std::optional<DrawnBody> body;                      // of a recipe with a population
  Vec3d view;                                         // unit direction from the body to the viewer
  Vec3d sun;  // unit direction towards the sun in the axes of the view: right, up, to the viewer; z >= 0
};

// Member `number` of the recipe's family, a function of both alone: its seed is drawn from the recipe's seed
// and the number, and each field from that seed and its index in the list, so that a field that comes later
// changes none before it. The number is the seed of a recipe without a family and a population. A body is
// drawn from a population after the fields. Throws InputError "recipe: field: ..." where the drawn numbers
// break a rule together.
FamilyMember family_member(const Recipe& recipe, std::uint64_t number);

}  // namespace astrolith
