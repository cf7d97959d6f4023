#include "synthesis/finish/rough_ground.h"

#include <algorithm>
#include <vector>

#include "numerics/hash_random.h"
#include "numerics/parallel_for.h"
#include "numerics/portable_double.h"
#include "synthesis/field/bare_body.h"
#include "synthesis/field/implicit_field.h"
#include "synthesis/field/layer_join.h"
#include "synthesis/landforms/ground_roughness.h"

namespace astrolith {
namespace {

constexpr int kPlaces = 4096;
constexpr double kLeast = 1e-4;  // of the distance: below is what rounding makes of flat ground
constexpr double kSmooth = 0.25, kSmoothest = 0.1;  // of the median roughness, of the ground

ReliefLayer* last_relief(Recipe& recipe) {
  for (auto layer = recipe.layers.rbegin(); layer != recipe.layers.rend(); ++layer) {
    if (ReliefLayer* relief = std::get_if<ReliefLayer>(&*layer)) return relief;
  }
  return nullptr;
}

// The roughness of a relief over a distance at places that are uniform over the area of the bare body.
std::vector<double> roughness_of(const Recipe& recipe, ReliefLayer relief, double distance) {
  relief.use = {};
  Recipe alone = recipe;
  alone.layers = {relief};
  const ImplicitField field(alone);
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
  ReliefLayer* relief = last_relief(recipe);
  if (relief == nullptr) return {};
  const double distance = round_to_seven_digits(relief->donor_scale * relief->spacing);
  std::vector<double> roughness = roughness_of(recipe, *relief, distance);
  if (roughness.empty()) return {};
  std::sort(roughness.begin(), roughness.end());
  const auto quantile = [&](double share) {
    return roughness[static_cast<std::size_t>(share * static_cast<double>(roughness.size()))];
  };
  const double to = round_to_seven_digits(quantile(0.5)),
               from = round_to_seven_digits(std::max(kSmooth * to, quantile(kSmoothest)));
  if (!(to - from > kLeast * distance)) return {};
  if (relief->name.empty()) relief->name = "relief";
  double sum = 0.0;
  for (const double r : roughness) {
    sum += static_cast<double>(
        smooth_step(static_cast<float>(r), static_cast<float>(from), 1.0f / static_cast<float>(to - from)));
  }
  return RoughGround{{relief->name, from, to, distance}, sum / static_cast<double>(roughness.size())};
}

}  // namespace astrolith
