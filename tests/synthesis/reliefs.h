// Relief layers whose heights are a function of the place.
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "recipe/recipe.h"
#include "synthesis/relief/relief_picture.h"

namespace astrolith::testing {

// The places of a recipe's body.
inline std::vector<ReliefPlace> find_places(const Recipe& recipe, double spacing) {
  ArrayStore arrays;
  const BodyTables body = make_body(*recipe.body, recipe.seed, arrays);
  const ReachingMetaballs metaballs = all_metaballs(body, arrays.view());
  return find_relief_places({body, arrays.view(), metaballs.lists()}, spacing, "test");
}

// A place in length units.
inline Vec3d position(const ReliefPlace& p, double spacing) {
  double at[3];
  at[p.axis] = static_cast<double>(p.w) * spacing;
  at[(p.axis + 1) % 3] = p.u * spacing;
  at[(p.axis + 2) % 3] = p.v * spacing;
  return {at[0], at[1], at[2]};
}

// A relief over the recipe's body with the heights `height(p)` at its places p, in 65,535 levels from low to
// high.
template <class Height>
ReliefLayer relief_layer(const Recipe& recipe, double spacing, double low, double high,
                         const Height& height) {
  ReliefLayer layer;
  layer.spacing = spacing;
  layer.low = low, layer.high = high;
  layer.levels = 65535;
  layer.image = "test.png";
  layer.image_sha256 = std::string(64, '0');
  const std::vector<ReliefPlace> places = find_places(recipe, spacing);
  const ReliefLayout layout = relief_layout(places);
  auto image = std::make_shared<ExemplarImage>();
  image->width = layout.width, image->height = layout.height;
  image->values.assign(static_cast<std::size_t>(layout.width) * static_cast<std::size_t>(layout.height), 0);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double code = (height(position(places[i], spacing)) - low) / layer.step();
    image->values[layout.pixels[i]] =
        layer.code_to_grey(static_cast<std::uint16_t>(std::clamp(code + 0.5, 0.0, 65534.0)));
  }
  layer.pixels = std::move(image);
  return layer;
}

}  // namespace astrolith::testing
