// Synthesises known details and fits them again. Prints the ratios of the recovered height and frequency to
// the true ones, for several noises, frequencies, octaves and seeds of the truth.
//
//   details_recovery_benchmark [RESOLUTION of the target's mesh] [GENERATIONS] [SEEDS]
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "estimation/shape/details/details_fit.h"
#include "tests/estimation/shape/details/known_details.h"

namespace astrolith {
namespace {

constexpr const char* kNames[] = {"perlin", "simplex", "worley"};

struct Truth {
  std::size_t which;
  double frequency;  // per unit of a body 4.2 long
  int octaves;
};

FractalLayer layer_of(const Truth& truth) {
  FractalLayer layer;
  layer.noise = kDetailNoises[truth.which];
  layer.amplitude = 0.1 / truth.frequency;
  layer.frequency = truth.frequency;
  layer.octaves = truth.octaves;
  return layer;
}

// The largest error of a height or of a frequency.
double recover(const Truth& truth, int resolution, int generations, std::uint64_t seed) {
  const TargetBody target = testing::with_details({layer_of(truth)}, resolution, 1000 + seed);
  DetailsFitOptions options;
  options.generations = generations;
  options.seed = seed;
  options.fitness.seed = seed;
  options.fitness.recipe_seed = seed;
  const DetailsFitResult fit =
      fit_details(target, in_target_frame(target, testing::three_spheres()), options);
  const auto start =
      layers_in_file_frame(detail_layers(detail_parameters(fit.start, fit.ranges), fit.ranges), target);
  const testing::MeasuredLayers wanted = testing::measured({layer_of(truth)});
  const testing::MeasuredLayers first = testing::measured(start);
  const testing::MeasuredLayers last = testing::measured(layers_in_file_frame(fit.layers, target));
  fmt::print("{:8} {:5.1f} {:7} | {:8} {:6.3f} {:6.3f} | {:6.3f} {:6.3f} | {:.4f} {:.4f} {:.4f}\n",
             kNames[truth.which], truth.frequency, truth.octaves, kNames[fit.start.which],
             first.height / wanted.height, first.frequency / wanted.frequency, last.height / wanted.height,
             last.frequency / wanted.frequency, fit.base_score.similarity, fit.start_score.similarity,
             fit.score.similarity);
  std::fflush(stdout);
  return std::max(std::fabs(last.height / wanted.height - 1.0),
                  std::fabs(last.frequency / wanted.frequency - 1.0));
}

}  // namespace
}  // namespace astrolith

int main(int argc, char** argv) {
  const int resolution = argc > 1 ? std::atoi(argv[1]) : 160;
  const int generations = argc > 2 ? std::atoi(argv[2]) : 20;
  const int seeds = argc > 3 ? std::atoi(argv[3]) : 2;
  fmt::print(
      "truth: noise, frequency, octaves | start: noise, height, frequency over the truth's | fit: the same"
      " | similarity of base, start, fit\n");
  double largest = 0.0;
  for (int seed = 1; seed <= seeds; ++seed) {
    for (std::size_t which = 0; which < 3; ++which) {
      for (const double frequency : {3.0, 5.0}) {
        for (const int octaves : {1, 2}) {
          largest = std::max(largest, astrolith::recover({which, frequency, octaves}, resolution, generations,
                                                         static_cast<std::uint64_t>(seed)));
        }
      }
    }
  }
  fmt::print("largest error {:.1f} %\n", 100.0 * largest);
}
