// The model of a recipe's field: its body and its layers as plain tables. The tables are built once from the
// recipe, and CPU and GPU read them alike. field_at_point.h evaluates the field at a point. field_content.h
// bounds it over a box. gathering.h tells which elements of the tables reach a box. ImplicitField evaluates
// many points at once.
#pragma once

#include <cstdint>

#include "numerics/arrays.h"
#include "numerics/plain_variant.h"
#include "synthesis/body/body_tables.h"
#include "synthesis/exemplar/exemplar_noise.h"
#include "synthesis/field/layer_join.h"
#include "synthesis/gabor/gabor_surface_noise.h"
#include "synthesis/landforms/boulder_field.h"
#include "synthesis/landforms/crater_relief.h"
#include "synthesis/noise/fractal_noise.h"
#include "synthesis/noise/phasor_noise.h"
#include "synthesis/noise/random_phase_noise.h"
#include "synthesis/noise/sparse_noise.h"
#include "synthesis/relief/relief_bounds.h"
#include "synthesis/relief/relief_noise.h"
#include "synthesis/spots/spot_noise.h"

namespace astrolith {

// The table of kinds: every type that a layer of heights can have. A new kind needs an entry here, traits, a
// height_at, an evaluate_heights and a bound_heights. docs/architecture.md lists what else it needs.
using LayerNoise = PlainVariant<FractalNoise, SparseNoise, SpotNoise, PhasorNoise, RandomPhaseNoise,
                                CraterRelief, GaborSurfaceNoise, ExemplarNoise, ReliefNoise>;

// Visits a layer's noise: its traits.
struct FindTraits {
  template <class Noise>
  constexpr NoiseTraits operator()(const Noise&) const {
    return Noise::kTraits;
  }
};
inline NoiseTraits noise_traits(const LayerNoise& noise) { return noise.visit(FindTraits{}); }

// A layer and how it joins the layers before it. Craters change the elevation by their own rule, so that only
// the bounds in their `join` are read.
struct FieldLayer {
  LayerNoise noise;
  LayerJoin join;
  std::uint32_t first_list = 0;  // number of the layer's first list of impulses, for spots and Gabor noise
  std::int32_t in_patch = -1;    // its noise in PatchTables; -1: it has none in these tables
};

// Every block has one list of impulses for each kind of spots, and one for each band of Gabor noise.
struct ImpulseList {
  std::uint32_t layer;    // number of the layer
  std::uint32_t element;  // number of the kind of spots or of the band within the layer
};

// What a field for a patch has in the frame of the patch: in coordinates relative to the patch's centre,
// along the body's axes.
struct PatchTables {
  Vec3d origin;                     // the centre of the patch
  ArrayRange<LayerNoise> noises;    // the noise that replaces a layer's there, by FieldLayer::in_patch
  ArrayRange<CoordinateWarp> warp;  // the warp of a plain body, if any noise is fine; else there is none
};

// A view of a field's tables. Ranges point into `arrays`. A field for a patch has two views, of one set of
// arrays: its tables for points of the body's frame, and those for points relative to the patch's centre
// (ImplicitField::patch_tables()). Boxes are the body's in both.
struct FieldView {
  ArrayView arrays;
  const FieldLayer* layers;
  std::uint32_t num_layers;
  std::uint32_t num_kept_heights;  // number of slots for heights that are kept for masks
  BodyTables body;
  ArrayRange<ImpulseList> spot_lists, gabor_lists;
  ArrayRange<std::uint32_t> crater_layers;  // number of the layer of each list of craters
  ArrayRange<FieldBoulder> boulders;        // boulders on the surface that the layers make
  double height_bound;                      // bound of the |elevation| that all layers make, length units
  float height_reach;                       // height_bound with a margin for rounding, length units
  float longest_step;                       // height_bound as a float: how far points are projected
  float steepest;                           // the body's lipschitz_bound as a float
  bool reads_projections;  // whether bounds of a layer depend on the box of the points' projections
  PatchTables patch;       // empty where the field was made for no patch

  // Every block has one list of craters for each layer of craters, and after these one list of boulders.
  ASTROLITH_HD std::uint32_t num_landform_lists() const { return crater_layers.count + 1; }
  ASTROLITH_HD std::uint32_t boulder_list() const { return crater_layers.count; }
  ASTROLITH_HD const BodyLeaf& leaf(std::uint32_t number) const { return arrays[body.leaves][number]; }
  // The noise of a layer, in the frame of the patch where it has one there.
  ASTROLITH_HD const LayerNoise& noise(const FieldLayer& layer) const {
    return layer.in_patch < 0 ? layer.noise : arrays[patch.noises][layer.in_patch];
  }
  // A box of the body's frame in the frame of noise(layer).
  ASTROLITH_HD Box in_layer_frame(const FieldLayer& layer, const Box& box) const {
    return layer.in_patch < 0 ? box : Box{box.min - patch.origin, box.max - patch.origin};
  }
  ASTROLITH_HD const FieldLayer& crater_layer(std::uint32_t list) const {
    return layers[arrays[crater_layers][list]];
  }
  ASTROLITH_HD const CraterRelief& craters(std::uint32_t list) const {
    return *noise(crater_layer(list)).get_if<CraterRelief>();
  }
};

// The lists of the elements that reach one block. List l of each array goes from first[l] to first[l + 1]
// - 1.
struct BlockLists {
  LeafLists metaballs;  // one list for each leaf of the body
  const SpotImpulse* spots;
  const std::uint32_t* first_spot;  // (spot lists + 1)
  const GaborImpulse* gabor;
  const std::uint32_t* first_gabor;     // (Gabor lists + 1)
  const std::uint32_t* landforms;       // numbers of craters within their layer, and of boulders
  const std::uint32_t* first_landform;  // (landform lists + 1)
};

// The lists of many blocks, stored one after another.
struct BlockListArrays {
  const MetaballSphere<float>* metaballs;
  const std::uint32_t* first_metaball;  // (blocks * leaves + 1)
  const SpotImpulse* spots;
  const std::uint32_t* first_spot;  // (blocks * spot lists + 1)
  const GaborImpulse* gabor;
  const std::uint32_t* first_gabor;  // (blocks * Gabor lists + 1)
  const std::uint32_t* landforms;
  const std::uint32_t* first_landform;                            // (blocks * landform lists + 1)
  std::uint32_t leaves, spot_lists, gabor_lists, landform_lists;  // lists of one block

  ASTROLITH_HD BlockLists block(std::size_t i) const {
    return {{metaballs, first_metaball + i * leaves},
            spots,
            first_spot + i * spot_lists,
            gabor,
            first_gabor + i * gabor_lists,
            landforms,
            first_landform + i * landform_lists};
  }
};

}  // namespace astrolith
