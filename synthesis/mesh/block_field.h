// The concepts that a mesher needs of a field: it can be narrowed to a box, it can say what it knows about
// the whole box, and it can be evaluated at points of the box.
#pragma once

#include <concepts>
#include <cstdint>
#include <limits>
#include <span>

#include "numerics/vec3.h"

namespace astrolith {

// The knowledge about a whole box. kOutside and kInside are proofs for every point of the box: F <= 0 and F >
// 0. kMixed promises nothing.
enum class BlockContent { kOutside, kInside, kMixed };

// The accuracy band of callers who need the exact value of F everywhere.
inline constexpr float kExactEverywhere = std::numeric_limits<float>::infinity();

// A field narrowed to a box. The value at a point has the same bits whichever boxes led to the block: a
// contribution that was dropped would have added exactly zero.
template <class Block>
concept FieldBlockLike = requires(const Block& block, const Box& child, std::span<const float> coordinates,
                                  std::span<float> values, float band) {
  { block.content() } -> std::same_as<BlockContent>;
  { block.restricted_to(child) } -> std::convertible_to<Block>;
  // F, positive inside the body, at points of the block's box: three spans of coordinates as long as
  // `values`. Where |F| > band, evaluate may give any value of the same sign beyond the band, which must
  // depend on the point and the band alone.
  block.evaluate(coordinates, coordinates, coordinates, values, band);
};

// A field that can evaluate F at the corners of small tetrahedra, given four after four, to first order about
// the tetrahedra's centres. This costs less than evaluating as many independent points. What depends on a
// whole tetrahedron must depend on its corners alone.
template <class Block>
concept HasTetrahedra = requires(const Block& block, std::span<const float> coordinates,
                                 std::span<float> values) {
  block.evaluate_tetrahedra(coordinates, coordinates, coordinates, values);
};

// A field that can prove the sign of F at points of the block's box at a small part of the cost of F: sign[i]
// becomes 1 where evaluate() gives F > 0, -1 where it gives F < 0, and 0 where neither is proven. `tolerance`
// is the distance from the surface below which a proof is not worth much work, in length units.
template <class Block>
concept HasSureSigns = requires(const Block& block, std::span<const float> coordinates, float tolerance,
                                std::span<std::int8_t> sign) {
  block.find_signs(coordinates, coordinates, coordinates, tolerance, sign);
};

template <class Field>
concept BlockField = requires(const Field& field, const Box& box) {
  { field.gather(box) } -> FieldBlockLike;
};

}  // namespace astrolith
