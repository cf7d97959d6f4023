#include "cuda/mesher/gpu_mesher.h"

#include "synthesis/field/field_at_point.h"
#include "synthesis/field/gathering.h"

namespace astrolith {
namespace {

// Visits the noise of layer after layer: adds up the cells that the impulses of a block are drawn from, in
// the boxes that gather_gabor() and gather_spots() take. The block lies where coordinates are large, and with
// them what is added for their rounding.
struct ImpulseCells {
  const FieldView& field;
  Box block;
  const FieldLayer* layer = nullptr;
  mutable double gabor_cells = 0.0, spot_cells = 0.0;

  template <class Noise>
  void operator()(const Noise& noise) const {
    constexpr NoiseLists kLists = Noise::kTraits.lists;
    if constexpr (kLists == NoiseLists::kGabor) {
      gabor_cells += count_cells(noise, field.arrays, projected_block(field, block).longest_side());
    } else if constexpr (kLists == NoiseLists::kSpots) {
      spot_cells +=
          count_cells(noise, field.arrays, displaced_layer_box(block, layer->join.displaced).longest_side());
    } else {
      static_assert(kLists == NoiseLists::kNone || kLists == NoiseLists::kCraters);
    }
  }
};

}  // namespace

std::string obstacle_on_gpu(const FieldView& field, double block_side, double most_cells) {
  if (field.num_kept_heights > kMostKeptHeights) return "masks by more than 16 layers at a time";
  const Vec3d& far = field.body.supports.max;
  ImpulseCells cells{field, {far - Vec3d{block_side, block_side, block_side}, far}};
  for (const FieldLayer& layer : std::span(field.layers, field.num_layers)) {
    cells.layer = &layer;
    field.noise(layer).visit(cells);
  }
  if (cells.spot_cells > most_cells) return "spots so much smaller than the mesh's cells";
  return cells.gabor_cells > most_cells ? "Gabor kernels so much smaller than the mesh's cells" : "";
}

}  // namespace astrolith
