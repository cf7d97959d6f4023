// Measures what learning the details of a surface gains (estimation/shape/learning): the verdict on the
// surface and the similarity of the shape histogram, of the details that a fitted recipe has and of the
// learnt ones on the same base. Prints rows of a table in Markdown.
//
//   learning_benchmark MESH RECIPE [-o LEARNT.json] [--noise N] [--landforms N] [--seeds N]
//
// The recipe is one that fit_shape wrote for the mesh, with or without details.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

#include "estimation/shape/details/detailed_check.h"
#include "estimation/shape/details/realism_check.h"
#include "estimation/shape/learning/learnt_details.h"
#include "geometry/io/mesh_io.h"
#include "recipe/recipe_json.h"
#include "tasks/synthesis/load_recipe.h"
#include "tests/benchmarks/processor_seconds.h"

namespace {

using namespace astrolith;

double distance_of(const RealismVerdict& verdict, SurfaceQuantity quantity, double radius) {
  for (const StatisticComparison& c : verdict.statistics) {
    if (!c.correlation && c.quantity == quantity && c.radius == radius) return c.distance;
  }
  return 0.0;
}

void print_row(const std::string& body, const std::string& what, const TargetBody& target,
               const Recipe& recipe, int seeds) {
  const FitRealism realism = check_realism(target, recipe, seeds, 1, {});
  const FitCheck check = check_recipe(target, recipe, 256, 5000, 1);
  const MeasuredSimilarity similarity =
      measure_similarity(target.surface, check.mesh, PairFeatures::ahd, 5000, 1);
  const RealismVerdict& v = realism.verdict;
  fmt::print(
      "| {} | {} | {} | {:.3f} | {:.3f} | {:.3f} / {:.3f} | {:.3f} / {:.3f} | {:.2f} | {:.3f} ({:.3f}) "
      "| {} | {} |",
      body, what, v.passes ? "passes" : "fails", v.p, v.largest_distance,
      distance_of(v, SurfaceQuantity::skewness, 3), distance_of(v, SurfaceQuantity::skewness, 6),
      distance_of(v, SurfaceQuantity::kurtosis, 3), distance_of(v, SurfaceQuantity::kurtosis, 6),
      v.variance_ratio, similarity.similarity, similarity.floor, check.topology.components,
      check.topology.genus);
  for (const std::string& words : realism_words(v, {})) fmt::print(" {};", words);
  fmt::print(" |\n");
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Learnt details beside those that a recipe has."};
  std::string mesh_file, recipe_file, output;
  LearningOptions options;
  int seeds = 3;
  bool quiet = false;
  app.add_option("mesh", mesh_file)->required();
  app.add_option("recipe", recipe_file)->required();
  app.add_option("-o", output);
  app.add_option("--noise", options.noise_evaluations);
  app.add_option("--landforms", options.landform_evaluations);
  app.add_option("--points", options.candidate.most_points);
  app.add_option("--places", options.candidate.places);
  app.add_option("--seeds", seeds);
  app.add_flag("--learnt-only", quiet);
  CLI11_PARSE(app, argc, argv);
  const std::string name = std::filesystem::path(mesh_file).stem().string();
  const TargetBody target = prepare_target(read_mesh(mesh_file), mesh_file);
  Recipe recipe = load_recipe(recipe_file);
  fmt::print(
      "| body | details | verdict | p | largest distance | skewness at 3 / 6 | kurtosis at 3 / 6 | "
      "variance ratio | similarity (floor) | components | genus | words |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  if (!quiet) print_row(name, "before", target, recipe, seeds);
  Recipe base = recipe;
  base.layers.clear();
  LearntDetails learnt;
  const double seconds = processor_seconds([&] { learnt = learn_details(target, base, options); });
  base = learnt.recipe;
  print_row(name, "learnt", target, base, seeds);
  Recipe fresh = base;
  fresh.seed += 50;
  print_row(name, "learnt, fresh seeds", target, fresh, seeds);
  fmt::print("\n{}: {} candidates in {:.0f} processor seconds\n", name, learnt.evaluations, seconds);
  for (const double best : learnt.history) fmt::print(" {:.4f}", best);
  fmt::print("\n");
  for (const JudgedCandidate& c : learnt.candidates) {
    fmt::print(
        "{}: distance {:.4f}, held out {:.4f}, similarity {:.4f}, variance ratio {:.2f}, components "
        "{:.1f}, genus {:.1f}{}\n",
        c.name, c.distance, c.held_out, c.similarity, c.variance_ratio, c.components, c.genus,
        c.kept ? ", kept" : "");
  }
  for (const std::string& words : learnt_words(learnt, 1.0, base.length_unit)) fmt::print("{}\n", words);
  if (!output.empty()) write_loaded_recipe(base, output);
  return 0;
}
