// What a kind of layer is, as other code asks it. Each kind states its traits in its struct, as `kTraits`.
#pragma once

#include "numerics/stated.h"

namespace astrolith {

struct LayerTraits {
  // Whether the layer has heights that follow one rule everywhere, and a LayerUse that says how they act.
  // Other kinds have places of their own: landforms that are listed or drawn from a population.
  Stated<bool> is_noise;
  // Whether the layer is bound to the surface of the bare body. Noise on the surface cannot stand after a
  // warp.
  Stated<bool> on_surface;
  // Whether the layer lies on the surface that the layers below make. It then has a reach_below()
  // (synthesis/field/layer_maker.h).
  Stated<bool> on_layers;
  // Whether the layer names the file of an image, as a NamedImage.
  Stated<bool> has_image;
  // Whether the layer may have a `color`. It may then lack a height, and has a has_height().
  Stated<bool> has_color;
  // Whether the layer paints the surface of a body where its paints() says so.
  Stated<bool> paints_bodies;
  // Whether a plane can show the layer (tasks/synthesis/plane_texture.h).
  Stated<bool> in_plane;
  // Whether a variation of a recipe changes the fields of the layer (synthesis/finish/recipe_variation.h).
  // Other layers change with the seed alone.
  Stated<bool> varies;
};

// Noise in space that a variation leaves as it is: most kinds.
inline constexpr LayerTraits kNoiseInSpace{.is_noise = true,
                                           .on_surface = false,
                                           .on_layers = false,
                                           .has_image = false,
                                           .has_color = false,
                                           .paints_bodies = false,
                                           .in_plane = false,
                                           .varies = false};

// Landforms with places of their own on the bare body.
inline constexpr LayerTraits kLandforms{.is_noise = false,
                                        .on_surface = true,
                                        .on_layers = false,
                                        .has_image = false,
                                        .has_color = false,
                                        .paints_bodies = false,
                                        .in_plane = false,
                                        .varies = false};

}  // namespace astrolith
