#include <algorithm>
#include <array>
#include <cstddef>

#include "synthesis/field/field_batch_internal.h"

namespace astrolith {
namespace {

using Coordinates = std::array<float, kBatch>;

// Replaces displaced points p + warp(p) by p. Each step of the iteration multiplies the error by at most the
// steepness of the warp.
void undo_warp(const CoordinateWarp& warp, const ArrayView& arrays, int n, BatchPoints& points) {
  constexpr int kSteps = 8;
  const BatchPoints displaced = points;
  BatchPoints w;
  const auto stepped = [n](const Coordinates& to, const Coordinates& from, Coordinates& p) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) p[i] = to[i] - (from[i] - p[i]);
  };
  for (int step = 0; step < kSteps; ++step) {
    warp_points(warp, arrays, n, points.x.data(), points.y.data(), points.z.data(), w.x.data(), w.y.data(),
                w.z.data());
    stepped(displaced.x, w.x, points.x);
    stepped(displaced.y, w.y, points.y);
    stepped(displaced.z, w.z, points.z);
  }
}

// The warp of a plain body in the coordinates of a frame; null where there is none.
const CoordinateWarp* find_warp(const FieldModel& model, bool moved) {
  const BodyLeaf& first = model.tables.leaf(0);
  if (!model.body.plain() || !first.warped) return nullptr;
  if (!moved) return &first.warp;
  return model.patch_warp ? &*model.patch_warp : nullptr;
}

// Points relative to an origin in the body's frame.
void move_to_body(const Vec3d& origin, int n, BatchPoints& points) {
  const auto moved = [n](double by, Coordinates& c) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) {
      c[i] = static_cast<float>(by + double{c[i]});
    }
  };
  moved(origin.x, points.x);
  moved(origin.y, points.y);
  moved(origin.z, points.z);
}

void evaluate_below(const FieldModel& model, std::size_t layers, const NoiseFrame& frame, int n,
                    const PointArrays& at, float* field) {
  BatchPoints points;
  points.copy(n, at);
  if (const CoordinateWarp* warp = find_warp(model, frame.moved)) {
    undo_warp(*warp, model.tables.arrays, n, points);
  }
  const BatchLists lists{model.metaballs.lists(), {}};
  const Accuracy accuracy{kExactEverywhere, false, layers};
  if (!frame.moved) return evaluate_batch(model, lists, n, points.arrays(), accuracy, field);
  const BatchPoints relative = points;
  move_to_body(frame.origin, n, points);
  const LocalPoints local{frame.origin, relative.arrays()};
  evaluate_batch(model, lists, n, points.arrays(), accuracy, field, &local);
}

}  // namespace

FieldBelow field_below(const FieldModel& model, std::size_t layers, const NoiseFrame& frame) {
  const auto end = model.layers.begin() + static_cast<std::ptrdiff_t>(layers);
  const bool any = std::any_of(model.layers.begin(), end,
                               [](const FieldLayer& layer) { return layer.join.change_bound > 0.0; });
  if (!any) return {};
  return [&model, layers, frame](int n, const float* x, const float* y, const float* z, float* field) {
    for (int i = 0; i < n; i += kBatch) {
      evaluate_below(model, layers, frame, std::min(kBatch, n - i), {x + i, y + i, z + i}, field + i);
    }
  };
}

}  // namespace astrolith
