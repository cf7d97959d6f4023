#include "tasks/job/albedo_option.h"

#include "synthesis/finish/known_albedo.h"

namespace astrolith {
void AlbedoOption::add_to(OptionTable& options) {
  options
      .add_option(
          "--albedo", name,
          "how bright the ground, its craters and its boulders are, as on a known body: bennu, ryugu, "
          "itokawa, eros, 67p, vesta, or drawn, which is that of a near-Earth asteroid by the recipe's "
          "seed; replaces the recipe's own")
      .check(one_of({"bennu", "ryugu", "itokawa", "eros", "67p", "vesta", kDrawnAlbedo}))
      .default_text("")
      .placeholder("BODY");
}

void AlbedoOption::apply(Job& job, Recipe& recipe) const {
  if (name.empty()) return;
  const KnownAlbedo known = named_albedo(name, recipe.seed);
  set_albedo(recipe, known);
  job.summary["albedo"] = {
      {"name", name}, {"normal", known.ground.normal}, {"source", std::string(known.source)}};
}

}  // namespace astrolith
