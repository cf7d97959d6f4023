// The points of a field that are evaluated together, and their state from layer to layer.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "synthesis/field/field_model_internal.h"
#include "synthesis/field/surface_paints.h"

namespace astrolith {

// The most points evaluated together. A block of 9^3 samples fits, and a batch fits on the stack. Arrays of a
// power of two would lie in the same places of the caches. Arrays begin with a line of the cache (64 bytes),
// so that no load of a vector crosses two lines.
inline constexpr int kBatch = 1008;

struct PointArrays {
  const float *x, *y, *z;
};

// Coordinates of the points of a batch.
struct BatchPoints {
  alignas(64) std::array<float, kBatch> x, y, z;

  PointArrays arrays() const { return {x.data(), y.data(), z.data()}; }
  void copy(int n, const PointArrays& from) {
    std::copy_n(from.x, n, x.data());
    std::copy_n(from.y, n, y.data());
    std::copy_n(from.z, n, z.data());
  }
  // Makes point `from` the point `to`.
  void move(std::size_t from, std::size_t to) { x[to] = x[from], y[to] = y[from], z[to] = z[from]; }
};

// The points of a batch in the body's frame, or in coordinates local to an origin.
struct BatchFrame {
  BatchPoints at;
  BatchPoints mapped;         // where the metaballs are evaluated for them; for a plain body only if local
  BatchPoints feet;           // their projections on the bare surface
  bool is_projected = false;  // whether the projections are there
};

// A batch of points and their state while layer after layer is added.
struct Batch {
  int n = 0;                  // number of points
  bool tetrahedra = false;    // whether the points are corners of tetrahedra, of which none may be left out
  bool is_displaced = false;  // whether a layer so far warps the coordinates of later layers
  const Vec3d* origin = nullptr;        // origin of local coordinates; null: there are none
  const SpotImpulses* spots = nullptr;  // spots of the current layer that reach the points; null: not drawn
  std::vector<std::array<float, kBatch>> kept;  // heights kept for masks, by slot
  BatchFrame body;
  BatchFrame local;                                // set if there is an origin
  BatchPoints gradient;                            // grad L at the mapped points
  BatchPoints displacement;                        // by the layers that warp later layers
  BatchPoints displaced;                           // displaced coordinates
  alignas(64) std::array<float, kBatch> distance;  // s at the mapped points
  std::array<float, kBatch> elevation;             // elevation that the layers so far have made
  std::array<float, kBatch> height;                // heights of the current layer
  std::array<float, kBatch> weight;                // weight of the current layer

  // Makes point `from` the point `to`.
  void move(std::size_t from, std::size_t to);
};

// Points in coordinates local to an origin.
struct LocalPoints {
  Vec3d origin;
  PointArrays local;
};

// The accuracy that a caller needs (implicit_field.h).
struct Accuracy {
  float band = kExactEverywhere;
  bool tetrahedra = false;
  std::size_t layers = std::numeric_limits<std::size_t>::max();  // at most so many layers are added
};

// The metaballs and the spots that reach the points of a block. Spots of a layer that are null are drawn for
// each batch.
struct BatchLists {
  LeafLists metaballs;
  const DrawnSpots& spots;
};

// Evaluates a layer at the points of a batch and joins it with the elevation so far (layer_join.h).
void apply_layer(const FieldModel& model, const FieldLayer& layer, Batch& b);

// Evaluates the heights of a layer at the points of a batch, whether it joins them or not. Expects a layer
// that is no layer of craters.
void evaluate_layer(const FieldModel& model, const FieldLayer& layer, Batch& b);

// Paints what a layer paints over the points of a batch. Expects the heights that the layer's mask needs to
// be kept in the batch.
void paint_layer(const FieldModel& model, const FieldLayer& layer, const LayerPaint& paint, Batch& b,
                 PaintedPoint* points);
void paint_layer(const FieldModel& model, const FieldLayer& layer, const NoiseTone& tone, Batch& b,
                 PaintedPoint* points);
// Adds the tones of craters, each over those of older ones of its layer.
void paint_layer(const FieldModel& model, const FieldLayer& layer, const CraterTone& tone, Batch& b,
                 PaintedPoint* points);

// FieldBlock::paint() at n <= kBatch points of a block. `local` is as below.
void paint_batch(const FieldModel& model, const BatchLists& lists, const SurfacePaints& paints, int n,
                 const PointArrays& at, PaintedPoint* points, const LocalPoints* local = nullptr);

// FieldBlock::evaluate_stages() at n <= kBatch points of a block. `local` is as below.
void evaluate_stages(const FieldModel& model, const BatchLists& lists, int n, const PointArrays& at,
                     const std::function<void(const FieldStage&)>& visit, const LocalPoints* local = nullptr);

// value[i] = F at n <= kBatch points of a block. `local`, unless null, holds the same points in coordinates
// local to an origin.
void evaluate_batch(const FieldModel& model, const BatchLists& lists, int n, const PointArrays& at,
                    const Accuracy& accuracy, float* value, const LocalPoints* local = nullptr);

// FieldBlock::find_signs() at n <= kBatch points of a block.
void find_sure_signs(const FieldModel& model, const BatchLists& lists, int n, const PointArrays& at,
                     float tolerance, std::int8_t* sign);

// The numbers of the boulders that may change F at the points.
std::vector<std::uint32_t> boulders_around(const FieldModel& model, int n, const PointArrays& at);

// Whether one of the boulders may change F at a point.
bool is_reached(const FieldModel& model, std::span<const std::uint32_t> boulders, float x, float y, float z);

}  // namespace astrolith
