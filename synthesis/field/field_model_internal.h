// What an ImplicitField and its blocks share.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "synthesis/body/combined_body.h"
#include "synthesis/field/content_bounds.h"
#include "synthesis/field/implicit_field.h"
#include "synthesis/field/layer_join.h"
#include "synthesis/gabor/gabor_surface_noise.h"
#include "synthesis/landforms/boulder_field.h"
#include "synthesis/landforms/crater_relief.h"
#include "synthesis/mesh/block_field.h"
#include "synthesis/noise/coordinate_warp.h"
#include "synthesis/noise/fractal_noise.h"
#include "synthesis/noise/phasor_noise.h"
#include "synthesis/noise/random_phase_noise.h"
#include "synthesis/noise/sparse_noise.h"
#include "synthesis/spots/spot_noise.h"

namespace astrolith {

using HeightLayer = std::variant<FractalNoise, GaborSurfaceNoise, SpotNoise, SparseNoise, CraterRelief,
                                 RandomPhaseNoise, PhasorNoise>;

// A layer, and how it joins those before it; craters join by themselves.
struct PlacedLayer {
  HeightLayer noise;
  LayerJoin join;
};

// Where a layer is evaluated for the float points of a box.
inline Box layer_box(const PlacedLayer& layer, const Box& box) {
  return displaced_layer_box(box, layer.join.displaced);
}

struct FieldModel {
  PreparedBody body;
  std::optional<CoordinateWarp> warp;  // of the coordinates of a body without operations
  float lipschitz_bound = 1.0f;        // of a body with operations
  std::vector<PlacedLayer> layers;     // in the recipe's order
  double height_bound = 0.0;           // of the |elevation| that all layers make
  int kept_heights = 0;                // slots for heights that masks ask for
  std::vector<LayerCraters> craters;   // that the layers hold
  BoulderField boulders;               // on the surface that the layers make
  std::vector<LayerBoulders> placed_boulders;
  Box bounds;  // of the surface
};

// Adds the recipe's layers to a model that holds its body. Throws InputError as ImplicitField.
void add_layers(const Recipe& recipe, const std::string& name, FieldModel& model);

// F at a point.
float value_at(const FieldModel& model, const Vec3d& p);

// Where the body is evaluated for the points of a box.
Box body_box(const FieldModel& model, const Box& box);

// The spots that reach a box, from those of a larger one or, where that has none, drawn.
DrawnSpots spots_reaching(const FieldModel& model, const Box& box, const DrawnSpots& of_larger);

// Those of one layer; null where none were drawn.
inline const SpotImpulses* spots_of(const DrawnSpots& spots, std::size_t layer) {
  return spots.empty() ? nullptr : spots[layer].get();
}

// The most by which the layers may change F, and the layers from number `first` on; craters replace what is
// there. Points beyond keep their F.
float height_reach(const FieldModel& model);
float change_bound(const FieldModel& model, std::size_t first);

// Whether F keeps one sign over the box; `body` must hold what reaches body_box(model, box), `spots` what
// reaches the box.
BlockContent content_of(const FieldModel& model, const PreparedBody& body, const DrawnSpots& spots,
                        const Box& box);

// A box that holds the whole surface, within about 1/64 of its longest side. Uses all of the model but
// `bounds`.
Box surface_bounds(const FieldModel& model);

}  // namespace astrolith
