// Compares the optimisers at equal evaluations on the two searches of the thesis: the four global parameters
// of a base (number of spheres, two tensions, blend exponent), and the 34 parameters of its details. Prints a
// row of JSON for each optimiser with the fitness that it reaches from each seed.
//
//   optimizer_benchmark MESH EVALUATIONS SEEDS [BASE.json]     BASE.json: the details over this base, which
//                                                              fit_shape --base-only makes
#include <fmt/core.h>

#include <cstdlib>
#include <functional>
#include <nlohmann/json.hpp>

#include "estimation/shape/details/details_fit.h"
#include "estimation/shape/fit/shape_fit.h"
#include "estimation/shape/packing/sphere_packing.h"
#include "geometry/io/mesh_io.h"
#include "recipe/recipe_json.h"

namespace astrolith {
namespace {

constexpr int kSpheres = 100;
constexpr int kSamples = 800;

using Search = std::function<double(OptimizerAlgorithm, std::uint64_t seed)>;

Search details_search(const TargetBody& target, const std::string& file, int evaluations) {
  return [=, base = in_target_frame(target, read_recipe(file).body.value()), &target](
             OptimizerAlgorithm algorithm, std::uint64_t seed) {
    DetailsFitOptions options;
    options.optimizer = algorithm;
    options.generations = evaluations / options.population;
    options.seed = seed;
    return fit_details(target, base, options).optimization.value;
  };
}

Search base_search(const TargetBody& target, int evaluations) {
  PackingOptions packing;
  packing.max_spheres = kSpheres;
  return [=, spheres = pack_spheres(target.mesh, target.tree, packing).spheres,
          samples = sample_poisson_disk(target.surface, kSamples, 1)](OptimizerAlgorithm algorithm,
                                                                      std::uint64_t seed) {
    GlobalParameterSearchOptions options;
    options.max_spheres = kSpheres;
    options.optimize.algorithm = algorithm;
    options.optimize.max_evaluations = evaluations;
    options.optimize.seed = seed;
    return 1.0 - search_global_parameters(spheres, samples, options).similarity;
  };
}

}  // namespace
}  // namespace astrolith

int main(int argc, char** argv) {
  using namespace astrolith;
  if (argc < 4) return 2;
  const TargetBody target = prepare_target(read_mesh(argv[1]), argv[1]);
  const int evaluations = std::atoi(argv[2]), seeds = std::atoi(argv[3]);
  const Search search =
      argc > 4 ? details_search(target, argv[4], evaluations) : base_search(target, evaluations);
  for (const char* name : {"pso", "crs2", "isres", "esch", "sbplx"}) {
    std::vector<double> found;
    for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(seeds); ++seed)
      found.push_back(search(optimizer_from_name(name), seed));
    fmt::print("{}\n", nlohmann::json{{"optimizer", name}, {"found", found}}.dump());
    std::fflush(stdout);
  }
}
