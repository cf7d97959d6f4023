#include "cuda/mesher/gpu_mesher.h"

#include <algorithm>

#include "synthesis/field/field_at_point.h"
#include "synthesis/field/gathering.h"

namespace astrolith {
namespace {

// The most cells from which the impulses of a block may be drawn, over all Gabor layers or over all layers of
// spots. Every point of the block adds all these impulses.
constexpr double kMostCells = 32768.0;

double longest_side(const Box& box) {
  const Vec3d extent = box.extent();
  return std::max({extent.x, extent.y, extent.z});
}

// Visits the noise of layer after layer: adds up the cells that the impulses of a block are drawn from, in
// the boxes that gather_gabor() and gather_spots() take. The block lies where coordinates are large, and with
// them what is added for their rounding.
struct ImpulseCells {
  const FieldView& field;
  Box block;
  const FieldLayer* layer = nullptr;
  mutable double of_gabor = 0.0, of_spots = 0.0;

  template <class Noise>
  void operator()(const Noise& noise) const {
    constexpr NoiseLists kLists = Noise::kTraits.lists;
    if constexpr (kLists == NoiseLists::kGabor) {
      of_gabor += cells_of(noise, field.arrays, longest_side(projected_block(field, block)));
    } else if constexpr (kLists == NoiseLists::kSpots) {
      of_spots +=
          cells_of(noise, field.arrays, longest_side(displaced_layer_box(block, layer->join.displaced)));
    } else {
      static_assert(kLists == NoiseLists::kNone || kLists == NoiseLists::kCraters);
    }
  }
};

}  // namespace

std::string obstacle_on_gpu(const FieldView& field, double block_side) {
  if (field.num_kept_heights > kMostKeptHeights) return "masks by more than 16 layers at a time";
  const Vec3d& far = field.body.supports.max;
  ImpulseCells cells{field, {far - Vec3d{block_side, block_side, block_side}, far}};
  for (const FieldLayer& layer : std::span(field.layers, field.num_layers)) {
    cells.layer = &layer;
    field.noise(layer).visit(cells);
  }
  if (cells.of_spots > kMostCells) return "spots so much smaller than the mesh's cells";
  return cells.of_gabor > kMostCells ? "Gabor kernels so much smaller than the mesh's cells" : "";
}

}  // namespace astrolith
