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

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "geometry/surface/ground_plane.h"
#include "numerics/progress.h"
#include "recipe/recipe.h"
#include "synthesis/body/body_tables.h"
#include "synthesis/mesh/block_field.h"
#include "synthesis/spots/spot_noise.h"

namespace astrolith {

struct GaborCacheUse;  // synthesis/gabor/gabor_bricks.h
struct FieldModel;     // synthesis/field/field_model_internal.h
struct FieldView;      // synthesis/field/field_tables.h
struct SurfacePaints;  // synthesis/field/surface_paints.h
struct PaintedPoint;   // synthesis/field/surface_paints.h
struct LayerCraters;   // synthesis/landforms/crater_relief.h
struct LayerBoulders;  // synthesis/landforms/boulder_field.h

// A cube that a field is evaluated in, in coordinates relative to its centre; length units.
struct PatchCube {
  Vec3d center;
  double side = 0.0;
  // A smaller cube about the same centre, along other axes, that alone is shown; none where all of it is.
  struct Turned {
    GroundAxes axes;
    double side = 0.0;
  };
  std::optional<Turned> turned = std::nullopt;
};

// A part of a layer that is too fine for the coordinates that the field is evaluated in, or the landforms of
// a layer that are too many for a whole body.
struct LayerLeftOut {
  int layer = 0;                // the layer's index in the recipe; -1: the body's warp
  double variance_share = 0.0;  // share in the variance that the whole layer would have, (0, 1]
  double finest = 0.0;          // shortest wave, narrowest cell or least landform of the layer, length units
  double landforms = 0.0;       // of a population drawn by cells: how many the whole body would have more
};

// The spots that reach a box, one pointer for each layer; null where nothing was drawn. The vector is empty
// for a field without layers of spots.
using DrawnSpots = std::vector<std::shared_ptr<const SpotImpulses>>;

// F with the body and the layers up to one of them, as its layers are added one after another: first the bare
// body, then all layers but boulders in the order of the recipe, then the layers of boulders.
struct FieldStage {
  int layer;                     // the index in the recipe of the layer that was added; -1: the bare body
  bool is_boulders;              // whether it is a layer of boulders
  std::span<const float> value;  // F at some points
};

// A field narrowed to a box. The block must not outlive its field. All members may be called from many
// threads.
class FieldBlock {
 public:
  // kOutside: F < 0 at every float point of the box; kInside: F > 0.
  BlockContent content() const;

  // The block of a box within this one: the block that the field would gather, at a lower cost.
  FieldBlock restricted_to(const Box& child) const;

  // value[i] = F(x[i], y[i], z[i]) for points within the box; four spans of one size. Where the remaining
  // layers cannot bring F into +-band (length units), value[i] lacks them.
  void evaluate(std::span<const float> x, std::span<const float> y, std::span<const float> z,
                std::span<float> value, float band = kExactEverywhere) const {
    evaluate_at(nullptr, x, y, z, value, band, false);
  }

  // sign[i] = 1 where evaluate() gives F > 0 at a point for sure, -1 where it gives F < 0, and 0 where
  // neither is proven. This costs a small part of evaluate(). Where the bounds of s are wider than
  // `tolerance` (length units), they are made again for smaller groups of points.
  void find_signs(std::span<const float> x, std::span<const float> y, std::span<const float> z,
                  float tolerance, std::span<std::int8_t> sign) const;

  // value[i] = F at the corners of small tetrahedra, four after four. Their differences give the slope of F.
  // Gabor noise is evaluated once for all four corners, to first order about the tetrahedron's centre.
  void evaluate_tetrahedra(std::span<const float> x, std::span<const float> y, std::span<const float> z,
                           std::span<float> value) const {
    evaluate_at(nullptr, x, y, z, value, kExactEverywhere, true);
  }

  // value[i] = F(origin + (x, y, z)). If the field was made for a patch, the origin must be its centre;
  // throws std::invalid_argument otherwise. The points must lie within the box, but for the rounding of its
  // coordinates to float. A body that has_local_form() and fractal layers are evaluated to the digits of x, y
  // and z; other bodies and layers are evaluated to the digits of float coordinates in the body's frame.
  void evaluate_local(const Vec3d& origin, std::span<const float> x, std::span<const float> y,
                      std::span<const float> z, std::span<float> value, float band) const {
    evaluate_at(&origin, x, y, z, value, band, false);
  }
  void evaluate_local_tetrahedra(const Vec3d& origin, std::span<const float> x, std::span<const float> y,
                                 std::span<const float> z, std::span<float> value) const {
    evaluate_at(&origin, x, y, z, value, kExactEverywhere, true);
  }

