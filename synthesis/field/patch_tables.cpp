// The tables of a field for a patch, for points relative to the centre of the patch.
#include <optional>

#include "synthesis/field/field_model_internal.h"
#include "synthesis/field/layer_noise.h"

namespace astrolith {
namespace {

// Visits the noise of a layer that is not too fine for the body's frame: makes its form in the frame of the
// patch, if it has one.
struct FormInPatch {
  FieldModel& model;

  template <class Noise>
  std::optional<LayerNoise> operator()(const Noise& noise) const {
    if constexpr (Noise::kTraits.local_form) {
      if (noise.has_local_form()) return LayerNoise(local_form(noise, model.patch->center, model.arrays));
    } else if constexpr (Noise::kTraits.lists == NoiseLists::kCraters) {
      const std::optional<PatchCraters>& craters = model.patch_craters[noise.list];
      if (craters) return LayerNoise(craters->relief);
    }
    return {};
  }
};

// Gives the layers of the patch their noises. A fine noise has other lists of impulses than the layer has in
// the body's frame, which lacks its finest kinds or bands.
void complete_patch_layers(FieldModel& model) {
  std::vector<LayerNoise> noises = model.patch_noises;
  std::vector<ImpulseList> spot_lists, gabor_lists;
  model.patch_layers = model.layers;
  for (std::uint32_t i = 0; i < model.patch_layers.size(); ++i) {
    FieldLayer& layer = model.patch_layers[i];
    if (layer.in_patch < 0) {
      if (const std::optional<LayerNoise> form = layer.noise.visit(FormInPatch{model})) {
        layer.in_patch = static_cast<std::int32_t>(noises.size());
        noises.push_back(*form);
      }
    }
    const LayerNoise& noise =
        layer.in_patch < 0 ? layer.noise : noises[static_cast<std::size_t>(layer.in_patch)];
    std::vector<ImpulseList>& lists =
        noise_traits(noise).lists == NoiseLists::kSpots ? spot_lists : gabor_lists;
    layer.first_list = static_cast<std::uint32_t>(lists.size());
    for (std::uint32_t e = 0; e < num_impulse_lists(noise); ++e) lists.push_back({i, e});
  }
  model.tables.patch.noises = model.arrays.add(noises);
  model.patch_tables.spot_lists = model.arrays.add(spot_lists);
  model.patch_tables.gabor_lists = model.arrays.add(gabor_lists);
}

std::vector<FieldBoulder> patch_boulders(const FieldModel& model) {
  std::vector<FieldBoulder> boulders = model.boulders;
  for (std::size_t i = 0; i < model.patch_boulders.size(); ++i) {
    if (!model.patch_boulders[i]) continue;
    boulders[i].kernel = *model.patch_boulders[i];
    boulders[i].in_patch = true;
  }
  return boulders;
}

}  // namespace

void add_patch_tables(FieldModel& model) {
  complete_patch_layers(model);
  if (model.patch_warp) model.tables.patch.warp = model.arrays.add(std::vector{*model.patch_warp});
  const ArrayRange<FieldBoulder> boulders = model.arrays.add(patch_boulders(model));
  const ArrayRange<ImpulseList> spot_lists = model.patch_tables.spot_lists,
                                gabor_lists = model.patch_tables.gabor_lists;
  model.update();
  model.patch_tables = model.tables;
  model.patch_tables.layers = model.patch_layers.data();
  model.patch_tables.boulders = boulders;
  model.patch_tables.spot_lists = spot_lists;
  model.patch_tables.gabor_lists = gabor_lists;
}

}  // namespace astrolith
