#include <algorithm>
#include <limits>
#include <span>

#include "synthesis/field/layer_stack_internal.h"

namespace astrolith {

// Whether float coordinates of the body's frame are too coarse for a noise in the field's patch.
bool PatchNoises::too_fine_for_body(const LayerNoise& noise) const {
  if (!stack_.model.patch || !stack_.model.body.plain()) return false;
  const NoiseDetail detail = noise_detail(noise);
  if (has_local_form(noise)) return detail.left_out > 0.0;
  return detail.left_out > 0.0 || largest_coordinate(joins_.domain()) > kMostPreciseCells * detail.finest;
}

double PatchNoises::height_bound(const LayerNoise& noise, const LayerMaker& maker) {
  const double in_body = noise_height_bound(noise);
  if (!too_fine_for_body(noise)) {
    stack_.report_left_out(stack_.index, noise_detail(noise));
    return in_body;
  }
  const std::size_t number = stack_.model.layers.size();
  const Vec3d& displaced = joins_.displaced();
  layers_.push_back({number, stack_.index, largest_coordinate(Box{displaced, displaced}), maker});
  ArrayStore discarded;
  const NoiseFrame whole(Box{{}, {}}, stack_.model.patch->center);
  return std::max(in_body, noise_height_bound(maker(stack_.site(whole, number), discarded)));
}

void PatchNoises::add_all() {
  if (layers_.empty()) return;
  make_patch_warp();
  const double warp = stack_.model.patch_warp ? stack_.model.patch_warp->bound : 0.0;
  for (const PatchLayer& layer : layers_) add(layer, warp);
}

void PatchNoises::add(const PatchLayer& layer, double warp) {
  FieldModel& model = stack_.model;
  const double reach = farthest_point(layer, warp);
  const NoiseFrame frame(widened(Box{{}, {}}, reach), model.patch->center);
  const LayerNoise noise = layer.maker(stack_.site(frame, layer.layer), model.arrays);
  stack_.report_left_out(layer.index, noise_detail(noise));
  model.layers[layer.layer].in_patch = static_cast<std::int32_t>(model.patch_noises.size());
  model.patch_noises.push_back(noise);
  model.has_patch_layers = true;
  model.patch_caches.emplace_back();
  if (noise_traits(noise).lists == NoiseLists::kGabor) {
    model.patch_caches.back().resize(num_impulse_lists(noise));
  }
}

// A bound of the coordinates at which a layer is evaluated, length units. Points of a block lie within two
// sides of the centre; noise on the surface is evaluated at their projections.
double PatchNoises::farthest_point(const PatchLayer& layer, double warp) const {
  const FieldModel& model = stack_.model;
  const bool on_surface = noise_traits(model.layers[layer.layer].noise).on_surface;
  return 2.0 * model.patch->side + (on_surface ? warp + model.height_bound : layer.displaced) +
         later_reach(layer.index);
}

// How far beyond the points of a patch the layers above one look at the surface that it makes.
double PatchNoises::later_reach(int index) const {
  double reach = 0.0;
  for (const Layer& layer : std::span(stack_.recipe.layers).subspan(static_cast<std::size_t>(index) + 1)) {
    if (has_height(layer) || paints(layer)) reach = std::max(reach, reach_below(layer));
  }
  return reach;
}

// The body's warp in the frame of the patch, with the octaves that it has in the body's frame.
void PatchNoises::make_patch_warp() {
  FieldModel& model = stack_.model;
  model.update();
  const BodyLeaf& first = model.tables.leaf(0);
  if (!first.warped) return;
  const Vec3d& center = model.patch->center;
  constexpr float kEverywhere = std::numeric_limits<float>::max();
  CoordinateWarp warp = first.warp;
  for (ArrayRange<NoiseOctave>& octaves : warp.octaves) {
    const std::span<const NoiseOctave> body_octaves = model.arrays.view().span(octaves);
    octaves = model.arrays.add(local_octaves(Noise::kSimplex, body_octaves, center));
  }
  warp.low = {-kEverywhere, -kEverywhere, -kEverywhere};
  warp.high = {kEverywhere, kEverywhere, kEverywhere};
  model.patch_warp = warp;
}

}  // namespace astrolith
