// Points of a field that are evaluated together, and what becomes of them.
#pragma once

#include <array>
#include <vector>

#include "synthesis/field/field_model_internal.h"

namespace astrolith {

// Points evaluated together: a block of 9^3 samples and some, on the stack.
inline constexpr int kBatch = 1024;

// Points, where the metaballs are evaluated for them, s and grad L there, what the layers so far have made of
// the surface, and a layer's heights.
struct Batch {
  int n = 0;
  std::array<float, kBatch> x, y, z, mx, my, mz, distance, gx, gy, gz, elevation, height;
  std::array<float, kBatch> px, py, pz;  // projected on the bare surface
  bool is_projected = false;             // for the first layer that asks
  const SpotImpulses* spots = nullptr;   // of the layer, that reach the points; null where none were drawn
  std::array<float, kBatch> lx, ly, lz;  // coordinates local to an origin, where there is one
  const Vec3d* origin = nullptr;         // null: there is none
  std::array<float, kBatch> weight;
  // Displacements by the layers that warp those after them, and displaced coordinates; of a model with such.
  bool is_displaced = false;
  std::array<float, kBatch> dx, dy, dz, qx, qy, qz;
  std::vector<std::array<float, kBatch>> kept;  // heights that masks ask for, by slot
  bool tetrahedra = false;  // whether points are the corners of such, and none may be left out
};

struct PointArrays {
  const float *x, *y, *z;
};

// Points in coordinates local to an origin.
struct LocalPoints {
  Vec3d origin;
  PointArrays local;
};

// How well F is asked for.
struct Accuracy {
  float band = kExactEverywhere;
  bool tetrahedra = false;
};

// What reaches the points of a block, as lists; null spots of a layer are drawn.
struct BatchLists {
  LeafLists metaballs;
  const DrawnSpots& spots;
};

// Joins a layer's heights to what those before it made of the elevation of a batch (layer_join.h).
void apply_layer(const FieldModel& model, const FieldLayer& layer, Batch& b);

// value[i] = F at n <= kBatch points of a block; `local` has them in coordinates local to an origin.
void evaluate_batch(const FieldModel& model, const BatchLists& lists, int n, const PointArrays& at,
                    const Accuracy& accuracy, float* value, const LocalPoints* local = nullptr);

}  // namespace astrolith
