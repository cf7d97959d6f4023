// Which of a recipe's layers made the surface at a point: the one that changed it most.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "geometry/io/ply_stream_writer.h"
#include "recipe/recipe.h"
#include "synthesis/field/implicit_field.h"

namespace astrolith {

inline constexpr std::size_t kLabelsChunk = 256;  // vertices that are labelled at once

// Label 0 is the bare body, and label i + 1 is layer i of the recipe. A layer's change at a point is the
// difference of the elevations with and without it, above the layers before it. Boulders come last, as they
// lie on all other layers. The label of a point is that of the largest |change|, and the earlier one of two
// equal changes. It is 0 where no change exceeds the rounding of the field. A warp or a mask changes nothing
// by itself.
class SurfaceLabels {
 public:
  // `field` is that of the recipe, made for `patch`, if there is one. The labels keep its model alive.
  SurfaceLabels(const Recipe& recipe, const ImplicitField& field, const std::optional<PatchCube>& patch = {});

  // Writes labels[i] of the point origin + vertices[i].position, which lies on the surface. The origin is the
  // centre of the patch, if there is one. Elevations are above the bare body, in length units. Both spans
  // have one size. If `ground` is not empty, ground[i] becomes F of the body without its boulders at the
  // point, length units.
  void label(const Vec3d& origin, std::span<const MeshVertex> vertices, std::span<VertexLabel> labels,
             std::span<float> ground = {}) const;

  // One line for each label, such as: label 2: craters "old ones".
  std::vector<std::string> legend() const { return legend_; }

 private:
  ImplicitField field_;
  std::vector<std::string> legend_;
  float rounding_ = 0.0f;  // bound of the rounding of F, length units
};

}  // namespace astrolith
