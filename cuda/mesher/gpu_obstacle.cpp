#include "cuda/mesher/gpu_mesher.h"

#include "synthesis/field/field_at_point.h"

namespace astrolith {
namespace {

// The most cells from which the impulses of a block may be drawn, over all Gabor layers or over all layers of
// spots. Every point of the block adds all these impulses.
constexpr double kMostCells = 32768.0;

// Visits the noise of layer after layer: adds up the cells that the impulses of a block are drawn from.
struct ImpulseCells {
  const FieldView& field;
  double block_side;
  mutable double of_gabor = 0.0, of_spots = 0.0;

  template <class Noise>
  void operator()(const Noise& noise) const {
    constexpr NoiseLists kLists = Noise::kTraits.lists;
    if constexpr (kLists == NoiseLists::kGabor) {
      of_gabor += cells_of(noise, field.arrays, block_side + 2.0 * field.height_bound);
    } else if constexpr (kLists == NoiseLists::kSpots) {
      of_spots += cells_of(noise, field.arrays, block_side);
    } else {
      static_assert(kLists == NoiseLists::kNone || kLists == NoiseLists::kCraters);
    }
  }
};

}  // namespace

std::string obstacle_on_gpu(const FieldView& field, double block_side) {
  if (field.num_kept_heights > kMostKeptHeights) return "masks by more than 16 layers at a time";
  ImpulseCells cells{field, block_side};
  for (const FieldLayer& layer : std::span(field.layers, field.num_layers)) field.noise(layer).visit(cells);
  if (cells.of_spots > kMostCells) return "spots so much smaller than the mesh's cells";
  return cells.of_gabor > kMostCells ? "Gabor kernels so much smaller than the mesh's cells" : "";
}

}  // namespace astrolith
