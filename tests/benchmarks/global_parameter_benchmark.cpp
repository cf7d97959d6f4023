// Compares the optimisers on the real problem of 4 dimensions (number of spheres, two tensions, blend
// exponent), at equal evaluations: 1 - similarity of the best base found for one mesh, over several seeds of
// the optimiser.
//
//   global_parameter_benchmark MESH [EVALUATIONS] [SEEDS]
#include <fmt/core.h>

#include <cstdlib>

#include "estimation/shape/fit/global_parameter_search.h"
#include "estimation/shape/packing/sphere_packing.h"
#include "estimation/shape/target/target_body.h"
#include "geometry/io/mesh_io.h"
#include "tests/benchmarks/optimizer_table.h"

namespace astrolith {
namespace {

constexpr int kSpheres = 100;
constexpr int kSamples = 800;

void compare_optimizers(const TargetBody& target, int evaluations, int seeds) {
  PackingOptions packing_options;
  packing_options.max_spheres = kSpheres;
  const Packing packing = pack_spheres(target.mesh, target.tree, packing_options);
  const SurfaceSamples samples = sample_poisson_disk(target.surface, kSamples, 1);
  print_optimizer_table(evaluations, seeds, [&](OptimizerAlgorithm algorithm, std::uint64_t seed) {
    GlobalParameterSearchOptions options;
    options.max_spheres = kSpheres;
    options.optimize.algorithm = algorithm;
    options.optimize.max_evaluations = evaluations;
    options.optimize.seed = seed;
    return 1.0 - search_global_parameters(packing.spheres, samples, options).similarity;
  });
}

}  // namespace
}  // namespace astrolith

int main(int argc, char** argv) {
  using namespace astrolith;
  if (argc < 2) {
    fmt::print(stderr, "usage: global_parameter_benchmark MESH [EVALUATIONS] [SEEDS]\n");
    return 2;
  }
  compare_optimizers(prepare_target(read_mesh(argv[1]), argv[1]), argc > 2 ? std::atoi(argv[2]) : 400,
                     argc > 3 ? std::atoi(argv[3]) : 5);
}
