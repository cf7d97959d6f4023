// Compares the optimisers on the real problem of 34 dimensions, at equal evaluations: the fitness of the best
// details found for one mesh, over several seeds of the optimiser.
//
//   details_optimizer_benchmark MESH BASE.json [EVALUATIONS] [SEEDS]      (BASE.json: from fit_shape
//   --base-only)
#include <fmt/core.h>

#include <cstdlib>

#include "estimation/shape/details/details_fit.h"
#include "geometry/io/mesh_io.h"
#include "recipe/recipe_json.h"
#include "tests/benchmarks/optimizer_table.h"

namespace astrolith {
namespace {

void compare_optimizers(const TargetBody& target, const MetaballBody& base, int evaluations, int seeds) {
  print_optimizer_table(evaluations, seeds, [&](OptimizerAlgorithm algorithm, std::uint64_t seed) {
    DetailsFitOptions options;
    options.optimizer = algorithm;
    options.generations = evaluations / options.population;
    options.seed = seed;
    return fit_details(target, base, options).optimization.value;
  });
}

}  // namespace
}  // namespace astrolith

int main(int argc, char** argv) {
  using namespace astrolith;
  if (argc < 3) {
    fmt::print(stderr, "usage: details_optimizer_benchmark MESH BASE.json [EVALUATIONS] [SEEDS]\n");
    return 2;
  }
  const TargetBody target = prepare_target(read_mesh(argv[1]), argv[1]);
  const Recipe recipe = read_recipe(argv[2]);
  if (!recipe.body) return 2;
  compare_optimizers(target, in_target_frame(target, *recipe.body), argc > 3 ? std::atoi(argv[3]) : 2000,
                     argc > 4 ? std::atoi(argv[4]) : 5);
}
