// The field of a recipe: the body's signed distance plus the heights of its layers.
//
//   ImplicitField field(read_recipe("bennu.json"));
//   double f = field.value({0.1, 0.0, 0.25});           // positive inside, recipe's length units
//   Vec3d inward = field.gradient({0.1, 0.0, 0.25});
//   bool rock = field.inside({0.1, 0.0, 0.25});
//
// F(p) = s(p) + elevation (synthesis/body/metaballs.h), and the surface is F = 0. Layers add their heights to
// the elevation, or change what is there as craters do. A positive one lies along the outward normal and
// enlarges the body. Boulders join the result as a union. Near the surface F is a distance to first order.
// Where the body has a warp, s is subtracted at p + warp(p), and F is steeper or flatter than a distance.
//
// Every value is computed in float from float coordinates by the functions that blocks and GPUs run, so a
// single point, a block of any size and any thread count give the same bits.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "recipe/recipe.h"
#include "synthesis/body/combined_body.h"
#include "synthesis/gabor/gabor_kernel.h"
#include "synthesis/mesh/block_field.h"
#include "synthesis/spots/spot_noise.h"

namespace astrolith {

struct FieldModel;     // what the field and its blocks share
struct LayerCraters;   // synthesis/landforms/crater_relief.h
struct LayerBoulders;  // synthesis/landforms/boulder_field.h

// What of each layer of spots reaches a box, by layer; null where nothing was drawn. Empty without such
// layers.
using DrawnSpots = std::vector<std::shared_ptr<const SpotImpulses>>;

// What of a field's layers reaches a box, as lists.
struct BlockLists {
  std::vector<std::vector<SpotImpulse>> spots;        // by layer of spots, then size
  std::vector<std::vector<GaborImpulse>> gabor;       // by Gabor layer, then band
  std::vector<std::vector<std::uint32_t>> landforms;  // numbers of craters, by layer of such; of boulders
};

// The part of a field that reaches a box. Lives no longer than its field. All members may be called from
// many threads.
class FieldBlock {
 public:
  // kOutside: F < 0 at every float point of the box; kInside: F > 0.
  BlockContent content() const;

  // For a box within this one. Cheaper than gathering from the field, and the same block.
  FieldBlock restricted_to(const Box& child) const;

  // value[i] = F(x[i], y[i], z[i]) for points within the box; four spans of one size. Layers are added in
  // their order until those to come cannot bring F into the band (length units): there value[i] lacks them.
  void evaluate(std::span<const float> x, std::span<const float> y, std::span<const float> z,
                std::span<float> value, float band = kExactEverywhere) const;

  // The same everywhere at the corners of small tetrahedra, four after four, whose differences give the slope
  // of F: what is dear is evaluated once for all four, to first order about their centre.
  void evaluate_tetrahedra(std::span<const float> x, std::span<const float> y, std::span<const float> z,
                           std::span<float> value) const;

  // The first at the points origin + (x, y, z), which are within the box but for the rounding of its
  // coordinates to float. A body that has_near_form() and fractal layers are evaluated to the digits of x, y
  // and z, other bodies and layers to those of float coordinates in the body's frame.
  void evaluate_near(const Vec3d& origin, std::span<const float> x, std::span<const float> y,
                     std::span<const float> z, std::span<float> value, float band) const;
  void evaluate_tetrahedra_near(const Vec3d& origin, std::span<const float> x, std::span<const float> y,
                                std::span<const float> z, std::span<float> value) const;

  const Box& box() const { return box_; }
  const PreparedBody& body() const { return body_; }
  BlockLists lists() const;

 private:
  friend class ImplicitField;
  FieldBlock(const FieldModel& model, PreparedBody body, DrawnSpots spots, const Box& box)
      : model_(&model), body_(std::move(body)), spots_(std::move(spots)), box_(box) {}

  const FieldModel* model_;
  PreparedBody body_;
  DrawnSpots spots_;
  Box box_;
};

class ImplicitField {
 public:
  // Expects a recipe that validation accepts. Throws InputError when it has no body, and for craters that
  // find no place on it.
  explicit ImplicitField(const Recipe& recipe, const std::string& name = "recipe");

  double value(const Vec3d& p) const;
  bool inside(const Vec3d& p) const { return value(p) > 0.0; }
  // Of F, pointing inwards. Analytic for a bare body; with layers, central differences over gradient_step().
  Vec3d gradient(const Vec3d& p) const;
  // 2^-11 of the longest side of bounds(), in length units.
  double gradient_step() const;

  // Whether the body can be evaluated to the digits of coordinates near an origin: not where operations
  // combine bodies.
  bool has_near_form() const;

  // Holds the whole surface, within about 1/64 of its longest side; empty where the body is.
  Box bounds() const;
  // The |elevation| never exceeds this, in length units.
  double height_bound() const;

  // Of each layer of craters, those listed and those drawn, from the oldest to the youngest.
  std::span<const LayerCraters> craters() const;

  // Of each layer of boulders, those listed, then those drawn.
  std::span<const LayerBoulders> boulders() const;

  FieldBlock gather(const Box& box) const;

  const FieldModel& model() const { return *model_; }

 private:
  std::shared_ptr<const FieldModel> model_;
};

}  // namespace astrolith
