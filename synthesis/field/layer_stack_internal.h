// A recipe's layers while they are added to a field model, one after another: what all parts of the work see,
// how layers of noise join those before them, the noises in the frame of a patch, and craters and boulders.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "numerics/progress.h"
#include "synthesis/field/bare_body.h"
#include "synthesis/field/field_model_internal.h"
#include "synthesis/field/layer_noise.h"
#include "synthesis/field/mask_plan.h"
#include "synthesis/landforms/population_cells.h"

namespace astrolith {

struct StackState {
  const Recipe& recipe;
  const std::string& name;  // name of the recipe, for errors
  FieldModel& model;
  MaskPlan masks;
  Box supports;                             // of the body's kernels; no surface lies outside
  int index = 0;                            // index in the recipe of the layer that is added
  std::map<int, std::size_t> numbers = {};  // number in the model of each layer with heights, by its index

  StackState(const Recipe& given_recipe, const std::string& recipe_name, FieldModel& given_model);

  const Layer& layer() const { return recipe.layers[static_cast<std::size_t>(index)]; }
  int masking() const { return masks.masking[static_cast<std::size_t>(index)]; }
  std::string place() const { return layer_path(index); }
  std::string layer_path(int layer) const { return name + ": layers[" + std::to_string(layer) + "]"; }

  // A layer's site in a frame, with the first `below` layers of the model below it. It is valid until the
  // model changes.
  LayerSite site(const NoiseFrame& frame, std::size_t below) const;

  // Finds for each layer by how much it and all layers after it may change an elevation, and updates the
  // model's tables.
  void update_model();

  void report_left_out(int layer, const NoiseDetail& detail);
};

// How each layer of noise joins the layers before it: masks, localities, warps and bounds of elevations.
class StackJoins {
 public:
  explicit StackJoins(StackState& stack);

  // Where the next layer of noise in space is evaluated: the body's supports, widened by the warps of the
  // body and of the layers so far.
  const Box& domain() const { return domain_; }
  // A bound of the displacement of the next layer along each axis, length units.
  const Vec3d& displaced() const { return displaced_; }

  // The join of the layer that the stack adds, whose |height| is at most `height`, length units. Updates the
  // model's bound of elevations, and the domain if the layer warps. `has_height` is false for a layer that
  // only paints. Throws InputError where the layer's mask or locality has no meaning.
  LayerJoin join(const LayerUse& use, double height, bool has_height);

 private:
  void set_mask(const LayerMask& mask, LayerJoin& join) const;
  void keep_heights(LayerJoin& join);
  void bound_change(LayerJoin& join);
  void displace_later(const Vec3d& direction, double height);

  StackState& stack_;
  Box domain_;
  Vec3d displaced_;
  MaskSlots mask_slots_;
  std::map<int, int> slots_;  // slot of the kept heights of each masking layer
};

// Sets the heights over which a mask rises from 0 to 1.
void set_mask_range(const LayerMask& mask, LayerJoin& join);

// Refuses a mask by a layer that only paints; `place` names the layer or the population with the mask.
[[noreturn]] void fail_without_height(const LayerMask& mask, const std::string& place);

// The noises that a field for a patch has in the frame of the patch: those too fine for float coordinates of
// the body's frame.
class PatchNoises {
 public:
  PatchNoises(StackState& stack, const StackJoins& joins) : stack_(stack), joins_(joins) {}

  // A bound of the |height| of the layer that the stack adds, in both frames, length units. Takes the layer
  // for the patch where `noise`, that of the body's frame, is too coarse there.
  double height_bound(const LayerNoise& noise, const LayerMaker& maker);

  // Makes the noises of the layers that were taken. All heights must be known.
  void add_all();

 private:
  struct PatchLayer {
    std::size_t layer;  // number in the model
    int index;          // index in the recipe
    double displaced;   // bound of the displacement of its coordinates, length units
    LayerMaker maker;
  };

  bool too_fine_for_body(const LayerNoise& noise) const;
  double farthest_point(const PatchLayer& layer, double warp) const;
  double later_reach(int index) const;
  void add(const PatchLayer& layer, double warp);
  void make_patch_warp();

  StackState& stack_;
  const StackJoins& joins_;
  std::vector<PatchLayer> layers_;
};

// Adds craters and boulders.
class StackLandforms {
 public:
  explicit StackLandforms(StackState& stack) : stack_(stack) {}

  // Adds the layer that the stack adds. Craters lie on the layers so far. Boulders wait for add_boulders().
  void add(const CraterLayer& layer);
  void add(const BoulderLayer& layer) { boulder_layers_.push_back({&layer, stack_.index}); }

  // Adds the boulders on the surface that all layers make.
  void add_boulders(const Progress& progress);

 private:
  struct BoulderLayerAt {
    const BoulderLayer* layer;
    int index;  // index in the recipe
  };

  void add_patch_craters(const CraterLayer& layer, const CraterRelief& relief,
                         std::span<const Vec3d> centers);
  void add_patch_boulders(const BoulderLayer& layer, std::vector<PlacedBoulder> boulders);
  DrawingPlaces crater_places(const CraterLayer& layer);
  DrawingPlaces boulder_places(const BoulderLayer& layer, const Progress& progress);
  Box patch_box() const;
  double widest_boulder() const;
  double height_reach();
  PlaceWeight place_weight(const Population& drawn);
  PlaceWeight place_mask(const Population& drawn, const std::string& place);
  void report_sizes_left_out(const Population& drawn);
  const BareSurface& bare();
  std::vector<Vec3d> unwarped(std::vector<Vec3d> points) const;

  StackState& stack_;
  std::vector<BoulderLayerAt> boulder_layers_;
  std::optional<BareSurface> bare_;  // made for the first layer that needs it
};

}  // namespace astrolith
