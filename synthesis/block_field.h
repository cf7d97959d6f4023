// What a mesher asks of a field: that it can be narrowed to a box, say what it knows about the box as a
// whole, and be evaluated at points there.
#pragma once

#include <concepts>
#include <span>

#include "numerics/vec3.h"

namespace astrolith {

// What a box holds of the body. kOutside and kInside are proofs, for every point of the box: the first says
// F <= 0, the second F > 0. kMixed promises nothing.
enum class BlockContent { kOutside, kInside, kMixed };

// A field narrowed to a box. A point's value must have the same bits whichever boxes led to the block: what
// has been dropped would have added exactly nothing.
template <class Block>
concept FieldBlockLike = requires(const Block& block, const Box& child, std::span<const float> coordinates,
                                  std::span<float> values) {
  { block.content() } -> std::same_as<BlockContent>;
  { block.restricted_to(child) } -> std::convertible_to<Block>;
  // Positive inside the body; coordinates of as many points as there are values, all in the block's box.
  block.evaluate(coordinates, coordinates, coordinates, values);
};

template <class Field>
concept BlockField = requires(const Field& field, const Box& box) {
  { field.gather(box) } -> FieldBlockLike;
};

}  // namespace astrolith
