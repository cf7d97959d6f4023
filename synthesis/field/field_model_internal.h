// The model that an ImplicitField and its blocks share: the field's tables, and the search structures with
// which the CPU finds elements of the tables.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "numerics/box_tree.h"
#include "synthesis/body/layer_site.h"
#include "synthesis/field/field_tables.h"
#include "synthesis/field/implicit_field.h"
#include "synthesis/gabor/gabor_bricks.h"

namespace astrolith {

// The craters of a layer in the frame of a patch, for a layer that is drawn by cells.
struct PatchCraters {
  CraterRelief relief;
  BoxTree tree;
};

struct FieldModel {
  std::shared_ptr<SharedWork> shared = std::make_shared<SharedWork>();  // with other fields of the recipe
  // The storage of the tables (field_tables.h).
  ArrayStore arrays;
  BodyTables body;
  std::vector<FieldLayer> layers;  // in the recipe's order, without boulders
  std::vector<int> recipe_layers;  // the index in the recipe of each of these layers
  std::vector<ImpulseList> spot_lists, gabor_lists;
  std::vector<std::uint32_t> crater_layers;
  std::vector<FieldBoulder> boulders;  // boulders on the surface that the layers make
  double height_bound = 0.0;           // bound of the |elevation| that all layers make, length units
  std::uint32_t num_kept_heights = 0;
  FieldView tables{};  // a view of the members above, made by update()

  // Search structures of the CPU.
  ReachingMetaballs metaballs;                // all metaballs of the body
  std::vector<BoxTree> crater_trees;          // one tree for each list of craters
  BoxTree boulder_tree;                       // the boxes that boulders reach
  std::vector<GaborBrickCache> gabor_caches;  // one cache for each list of Gabor impulses

  // Landforms as they lie on the body, for ImplicitField::craters() and boulders().
  std::vector<LayerCraters> placed_craters;
  std::vector<LayerBoulders> placed_boulders;

  // For a field made for a patch: the patch, the noise of its fine layers in the frame of the patch, and
  // their impulses. The body's warp is there if any layer is. The bounds of layers hold in both frames.
  std::optional<PatchCube> patch;
  std::vector<LayerNoise> patch_noises;
  std::vector<std::vector<GaborBrickCache>> patch_caches;  // by noise and band
  std::optional<CoordinateWarp> patch_warp;
  // Landforms that are drawn by cells are small, so that their places need the digits of local coordinates.
  // Other landforms of a patch are evaluated in the body's frame.
  std::vector<std::optional<PatchCraters>> patch_craters;    // by the number of the list of craters
  std::vector<std::optional<BoulderKernel>> patch_boulders;  // by the number of the boulder
  bool has_patch_layers = false;                             // whether one of these is there
  // The tables for points relative to the centre of the patch, and their layers. add_patch_tables() makes
  // them.
  FieldView patch_tables{};
  std::vector<FieldLayer> patch_layers;

  std::vector<LayerLeftOut> left_out;

  Box bounds;  // holds the whole surface

  // Makes `tables` a view of the model as it is now. Adding to `arrays` or `layers` later makes the view
  // invalid, until update() is called again.
  void update();
  // Adds the lists to the arrays and updates `tables`. Expects to be called once, when the model is complete.
  void finish();
};

// Adds a recipe's layers to a model that holds its body. Throws InputError as ImplicitField does.
void add_layers(const Recipe& recipe, const std::string& name, FieldModel& model,
                const Progress& progress = {});

// Makes the tables of the patch from those of the body's frame. Expects a complete model for a patch.
void add_patch_tables(FieldModel& model);

// F at a point.
float value_at(const FieldModel& model, const Vec3d& p);

// The height of the model's layer number `number`, a layer of noise, at a point: as a mask reads it. The
// model may still lack the layers after it.
float layer_height_at(const FieldModel& model, std::size_t number, const Vec3d& p);

// F of the body with the first `layers` layers of the model and without boulders, at points in the
// coordinates of `frame`, for layers that are placed on these. If the body is plain, the points are displaced
// by its warp. The result is empty if none of the layers changes an elevation. It is valid until the model
// changes; `model.tables` must be up to date.
FieldBelow field_below(const FieldModel& model, std::size_t layers, const NoiseFrame& frame);

// The noise of a layer in the frame of the field's patch, if it has one there, else in the body's frame.
const LayerNoise& find_noise(const FieldModel& model, const FieldLayer& layer);

// The spots that reach a box. They are chosen from the spots of a larger box, or drawn where
// `larger_box_spots` is empty.
DrawnSpots spots_reaching(const FieldModel& model, const Box& box, const DrawnSpots& larger_box_spots);

// The spots of layer number `layer`; null where none were drawn.
inline const SpotImpulses* find_spots(const DrawnSpots& spots, std::size_t layer) {
  return spots.empty() ? nullptr : spots[layer].get();
}

// Whether F keeps one sign over the box; `metaballs` and `spots` must hold all that reach the box.
BlockContent block_content(const FieldModel& model, const ReachingMetaballs& metaballs,
                           const DrawnSpots& spots, const Box& box);

// Bounds of the elevations that the layers make over a box, of whose points the projections lie in another
// one, for a plain body without a warp. `spots` must hold all that reach the box.
Interval elevations_over(const FieldModel& model, const DrawnSpots& spots, const Box& box,
                         const Box& projected);

// The bound that all heights of a body must stay below, in length units. Where no metaball reaches, s is a
// large negative number, but a finite one. Heights above its magnitude would fill all space with matter. The
// limit is 0 or less where the body's own operations fill all space. It depends on the body alone.
double height_limit(const FieldModel& model);

// A box that holds the whole surface, within about 1/64 of its longest side. Uses all of the model but
// `bounds`.
Box surface_bounds(const FieldModel& model);

}  // namespace astrolith
