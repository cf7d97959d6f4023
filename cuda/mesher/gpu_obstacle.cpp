#include "cuda/mesher/gpu_obstacle.h"

#include "synthesis/field/field_at_point.h"

namespace astrolith {
namespace {

// The most cells from which the impulses of a block may be drawn, over all Gabor layers or over all layers of
// spots. Every point of the block adds all these impulses.
constexpr double kMostCells = 32768.0;

}  // namespace

std::string obstacle_on_gpu(const FieldView& field, double block_side) {
  if (field.num_kept_heights > kMostKeptHeights) return "masks by more than four layers at a time";
  double gabor_cells = 0.0, spot_cells = 0.0;
  for (const FieldLayer& layer : std::span(field.layers, field.num_layers)) {
    if (const auto* gabor = gabor_impulses_of(layer.noise)) {
      gabor_cells += cells_of(*gabor, field.arrays, block_side + 2.0 * field.height_bound);
    } else if (const auto* spots = layer.noise.get_if<SpotNoise>()) {
      spot_cells += cells_of(*spots, field.arrays, block_side);
    }
  }
  if (spot_cells > kMostCells) return "spots so much smaller than the mesh's cells";
  return gabor_cells > kMostCells ? "Gabor kernels so much smaller than the mesh's cells" : "";
}

}  // namespace astrolith
