// The points of a field that are evaluated together, and their state from layer to layer.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "synthesis/exemplar/exemplar_colors.h"
#include "synthesis/field/field_model_internal.h"

namespace astrolith {

// The most points evaluated together. A block of 9^3 samples fits, and a batch fits on the stack. Arrays of a
// power of two would lie in the same places of the caches.
inline constexpr int kBatch = 1008;

// A batch of points and their state while layer after layer is added.
struct Batch {
  int n = 0;                                       // number of points
  std::array<float, kBatch> x, y, z;               // the points
  std::array<float, kBatch> mx, my, mz;            // where the metaballs are evaluated for the points
  std::array<float, kBatch> distance, gx, gy, gz;  // s and grad L at (mx, my, mz)
  std::array<float, kBatch> elevation;             // elevation that the layers so far have made
  std::array<float, kBatch> height;                // heights of the current layer
  std::array<float, kBatch> px, py, pz;            // projections of the points on the bare surface
  bool is_projected = false;                       // whether px, py and pz are there
  const SpotImpulses* spots = nullptr;   // spots of the current layer that reach the points; null: not drawn
  std::array<float, kBatch> lx, ly, lz;  // coordinates local to `origin`
  std::array<float, kBatch> lmx, lmy, lmz;  // the same for (mx, my, mz); set for a plain body only
  std::array<float, kBatch> lpx, lpy, lpz;  // the same for (px, py, pz)
  bool is_locally_projected = false;        // whether lpx, lpy and lpz are there
  const Vec3d* origin = nullptr;            // origin of local coordinates; null: there are none
  std::array<float, kBatch> weight;         // weight of the current layer
  bool is_displaced = false;                // whether a layer so far warps the coordinates of later layers
  std::array<float, kBatch> dx, dy, dz;     // displacements by the layers that warp later layers
  std::array<float, kBatch> qx, qy, qz;     // displaced coordinates
  std::vector<std::array<float, kBatch>> kept;  // heights kept for masks, by slot
  bool tetrahedra = false;  // whether the points are corners of tetrahedra, of which none may be left out
};

struct PointArrays {
  const float *x, *y, *z;
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

// Blends the colours of a layer that paints over color[i] at the points of a batch. Expects the heights that
// the layer's mask needs to be kept in the batch.
void paint_layer(const FieldModel& model, const FieldLayer& layer, const LayerPaint& paint, Batch& b,
                 Vec3f* color);

// FieldBlock::paint() at n <= kBatch points of a block. `local` is as below.
void paint_batch(const FieldModel& model, const BatchLists& lists, std::span<const LayerPaint> paints, int n,
                 const PointArrays& at, Vec3f* color, const LocalPoints* local = nullptr);

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
