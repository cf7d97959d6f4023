// Lays the layers of one recipe on the body of another.
#pragma once

#include <string>
#include <string_view>

#include "recipe/recipe.h"

namespace astrolith {

// What keeps its size where layers move to another body.
//   units   lengths, in the unit of the base: m and km convert into each other, px into nothing else, and the
//           unit "body" is the longest side of the base
//   body    shares of the longest side of the body that the layers had
//   edges   lengths in mean edges of the models that both bodies' reliefs were measured on
// A longest side is that of the bounding box of the body without layers, as a mesh of 64 cells shows it.
enum class BaseLengths { kUnits, kBody, kEdges };
// Throws InputError for other words than "units", "body" and "edges".
BaseLengths parse_base_lengths(std::string_view word);

// The base recipe with the layers of `details` after its own layers. Seed and frame are those of the base. A
// body in `details` is that from which the heights of reliefs are drawn; a relief takes the place of unnamed
// ones of the base. Throws InputError, which names the files by the two names, when the base has no body or
// an empty one, the units do not convert, or what should keep its size is missing.
Recipe lay_on_base(const Recipe& details, const std::string& details_name, const Recipe& base,
                   const std::string& base_name, BaseLengths lengths = BaseLengths::kUnits);

// The layer for another body than the one it was made for: a relief's heights are drawn from that one, where
// they are not already drawn from a third.
Layer drawn_from(const MetaballBody& measured, const Layer& layer);

// The recipe with the heights that its reliefs draw from other places, or fill, as measured ones of its own
// body. Throws InputError, which begins with `name`, where no relief does.
Recipe with_own_heights(Recipe recipe, const std::string& name);

// The layer for a body `ratio` times as large, or for a unit of length 1 / ratio times as long.
Layer rescaled(const Layer& layer, double ratio);

}  // namespace astrolith
