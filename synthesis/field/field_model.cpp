#include <algorithm>

#include "synthesis/field/field_model_internal.h"

namespace astrolith {

void FieldModel::finish() {
  tables.spot_lists = arrays.add(spot_lists);
  tables.gabor_lists = arrays.add(gabor_lists);
  tables.crater_layers = arrays.add(crater_layers);
  tables.boulders = arrays.add(boulders);
  update();
}

void FieldModel::update() {
  tables.arrays = arrays.view();
  tables.layers = layers.data();
  tables.num_layers = static_cast<std::uint32_t>(layers.size());
  tables.num_kept_heights = num_kept_heights;
  tables.body = body;
  tables.height_bound = height_bound;
  tables.height_reach = static_cast<float>(height_bound * (1.0 + 1e-5));
  tables.longest_step = static_cast<float>(height_bound);
  tables.steepest = static_cast<float>(body.lipschitz_bound);
  tables.reads_projections = std::any_of(layers.begin(), layers.end(), [](const FieldLayer& layer) {
    const NoiseTraits traits = traits_of(layer.noise);
    return traits.on_surface && traits.bounded_by_box;
  });
  tables.patch_noises = patch_noises.data();
  if (patch) tables.patch_origin = patch->center;
}

}  // namespace astrolith
