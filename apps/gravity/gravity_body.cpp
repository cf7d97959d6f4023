#include "apps/gravity/gravity_body.h"

#include "geometry/io/mesh_io.h"
#include "numerics/errors.h"
#include "recipe/recipe_json.h"
#include "tasks/synthesis/load_recipe.h"

namespace astrolith {

GravityBody read_gravity_body(const Program& program, const std::filesystem::path& file,
                              const std::string& unit, int resolution) {
  if (!is_recipe_name(file)) {
    return gravity_body(read_mesh(file), unit.empty() ? "km" : unit, file.string());
  }
  const Recipe recipe = load_recipe(file);
  if (!unit.empty() && unit != recipe.length_unit) {
    throw InputError("--unit: the recipe states " + recipe.length_unit + "; leave the option out");
  }
  return gravity_body(recipe, resolution, file.string(),
                      [&](const std::string& stage) { return program.progress(stage); });
}

}  // namespace astrolith
