#include "tasks/synth/finish.h"

#include <fmt/format.h>

#include "numerics/errors.h"
#include "synthesis/finish/known_population.h"

namespace astrolith {
namespace {

// Which sizes of a layer are measured, in words.
std::string measured_words(const FinishLayer& layer, const std::string& unit) {
  if (layer.measured_from <= layer.least) return "measured";
  if (layer.measured_from >= layer.greatest) {
    return fmt::format("drawn by the law that was measured from {:.4g} {} up", layer.measured_from, unit);
  }
  return fmt::format("measured down to {:.4g} {}, drawn by the same law below", layer.measured_from, unit);
}

std::string describe(const FinishLayer& layer, const std::string& unit) {
  return fmt::format("{} of {:.4g} to {:.4g} {}, {:.3g} on a square {}: {} ({})",
                     layer.known.craters ? "craters" : "boulders", layer.least, layer.greatest, unit,
                     layer.density, unit, measured_words(layer, unit), layer.known.source);
}

nlohmann::ordered_json to_json(const FinishLayer& layer) {
  return {{"layer", layer.layer},
          {"kind", layer.known.craters ? "craters" : "boulders"},
          {"least", layer.least},
          {"greatest", layer.greatest},
          {"density", layer.density},
          {"measured_from", layer.measured_from},
          {"source", std::string(layer.known.source)}};
}

// The ground of a patch is about twice as large as a side of its cube where it is rough.
void require_room(const FinishLayer& layer, double patch_side) {
  const double number = 2.0 * layer.density * patch_side * patch_side;
  if (number <= kMaxDrawnLandforms) return;
  throw InputError(
      fmt::format("--to: a patch of side {:g} would hold some {:.2g} {} of {:.4g} and more, of which at most "
                  "1e6 are drawn; raise it, or make a smaller patch",
                  patch_side, number, layer.known.craters ? "craters" : "boulders", layer.least));
}

Recipe with_landforms(Job& job, const FinishOptions& options, const Recipe& recipe, const std::string& file,
                      double patch_side) {
  Finish finish = finish_recipe(
      recipe, file,
      {options.body, options.from > 0.0 ? std::optional(options.from) : std::nullopt, options.to});
  for (const FinishLayer& layer : finish.layers) require_room(layer, patch_side);
  auto layers = nlohmann::ordered_json::array();
  for (const FinishLayer& layer : finish.layers) {
    layers.push_back(to_json(layer));
    job.say(fmt::format("finish {}: {}", options.body, describe(layer, recipe.length_unit)));
  }
  if (!finish.without_craters.empty()) {
    job.say(fmt::format("finish {}: no craters, since {}", options.body, finish.without_craters));
  }
  job.summary["finish"] = {
      {"body", options.body}, {"from", finish.from}, {"to", finish.to}, {"layers", std::move(layers)}};
  return std::move(finish.recipe);
}

}  // namespace

void declare_finish_options(Job& job, FinishOptions& options) {
  Option finish =
      job.options
          .add_option(
              "--finish", options.body,
              "continue craters and boulders below the recipe's finest size as counts of a known body "
              "say: itokawa, bennu, eros, ryugu, dimorphos or none; the summary says what is measured and "
              "what is drawn")
          .check(one_of({"itokawa", "bennu", "eros", "ryugu", "dimorphos", "none"}))
          .placeholder("BODY")
          .default_text("none");
  job.options.add_option("--to", options.to, "with --finish: the least size, in the recipe's unit")
      .check(in_range(1e-6, 1e6))
      .needs(finish)
      .default_text("")
      .placeholder("SIZE");
  job.options
      .add_option(
          "--from", options.from,
          "with --finish: the greatest size; if absent, the smallest crater or boulder of the recipe, the "
          "distance of a relief's heights, or else the smallest metaball")
      .check(in_range(1e-6, 1e6))
      .needs(finish)
      .default_text("")
      .placeholder("SIZE");
  options.albedo.add_to(job.options);
}

void check_finish(const FinishOptions& options) {
  if (options.wanted() && !(options.to > 0.0)) {
    throw InputError("--finish: needs the least size; add --to SIZE, in the recipe's unit");
  }
}

Recipe finished(Job& job, const FinishOptions& options, const Recipe& recipe, const std::string& file,
                double patch_side) {
  Recipe made = options.wanted() ? with_landforms(job, options, recipe, file, patch_side) : recipe;
  options.albedo.apply(job, made);
  return made;
}

}  // namespace astrolith
