#include "synthesis/finish/rough_ground.h"

#include <algorithm>
#include <string>
#include <vector>

#include "numerics/hash_random.h"
#include "numerics/parallel_for.h"
#include "numerics/portable_double.h"
#include "recipe/recipe_json.h"
#include "synthesis/field/bare_body.h"
#include "synthesis/field/implicit_field.h"
#include "synthesis/field/layer_join.h"
#include "synthesis/landforms/ground_roughness.h"

namespace astrolith {
namespace {

constexpr int kPlaces = 4096;
constexpr double kLeast = 1e-4;  // of the distance: below is what rounding makes of flat ground
constexpr double kSmooth = 0.25, kSmoothest = 0.1;  // of the median roughness, of the ground

// The number of the last relief; -1 where there is none.
int last_relief(const Recipe& recipe) {
  for (int i = static_cast<int>(recipe.layers.size()) - 1; i >= 0; --i) {
    if (std::holds_alternative<ReliefLayer>(recipe.layers[static_cast<std::size_t>(i)])) return i;
  }
  return -1;
}

// A name by which no layer goes.
std::string free_name(const Recipe& recipe) {
  std::string name = "relief";
  for (int k = 2; find_layer(recipe.layers, name) >= 0; ++k) name = "relief " + std::to_string(k);
  return name;
}

// The recipe whose elevation is the height of its layer `number` alone, a relief, which keeps its place in
// the list and with it its random numbers.
Recipe relief_alone(const Recipe& recipe, int number) {
  Recipe alone = recipe;
  alone.layers.resize(static_cast<std::size_t>(number) + 1);
  for (Layer& layer : alone.layers) {
    if (BoulderLayer* boulders = std::get_if<BoulderLayer>(&layer)) *boulders = BoulderLayer();
  }
  ReliefLayer& relief = std::get<ReliefLayer>(alone.layers.back());
  relief.use = {};
  relief.use.combination.kind = Combine::kReplace;
  relief.finer = 0;
  return alone;
}

// The roughness of a relief over a distance at places that are uniform over the area of the bare body.
std::vector<double> roughness_of(const Recipe& recipe, int number, double distance) {
  const ImplicitField field(relief_alone(recipe, number));
  const BareSurface surface(bare_body(recipe));
  CounterRandom random(recipe.seed);
  std::vector<Vec3d> numbers(kPlaces);
  for (Vec3d& n : numbers) n = {random.uniform(), random.uniform(), random.uniform()};
  const std::vector<Vec3d> places = surface.scatter(numbers);
  std::vector<double> roughness(places.size());
  // On the bare surface F is the height alone.
  const auto height = [&](const Vec3d& p) { return field.value(surface.projected(p)); };
  parallel_for(0, static_cast<std::int64_t>(places.size()), [&](std::int64_t i) {
    const Vec3d& p = places[static_cast<std::size_t>(i)];
    roughness[static_cast<std::size_t>(i)] = roughness_around(p, surface.normal(p), distance, height);
  });
  return roughness;
}

}  // namespace

std::optional<RoughGround> rough_ground(Recipe& recipe) {
  const int number = last_relief(recipe);
  if (number < 0) return {};
  ReliefLayer& relief = std::get<ReliefLayer>(recipe.layers[static_cast<std::size_t>(number)]);
  // A mask means the last layer of a name.
  if (!relief.name.empty() && find_layer(recipe.layers, relief.name) != number) return {};
  const double distance = round_to_seven_digits(relief.donor_scale * relief.spacing);
  std::vector<double> roughness = roughness_of(recipe, number, distance);
  if (roughness.empty()) return {};
  std::sort(roughness.begin(), roughness.end());
  const auto quantile = [&](double share) {
    return roughness[static_cast<std::size_t>(share * static_cast<double>(roughness.size()))];
  };
  const double to = round_to_seven_digits(quantile(0.5)),
               from = round_to_seven_digits(std::max(kSmooth * to, quantile(kSmoothest)));
  if (!(to - from > kLeast * distance)) return {};
  if (relief.name.empty()) relief.name = free_name(recipe);
  double sum = 0.0;
  for (const double r : roughness) {
    sum += static_cast<double>(
        smooth_step(static_cast<float>(r), static_cast<float>(from), 1.0f / static_cast<float>(to - from)));
  }
  return RoughGround{{relief.name, from, to, distance}, sum / static_cast<double>(roughness.size())};
}

}  // namespace astrolith
