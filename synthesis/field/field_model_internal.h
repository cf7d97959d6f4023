// What an ImplicitField and its blocks share: the field's tables, and what finds their elements fast on a
// CPU.
#pragma once

#include <string>
#include <vector>

#include "numerics/box_tree.h"
#include "synthesis/field/field_tables.h"
#include "synthesis/field/implicit_field.h"
#include "synthesis/gabor/gabor_tiles.h"

namespace astrolith {

struct FieldModel {
  // The tables (field_tables.h).
  ArrayStore arrays;
  BodyTables body;
  std::vector<FieldLayer> layers;  // in the recipe's order; boulders are none of them
  std::vector<ImpulseList> spot_lists, gabor_lists;
  std::vector<std::uint32_t> crater_layers;
  std::vector<FieldBoulder> boulders;  // on the surface that the layers make
  double height_bound = 0.0;           // of the |elevation| that all layers make
  std::uint32_t num_kept_heights = 0;
  FieldView tables{};  // a view of all of these, once finish() was called

  // What the CPU finds elements with.
  ReachingMetaballs metaballs;               // all of the body's
  std::vector<BoxTree> crater_trees;         // by list of craters
  BoxTree boulder_tree;                      // of what boulders reach
  std::vector<GaborTileCache> gabor_caches;  // by list of Gabor impulses

  // Landforms as they lie on the body, for lists of them.
  std::vector<LayerCraters> placed_craters;
  std::vector<LayerBoulders> placed_boulders;

  Box bounds;  // of the surface

  // Makes `tables` a view of the layers as they are now. Adding to the model makes it invalid.
  void finish();
};

// Adds a recipe's layers to a model that holds its body. Throws InputError as ImplicitField.
void add_layers(const Recipe& recipe, const std::string& name, FieldModel& model);

// F at a point.
float value_at(const FieldModel& model, const Vec3d& p);

// The spots that reach a box, from those of a larger one or, where that has none, drawn.
DrawnSpots spots_reaching(const FieldModel& model, const Box& box, const DrawnSpots& of_larger);

// The spots of one layer; null where none were drawn.
inline const SpotImpulses* spots_of(const DrawnSpots& spots, std::size_t layer) {
  return spots.empty() ? nullptr : spots[layer].get();
}

// Whether F keeps one sign over the box; `metaballs` and `spots` must hold what reaches the box.
BlockContent content_of(const FieldModel& model, const ReachingMetaballs& metaballs, const DrawnSpots& spots,
                        const Box& box);

// A box that holds the whole surface, within about 1/64 of its longest side. Uses all of the model but
// `bounds`.
Box surface_bounds(const FieldModel& model);

}  // namespace astrolith
