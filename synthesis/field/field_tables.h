// The model of a recipe's field: its body and its layers as plain tables, built once from the recipe and read
// by CPU and GPU alike. field_at_point.h evaluates them at a point, field_content.h says what is certain over
// a box, and gathering.h which of their elements reach a box. ImplicitField evaluates many points at once.
#pragma once

#include <cstdint>

#include "numerics/arrays.h"
#include "numerics/plain_variant.h"
#include "synthesis/body/body_tables.h"
#include "synthesis/field/layer_join.h"
#include "synthesis/gabor/gabor_surface_noise.h"
#include "synthesis/landforms/boulder_field.h"
#include "synthesis/landforms/crater_relief.h"
#include "synthesis/noise/fractal_noise.h"
#include "synthesis/noise/phasor_noise.h"
#include "synthesis/noise/random_phase_noise.h"
#include "synthesis/noise/sparse_noise.h"
#include "synthesis/spots/spot_noise.h"

namespace astrolith {

// The table of kinds: every type that a layer of heights can be. A noise in space has make_noise, height_at,
// evaluate_heights and bound_heights in its own room, and needs nothing else.
using LayerNoise = PlainVariant<FractalNoise, SparseNoise, SpotNoise, PhasorNoise, RandomPhaseNoise,
                                CraterRelief, GaborSurfaceNoise>;

// A layer, and how it joins those before it; craters join by themselves.
struct FieldLayer {
  LayerNoise noise;
  LayerJoin join;
  std::uint32_t first_list = 0;  // of the layer's lists of impulses in a block, for spots and Gabor noise
};

// A list of impulses in every block: those of one kind of spots, or of one band of Gabor noise.
struct ImpulseList {
  std::uint32_t layer, element;
};

struct FieldView {
  ArrayView arrays;
  const FieldLayer* layers;
  std::uint32_t num_layers;
  std::uint32_t num_kept_heights;  // slots for heights that masks ask for
  BodyTables body;
  ArrayRange<ImpulseList> spot_lists, gabor_lists;
  ArrayRange<std::uint32_t> crater_layers;  // by list of craters: the number of the layer
  ArrayRange<FieldBoulder> boulders;        // on the surface that the layers make
  double height_bound;                      // of the |elevation| that all layers make, length units
  float height_reach;                       // no elevation exceeds it; more than height_bound by rounding

  // Lists of craters and, last, of boulders that reach a block.
  ASTROLITH_HD std::uint32_t num_landform_lists() const { return crater_layers.count + 1; }
  ASTROLITH_HD std::uint32_t boulder_list() const { return crater_layers.count; }
  ASTROLITH_HD const BodyLeaf& leaf(std::uint32_t number) const { return arrays[body.leaves][number]; }
  ASTROLITH_HD const CraterRelief& craters(std::uint32_t list) const {
    return *layers[arrays[crater_layers][list]].noise.get_if<CraterRelief>();
  }
};

// The elements of the field that reach a block. List l of each array goes from first[l] to first[l + 1] - 1.
struct BlockLists {
  LeafLists metaballs;  // by leaf
  const SpotImpulse* spots;
  const std::uint32_t* first_spot;  // by list of spots
  const GaborImpulse* gabor;
  const std::uint32_t* first_gabor;     // by list of Gabor impulses
  const std::uint32_t* landforms;       // numbers of craters and boulders
  const std::uint32_t* first_landform;  // by list of landforms
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
  const std::uint32_t* first_landform;  // (blocks * landform lists + 1)
  std::uint32_t leaves, spot_lists, gabor_lists, landform_lists;

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
