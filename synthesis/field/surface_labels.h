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

// Label 0 is the bare body, label i + 1 the recipe's layer i. A layer's part at a point is by how much it
// changed the elevation that the layers before it left there (boulders come last, as they lie on all others);
// the label is that of the largest part by magnitude, of equal ones the earlier, and 0 where none is above
// the rounding of the field. A warp or a mask has no part.
class SurfaceLabels {
 public:
  // `recipe` and `name` as for ImplicitField; throws as that does.
  SurfaceLabels(const Recipe& recipe, const std::string& name);

  // labels[i] of points on the surface, origin + vertices[i].position; elevations are above the bare body.
  void label(const Vec3d& origin, std::span<const MeshVertex> vertices, std::span<VertexLabel> labels) const;

  // "label 2: craters \"old ones\"", for each label.
  std::vector<std::string> legend() const { return legend_; }

 private:
  // The field with this layer and all that come before it.
  struct Stage {
    int label;
    ImplicitField field;
  };
  void label_some(const Vec3d& origin, std::span<const MeshVertex> vertices,
                  std::span<VertexLabel> labels) const;

  std::vector<Stage> stages_;  // the bare body first
  std::vector<std::string> legend_;
  float rounding_ = 0.0f;  // of the field's values
};

}  // namespace astrolith
