#include "estimation/shape/relief/relief_softening.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <variant>

#include "synthesis/body/ground_points.h"
#include "synthesis/relief/relief_picture.h"
#include "synthesis/relief/relief_shares.h"

namespace astrolith {
namespace {

// The places that the projections of the points take their heights from, each once.
std::vector<std::uint32_t> places_below(const std::vector<Vec3d>& points, const BodyGround& ground,
                                        const ReliefShares& shares) {
  GroundPoints feet(points);
  evaluate(ground, feet);
  project(ground, feet);
  std::vector<std::uint32_t> below;
  std::vector<float> unused;
  for (std::size_t i = 0; i < feet.size(); ++i) shares.add(feet.at(i), below, unused);
  std::sort(below.begin(), below.end());
  below.erase(std::unique(below.begin(), below.end()), below.end());
  return below;
}

std::uint16_t halved_code(const ReliefLayer& layer, std::uint16_t code) {
  const double height = layer.low + layer.step() * code;
  const double half = std::trunc(0.5 * height / layer.step()) * layer.step();  // so that it ends at 0
  return static_cast<std::uint16_t>(
      std::clamp(std::floor((half - layer.low) / layer.step() + 0.5), 0.0, layer.levels - 1.0));
}

}  // namespace

std::size_t halve_heights(const std::vector<Vec3d>& points, Recipe& recipe) {
  const auto of_recipe = std::find_if(recipe.layers.begin(), recipe.layers.end(), [](const Layer& layer) {
    return std::holds_alternative<ReliefLayer>(layer);
  });
  if (points.empty() || of_recipe == recipe.layers.end()) return 0;
  ReliefLayer& layer = std::get<ReliefLayer>(*of_recipe);
  ArrayStore arrays;
  const BodyTables body = make_body(*recipe.body, recipe.seed, arrays);
  const ReachingMetaballs metaballs = all_metaballs(body, arrays.view());
  const BodyGround ground{body, arrays.view(), metaballs.lists()};
  const std::vector<ReliefPlace> places = find_relief_places(ground, layer.spacing, "relief");
  const ReliefTiles tiles = make_relief_tiles(places, "relief");
  const ReliefLayout layout = relief_layout(places);
  auto image = std::make_shared<ExemplarImage>(*layer.pixels);
  std::size_t changed = 0;
  for (const std::uint32_t place : places_below(points, ground, ReliefShares(places, tiles, layer.spacing))) {
    const auto width = static_cast<std::size_t>(layout.width);
    std::uint16_t& value =
        image->values[layout.pixels[place] / width * static_cast<std::size_t>(image->width) +
                      layout.pixels[place] % width];
    const std::uint16_t halved = layer.value_of(halved_code(layer, layer.code_of(value)));
    changed += value != halved;
    value = halved;
  }
  layer.pixels = std::move(image);
  return changed;
}

}  // namespace astrolith
