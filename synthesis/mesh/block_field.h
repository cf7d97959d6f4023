// What a mesher asks of a field: that it can be narrowed to a box, say what it knows about the box as a
// whole, and be evaluated at points there.
#pragma once

#include <concepts>
#include <limits>
#include <span>

#include "numerics/vec3.h"

namespace astrolith {

// What a box holds of the body. kOutside and kInside are proofs, for every point of the box: the first says
// F <= 0, the second F > 0. kMixed promises nothing.
enum class BlockContent { kOutside, kInside, kMixed };

// The accuracy band of a caller who needs F everywhere.
inline constexpr float kExactEverywhere = std::numeric_limits<float>::infinity();

// A field narrowed to a box. A point's value must have the same bits whichever boxes led to the block: what
// has been dropped would have added exactly nothing.
template <class Block>
concept FieldBlockLike = requires(const Block& block, const Box& child, std::span<const float> coordinates,
                                  std::span<float> values, float band) {
  { block.content() } -> std::same_as<BlockContent>;
  { block.restricted_to(child) } -> std::convertible_to<Block>;
  // F, positive inside the body; coordinates of as many points as there are values, all in the block's box.
  // Where |F| > band, any value of the same sign beyond the band does; which one depends on the point and the
  // band alone.
  block.evaluate(coordinates, coordinates, coordinates, values, band);
};

// A field that can give F at the corners of small tetrahedra, four after four, to first order about their
// centres, for less than as many points take: what depends on a tetrahedron does on its corners alone.
template <class Block>
concept HasTetrahedra = requires(const Block& block, std::span<const float> coordinates,
                                 std::span<float> values) {
  block.evaluate_tetrahedra(coordinates, coordinates, coordinates, values);
};

template <class Field>
concept BlockField = requires(const Field& field, const Box& box) {
  { field.gather(box) } -> FieldBlockLike;
};

}  // namespace astrolith
