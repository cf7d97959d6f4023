#include "tests/synthesis/analytic_field.h"

#include <cstddef>
#include <utility>

namespace astrolith::testing {

AnalyticField::AnalyticField(Function function, double lipschitz)
    : function_(std::move(function)), lipschitz_(lipschitz) {}

BlockContent AnalyticField::Block::content() const {
  const double centre = field_->function_(box_.center());
  const double reach = field_->lipschitz_ * 0.5 * box_.diagonal();
  if (centre < -reach) return BlockContent::kOutside;
  return centre > reach ? BlockContent::kInside : BlockContent::kMixed;
}

void AnalyticField::Block::evaluate(std::span<const float> x, std::span<const float> y,
                                    std::span<const float> z, std::span<float> value, float /*band*/) const {
  for (std::size_t i = 0; i < value.size(); ++i) {
    value[i] = static_cast<float>(field_->function_({x[i], y[i], z[i]}));
  }
}

MeshStatistics mesh_field(const AnalyticField& field, const Box& bounds, int resolution, MeshSink& sink,
                          const Progress& progress, MeshTile tile) {
  return astrolith::mesh_field<kBlockCells>(field, bounds, resolution, sink, progress, tile);
}

MeshStatistics mesh_patch(const AnalyticField& field, double size, int resolution, MeshSink& sink,
                          const Progress& progress) {
  return astrolith::mesh_patch<kBlockCells>(field, size, resolution, sink, progress);
}

}  // namespace astrolith::testing
