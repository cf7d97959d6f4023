// What a kind of layer is, as other code asks it. Each kind states its traits in its struct, as `kTraits`.
#pragma once

#include "numerics/stated.h"

namespace astrolith {

// Reads, writes or checks the fields of a struct, of which each kind of layer has a list
// (recipe/fields_internal.h).
class FieldVisitor;

struct LayerTraits {
  // Whether the layer has heights that follow one rule everywhere, and a LayerUse that says how they act.
  // Other kinds have places of their own: landforms that are listed or drawn from a population.
  Stated<bool> is_noise;
  // Whether the layer is bound to the surface of the bare body. Noise on the surface cannot stand after a
  // warp.
  Stated<bool> on_surface;
  // Whether the layer lies on the surface that the layers below make. It then has a reach_below()
  // (synthesis/field/layer_noise.h).
  Stated<bool> on_layers;
  // Whether a plane can show the layer. It then has heights_on_plane() and colors_on_plane()
  // (synthesis/noise/plane_texture.h).
  Stated<bool> in_plane;
};

// What else a kind can do follows from the members of its struct:
//   NamedImage, its base   it names the file of an image
//   color, has_height()    it may have a colour, and may then lack a height
//   paints()               where it is true the layer paints bodies, by a make_exemplar_paint() in its room
//   varied()               a variation changes these fields; other layers change with the seed alone
//   stated_height()        the field that states its height, if that is neither amplitude nor height_rms

// What a variation of a recipe multiplies (synthesis/finish/recipe_variation.h).
struct VariedFields {
  double& height;
  double& frequency;
};

// Noise in space: most kinds.
inline constexpr LayerTraits kNoiseInSpace{
    .is_noise = true, .on_surface = false, .on_layers = false, .in_plane = false};

// Landforms with places of their own on the bare body.
inline constexpr LayerTraits kLandforms{
    .is_noise = false, .on_surface = true, .on_layers = false, .in_plane = false};

}  // namespace astrolith
