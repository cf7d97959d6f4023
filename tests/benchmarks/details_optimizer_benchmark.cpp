// The optimisers on the real problem of 34 dimensions, at equal evaluations: fitness of the best details
// found for one mesh, over several seeds of the optimiser.
//
//   details_optimizer_benchmark MESH BASE.json [EVALUATIONS] [SEEDS]      (BASE.json: of fit_shape
//   --base-only)
#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "estimation/shape/details/details_fit.h"
#include "geometry/mesh_io.h"
#include "recipe/recipe_json.h"

namespace astrolith {
namespace {

MetaballBody in_target_frame(MetaballBody body, const TargetBody& target) {
  for (Sphere& s : body.spheres) {
    s = {(s.center - target.center) * (1.0 / target.diagonal), s.radius / target.diagonal};
  }
  return body;
}

void compare_optimizers(const TargetBody& target, const MetaballBody& base, int evaluations, int seeds) {
  fmt::print("fitness after {} evaluations, {} seeds\n{:8} {:>8} {:>8} {:>8}\n", evaluations, seeds, "",
             "least", "median", "largest");
  for (const char* name : {"pso", "crs2", "isres", "esch", "sbplx", "cmaes"}) {
    std::vector<double> values;
    for (int seed = 1; seed <= seeds; ++seed) {
      DetailsFitOptions options;
      options.optimizer = optimizer_from_name(name);
      options.generations = evaluations / options.population;
      options.seed = static_cast<std::uint64_t>(seed);
      values.push_back(fit_details(target, base, options).optimization.value);
    }
    std::sort(values.begin(), values.end());
    fmt::print("{:8} {:8.5f} {:8.5f} {:8.5f}\n", name, values.front(), values[values.size() / 2],
               values.back());
    std::fflush(stdout);
  }
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
  compare_optimizers(target, in_target_frame(*recipe.body, target), argc > 3 ? std::atoi(argv[3]) : 2000,
                     argc > 4 ? std::atoi(argv[4]) : 5);
}
