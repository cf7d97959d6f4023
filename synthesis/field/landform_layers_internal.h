// Adds a recipe's craters and boulders to its field model.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "numerics/progress.h"
#include "synthesis/field/bare_body.h"
#include "synthesis/field/stack_state_internal.h"
#include "synthesis/landforms/population_cells.h"

namespace astrolith {

class LandformLayers {
 public:
  explicit LandformLayers(StackState& stack) : stack_(stack) {}

  // Adds the layer that the stack adds. Craters lie on the layers so far. Boulders wait for add_boulders().
  void add(const CraterLayer& layer);
  void add(const BoulderLayer& layer) { boulder_layers_.push_back({&layer, stack_.index}); }

  // Adds the boulders on the surface that all layers make.
  void add_boulders(const Progress& progress);

 private:
  struct BoulderLayerAt {
    const BoulderLayer* layer;
    int index;  // place in the recipe
  };

  void add_patch_craters(const CraterLayer& layer, const CraterRelief& relief,
                         std::span<const Vec3d> centers);
  void add_patch_boulders(const BoulderLayer& layer, std::vector<PlacedBoulder> boulders);
  DrawingPlaces crater_places(const CraterLayer& layer);
  DrawingPlaces boulder_places(const BoulderLayer& layer, const Progress& progress);
  Box patch_box() const;
  double widest_boulder() const;
  double height_reach();
  PlaceWeight weight_of(const Population& drawn);
  void report_sizes_left_out(const Population& drawn);
  const BareSurface& bare();
  std::vector<Vec3d> unwarped(std::vector<Vec3d> points) const;

  StackState& stack_;
  std::vector<BoulderLayerAt> boulder_layers_;
  std::optional<BareSurface> bare_;  // made for the first layer that needs it
};

}  // namespace astrolith
