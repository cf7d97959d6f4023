// The noises that a field for a patch has in the frame of the patch: those too fine for float coordinates of
// the body's frame.
#pragma once

#include <vector>

#include "synthesis/field/layer_joins_internal.h"
#include "synthesis/field/layer_maker.h"

namespace astrolith {

class PatchNoises {
 public:
  PatchNoises(StackState& stack, const LayerJoins& joins) : stack_(stack), joins_(joins) {}

  // A bound of the |height| of the layer that the stack adds, in both frames, length units. Takes the layer
  // for the patch where `noise`, that of the body's frame, is too coarse there.
  double height_bound(const LayerNoise& noise, const LayerMaker& maker);

  // Makes the noises of the layers that were taken. All heights must be known.
  void add_all();

 private:
  struct PatchLayer {
    std::size_t layer;  // number in the model
    int index;          // place in the recipe
    double displaced;   // bound of the displacement of its coordinates, length units
    LayerMaker maker;
  };

  bool too_fine_for_body(const LayerNoise& noise) const;
  double farthest_point(const PatchLayer& layer, double warp) const;
  double reach_of_later_layers(int index) const;
  void add(const PatchLayer& layer, double warp);
  void make_patch_warp();

  StackState& stack_;
  const LayerJoins& joins_;
  std::vector<PatchLayer> layers_;
};

}  // namespace astrolith
