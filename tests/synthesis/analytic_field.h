// Fields given by a formula, with a Lipschitz constant as their bound: the fields that tests mesh.
#pragma once

#include <functional>
#include <limits>
#include <span>

#include "synthesis/mesh/block_field.h"
#include "synthesis/mesh/mesher.h"

namespace astrolith::testing {

// F(p) must change by at most `lipschitz` per unit of length. Infinity switches culling off. One type serves
// all formulas, so that the mesher is compiled once for all of them.
class AnalyticField {
 public:
  using Function = std::function<double(const Vec3d&)>;

  class Block {
   public:
    Block(const AnalyticField& field, const Box& box) : field_(&field), box_(box) {}

    BlockContent content() const;
    Block restricted_to(const Box& child) const { return Block(*field_, child); }
    void evaluate(std::span<const float> x, std::span<const float> y, std::span<const float> z,
                  std::span<float> value, float band) const;

   private:
    const AnalyticField* field_;
    Box box_;
  };

  explicit AnalyticField(Function function, double lipschitz = std::numeric_limits<double>::infinity());

  Block gather(const Box& box) const { return Block(*this, box); }

 private:
  Function function_;
  double lipschitz_;
};

// The mesher's templates of these names for blocks of the usual size, compiled in analytic_field.cpp.
MeshStatistics mesh_field(const AnalyticField& field, const Box& bounds, int resolution, MeshSink& sink,
                          const Progress& progress = {}, MeshTile tile = {});
MeshStatistics mesh_patch(const AnalyticField& field, double size, int resolution, MeshSink& sink,
                          const Progress& progress = {});

inline Box cube_box(double half_side) {
  return {{-half_side, -half_side, -half_side}, {half_side, half_side, half_side}};
}

}  // namespace astrolith::testing
