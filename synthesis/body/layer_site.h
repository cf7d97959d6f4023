// For whom and where the noise of a layer is made. Every kind of noise is made from these two.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "recipe/recipe.h"
#include "synthesis/body/body_ground.h"
#include "synthesis/noise/noise_frame.h"

namespace astrolith {

// What fields of one recipe need not find twice, by the place of the layer that it belongs to, or "body":
// what it is the layer's own room knows.
using SharedWork = std::map<std::string, std::shared_ptr<void>>;

// A layer's origin in its recipe.
struct LayerSource {
  const Recipe& recipe;          // it has a body
  int number;                    // layer_number(), recipe/noise_layers.h
  std::string place;             // "recipe: layers[2]", for messages
  SharedWork* shared = nullptr;  // of the field that is made; none for a layer without a field
};

// Writes F of the body with the layers below (implicit_field.h) at n points in the coordinates of a frame,
// length units. At a point of the bare surface, F is the elevation of these layers. Many threads may call it
// at once.
using FieldBelow = std::function<void(int n, const float* x, const float* y, const float* z, float* field)>;

// A frame for the noise, and what lies below the layer there. Noise in space reads the frame alone.
struct LayerSite {
  const NoiseFrame& frame;  // its domain holds the surface, or for noise in space the displaced points
  const BodyTables& body;
  const ArrayStore& body_arrays;
  LeafLists metaballs;        // all metaballs of the body
  double body_side;           // longest side of the box that holds the body, length units
  FieldBelow below;           // empty where no layer below makes an elevation
  double height_bound = 0.0;  // bound of the |elevation| of the layers below, length units
  // A box around the bare surface in the body's frame. Domains reach beyond it as far as metaballs do.
  std::function<Box()> surface;

  // The body. It is valid until the body's arrays grow.
  BodyGround ground() const {
    return {body, body_arrays.view(), metaballs, frame.moved ? &frame.origin : nullptr};
  }
};

}  // namespace astrolith
