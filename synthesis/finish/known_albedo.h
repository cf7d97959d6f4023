// The albedos of known bodies, for recipes that state none (recipe/albedo.h).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "recipe/recipe.h"

namespace astrolith {

struct KnownAlbedo {
  std::string_view name;
  GroundAlbedo ground;
  double mottling = 0.0;  // standard deviation of the logarithm over the ground
  BoulderAlbedo boulders;
  CraterAlbedo craters;
  std::string_view source;
};

std::span<const KnownAlbedo> known_albedos();
inline constexpr const char* kDrawnAlbedo = "drawn";

// A ground of an albedo drawn for a near-Earth asteroid: of two Rayleigh distributions, 25 % about .030 and
// the others about .168 (Wright et al. 2016). Dark ones are of the kind of Bennu's ground, bright ones of
// Itokawa's, each with a spectral slope of its own.
KnownAlbedo drawn_albedo(std::uint64_t seed);

// The known albedo of a name, or for "drawn" that which the seed draws. Throws InputError for another name.
KnownAlbedo named_albedo(std::string_view name, std::uint64_t seed);

// Gives the recipe this albedo in place of its own: the ground, its mottles as a layer of noise after all
// others, and the layers of craters and boulders. Expects a recipe with a body.
void set_albedo(Recipe& recipe, const KnownAlbedo& known);

}  // namespace astrolith