  // Calls visit(first, stage) for the stages of F at points first, first + 1, ... within the box: all stages
  // of some points, then all stages of the next points. Layers without heights have no stage. With `origin`,
  // points are relative to it as in evaluate_local(); it is null for points of the body's frame.
  void evaluate_stages(const Vec3d* origin, std::span<const float> x, std::span<const float> y,
                       std::span<const float> z,
                       const std::function<void(std::size_t, const FieldStage&)>& visit) const;

  // Paints over points[i].color and tone in the order of the layers, at points within the box, and says what
  // lies there. With `origin`, points are relative to it as in evaluate_local(); it is null for points of the
  // body's frame.
  void paint(const SurfacePaints& paints, const Vec3d* origin, std::span<const float> x,
             std::span<const float> y, std::span<const float> z, std::span<PaintedPoint> points) const;

  const Box& box() const { return box_; }

  // The memory of the lists that the block owns, bytes.
  double list_bytes() const;

 private:
  friend class ImplicitField;
  FieldBlock(const FieldModel& model, ReachingMetaballs metaballs, DrawnSpots spots, const Box& box)
      : model_(&model), metaballs_(std::move(metaballs)), spots_(std::move(spots)), box_(box) {}

  template <class Use>
  void for_each_batch(const Vec3d* origin, std::size_t count, std::span<const float> x,
                      std::span<const float> y, std::span<const float> z, const Use& use) const;
  void evaluate_at(const Vec3d* origin, std::span<const float> x, std::span<const float> y,
                   std::span<const float> z, std::span<float> value, float band, bool tetrahedra) const;

  const FieldModel* model_;
  ReachingMetaballs metaballs_;
  DrawnSpots spots_;
  Box box_;
};

class ImplicitField {
 public:
  // Expects a recipe that validation accepts; `name` begins the messages of errors. Throws InputError for a
  // recipe without a body, and for craters and boulders that have no place on it or are wider than it;
  // WorkError where `progress` asks to stop.
  //
  // Layers too fine for float coordinates of the body's frame are left out. With `patch`, evaluate_local()
  // has them within the cube, if the body has_local_form(). Blocks of such a field must lie in the cube or
  // within its side of it. The functions that take points of the body's frame never have the fine layers.
  //
  // `like` is a field of the same body, seed and relief layers in the same places, whose laid heights and
  // grids of morphs are taken: they are most of the work on a large relief, or on a morph.
  explicit ImplicitField(const Recipe& recipe, const std::string& name = "recipe",
                         const std::optional<PatchCube>& patch = {}, const Progress& progress = {},
                         const ImplicitField* like = nullptr);

  double value(const Vec3d& p) const;
  bool inside(const Vec3d& p) const { return value(p) > 0.0; }
  // The gradient of F, pointing inwards. Analytic for a bare body; with layers, central differences over
  // gradient_step().
  Vec3d gradient(const Vec3d& p) const;
  // The step of the central differences of gradient(): 2^-11 of the longest side of bounds(), in length
  // units.
  double gradient_step() const;

  // Whether the body can be evaluated to the digits of coordinates local to an origin. A body with operations
  // cannot.
  bool has_local_form() const;

  // A box that holds the whole surface, within about 1/64 of its longest side; empty for an empty body.
  Box bounds() const;
  // The |elevation| never exceeds this, in length units.
  double height_bound() const;

  // What coordinates cannot resolve of the layers: of a field for a patch in the patch, else in the body's
  // frame. In the order of the layers.
  std::span<const LayerLeftOut> left_out() const;
  // Whether layers have another form in the field's patch than in the body's frame.
  bool has_patch_layers() const;

  // The craters of each layer, listed and drawn, from the oldest to the youngest.
  std::span<const LayerCraters> craters() const;

  // The boulders of each layer: the listed ones, then the drawn ones.
  std::span<const LayerBoulders> boulders() const;

  // The field narrowed to a box.
  FieldBlock gather(const Box& box) const;

  // What the cache of each list of Gabor impulses holds; tables().gabor_lists says which bands these are.
  std::vector<GaborCacheUse> gabor_caches() const;
  // Seconds of one processor to draw a brick of each list, from bricks that its cache holds.
  std::vector<double> gabor_brick_seconds() const;

  // The index in the recipe of each layer of the tables, which lack boulders and layers that act on nothing.
  std::span<const int> recipe_layers() const;

  // The field's tables, for evaluation on a GPU. They live as long as the field.
  const FieldView& tables() const;
  // Its tables for points relative to the centre of the patch that the field was made for. Throws
  // std::invalid_argument where it was made for none.
  const FieldView& patch_tables() const;

 private:
  std::shared_ptr<const FieldModel> model_;
};

}  // namespace astrolith
