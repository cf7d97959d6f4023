#include <algorithm>
#include <cmath>

#include "synthesis/body/local_metaballs.h"
#include "synthesis/field/field_batch_internal.h"

namespace astrolith {
namespace {

// Keeps the points with |s| <= reach and the points that boulders reach, and drops all others from the batch.
// Returns the number of points kept; origin[k] becomes the old number of point k.
template <typename Reach>
int keep_near_surface(int n, float reach, const Reach& boulders_reach, const PointArrays& at,
                      const PointArrays& metaballs_at, const LocalPoints* local, Batch& b,
                      std::array<int, kBatch>& origin) {
  int kept = 0;
  for (int i = 0; i < n; ++i) {
    const auto from = static_cast<std::size_t>(i), to = static_cast<std::size_t>(kept);
    if (std::fabs(b.distance[from]) > reach && !boulders_reach(i)) continue;
    b.x[to] = at.x[i], b.y[to] = at.y[i], b.z[to] = at.z[i];
    b.mx[to] = metaballs_at.x[i], b.my[to] = metaballs_at.y[i], b.mz[to] = metaballs_at.z[i];
    for (auto* a : {&b.distance, &b.gx, &b.gy, &b.gz}) (*a)[to] = (*a)[from];
    if (local != nullptr) {
      b.lx[to] = local->local.x[i], b.ly[to] = local->local.y[i], b.lz[to] = local->local.z[i];
      for (auto* a : {&b.lmx, &b.lmy, &b.lmz}) (*a)[to] = (*a)[from];
    }
    origin[to] = i;
    ++kept;
  }
  return kept;
}

// Keeps the points where |F| with the layers so far is at most `reach`, and the points that boulders reach.
// Fine layers cost most, and the coarse layers before them already tell for most points that no surface is
// near. value[i] of a dropped point becomes F with the layers so far.
template <typename Reach>
void keep_undecided(float reach, const Reach& boulders_reach, Batch& b, std::array<int, kBatch>& origin,
                    float* value) {
  int kept = 0;
  for (std::size_t from = 0; from < static_cast<std::size_t>(b.n); ++from) {
    if (std::fabs(b.distance[from] + b.elevation[from]) > reach && !boulders_reach(origin[from])) {
      value[origin[from]] += b.elevation[from];
      continue;
    }
    const auto to = static_cast<std::size_t>(kept++);
    if (to == from) continue;
    for (auto* a :
         {&b.x,        &b.y,  &b.z,  &b.mx, &b.my,        &b.mz, &b.lx, &b.ly, &b.lz,  &b.lmx, &b.lmy, &b.lmz,
          &b.distance, &b.gx, &b.gy, &b.gz, &b.elevation, &b.px, &b.py, &b.pz, &b.lpx, &b.lpy, &b.lpz}) {
      (*a)[to] = (*a)[from];
    }
    if (b.is_displaced) {
      for (auto* a : {&b.dx, &b.dy, &b.dz}) (*a)[to] = (*a)[from];
    }
    for (auto& heights : b.kept) heights[to] = heights[from];
    origin[to] = origin[from];
  }
  b.n = kept;
}

// Writes the points, displaced by the body's warp, to (lmx, lmy, lmz) of the batch. `metaballs_at` holds the
// displaced points `at` in the body's frame. Fine layers need the displacement in the frame of the patch.
void displace_locally(const FieldModel& model, int n, const LocalPoints& local, const PointArrays& at,
                      const PointArrays& metaballs_at, Batch& b) {
  const PointArrays& p = local.local;
  if (model.patch_warp) {
    warp_points(*model.patch_warp, model.tables.arrays, n, p.x, p.y, p.z, b.lmx.data(), b.lmy.data(),
                b.lmz.data());
    return;
  }
  const auto displaced = [n](const float* c, const float* from, const float* to, float* out) {
    for (int i = 0; i < n; ++i) out[i] = c[i] + (to[i] - from[i]);
  };
  displaced(p.x, at.x, metaballs_at.x, b.lmx.data());
  displaced(p.y, at.y, metaballs_at.y, b.lmy.data());
  displaced(p.z, at.z, metaballs_at.z, b.lmz.data());
}

// Adds to value[i] the elevation that the layers make, close to the surface and wherever boulders reach.
void add_elevations(const FieldModel& model, const BatchLists& lists, std::span<const std::uint32_t> boulders,
                    const PointArrays& at, const PointArrays& metaballs_at, const LocalPoints* local,
                    float band, std::size_t layers, Batch& b, float* value) {
  std::array<int, kBatch> origin;
  const auto boulders_reach = [&](int i) { return is_reached(model, boulders, at.x[i], at.y[i], at.z[i]); };
  b.n = keep_near_surface(b.n, model.tables.height_reach + band, boulders_reach, at, metaballs_at, local, b,
                          origin);
  if (b.n == 0) return;
  std::fill_n(b.elevation.data(), b.n, 0.0f);
  b.kept.resize(model.num_kept_heights);
  for (std::size_t i = 0; i < std::min(layers, model.layers.size()); ++i) {
    const FieldLayer& layer = model.layers[i];
    keep_undecided(layer.join.remaining_change + band, boulders_reach, b, origin, value);
    if (b.n == 0) return;
    b.spots = spots_of(lists.spots, i);
    apply_layer(model, layer, b);
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(b.n); ++i) value[origin[i]] += b.elevation[i];
}

// Begins a batch: evaluates the bare body at n points. Returns where the metaballs are evaluated for them.
PointArrays begin_batch(const FieldModel& model, const BatchLists& lists, int n, const PointArrays& at,
                        const LocalPoints* local, Batch& b) {
  const FieldView& f = model.tables;
  const BodyLeaf& first = f.leaf(0);
  const bool plain = f.body.plain();
  b.n = n;
  PointArrays metaballs_at = at;
  if (plain && first.warped) {
    warp_points(first.warp, f.arrays, n, at.x, at.y, at.z, b.mx.data(), b.my.data(), b.mz.data());
    metaballs_at = {b.mx.data(), b.my.data(), b.mz.data()};
  }
  if (local != nullptr) b.origin = &local->origin;
  if (local != nullptr && plain) {
    displace_locally(model, n, *local, at, metaballs_at, b);
    evaluate_local_metaballs(metaballs_of_plain(f.body, f.arrays, lists.metaballs), local->origin, n,
                             b.lmx.data(), b.lmy.data(), b.lmz.data(), b.distance.data(), b.gx.data(),
                             b.gy.data(), b.gz.data());
  } else {
    evaluate_body(f.body, f.arrays, lists.metaballs, n, metaballs_at.x, metaballs_at.y, metaballs_at.z,
                  b.distance.data(), b.gx.data(), b.gy.data(), b.gz.data());
  }
  return metaballs_at;
}

// Joins a boulder with F at n points, in the frame of the patch where it has a kernel there.
void join_boulder(const FieldModel& model, std::uint32_t number, int n, const PointArrays& at,
                  const LocalPoints* local, float* value) {
  const bool in_patch =
      local != nullptr && number < model.patch_boulders.size() && model.patch_boulders[number];
  const PointArrays& p = in_patch ? local->local : at;
  join_boulder(in_patch ? *model.patch_boulders[number] : model.boulders[number].kernel, n, p.x, p.y, p.z,
               value);
}

}  // namespace

std::vector<std::uint32_t> boulders_around(const FieldModel& model, int n, const PointArrays& at) {
  if (model.boulders.empty()) return {};
  Box box;
  for (int i = 0; i < n; ++i) box.extend({at.x[i], at.y[i], at.z[i]});
  return model.boulder_tree.touching(box);
}

bool is_reached(const FieldModel& model, std::span<const std::uint32_t> boulders, float x, float y, float z) {
  return std::any_of(boulders.begin(), boulders.end(),
                     [&](std::uint32_t k) { return boulder_reaches(model.boulders[k], x, y, z); });
}

void evaluate_batch(const FieldModel& model, const BatchLists& lists, int n, const PointArrays& at,
                    const Accuracy& accuracy, float* value, const LocalPoints* local) {
  Batch b;
  b.tetrahedra = accuracy.tetrahedra;
  const PointArrays metaballs_at = begin_batch(model, lists, n, at, local, b);
  // The band is a distance, and s may change faster than a distance by this factor.
  const float band = accuracy.band * model.tables.steepest;
  std::copy_n(b.distance.data(), n, value);
  const std::vector<std::uint32_t> boulders = boulders_around(model, n, at);
  if (!model.layers.empty()) {
    add_elevations(model, lists, boulders, at, metaballs_at, local, band, accuracy.layers, b, value);
  }
  for (const std::uint32_t k : boulders) join_boulder(model, k, n, at, local, value);
}

namespace {

// Evaluates the bare body at n points, and keeps all of them for layers.
void begin_everywhere(const FieldModel& model, const BatchLists& lists, int n, const PointArrays& at,
                      const LocalPoints* local, Batch& b) {
  const PointArrays metaballs_at = begin_batch(model, lists, n, at, local, b);
  std::array<int, kBatch> origin;
  const auto everywhere = [](int) { return true; };
  keep_near_surface(n, 0.0f, everywhere, at, metaballs_at, local, b, origin);
  std::fill_n(b.elevation.data(), n, 0.0f);
  b.kept.resize(model.num_kept_heights);
}

}  // namespace

void evaluate_stages(const FieldModel& model, const BatchLists& lists, int n, const PointArrays& at,
                     const std::function<void(const FieldStage&)>& visit, const LocalPoints* local) {
  Batch b;
  begin_everywhere(model, lists, n, at, local, b);
  std::array<float, kBatch> value;
  const auto show = [&](int layer, bool is_boulders) {
    visit({layer, is_boulders, {value.data(), static_cast<std::size_t>(n)}});
  };
  std::copy_n(b.distance.data(), n, value.data());
  show(-1, false);
  for (std::size_t i = 0; i < model.layers.size(); ++i) {
    b.spots = spots_of(lists.spots, i);
    apply_layer(model, model.layers[i], b);
    for (std::size_t k = 0; k < static_cast<std::size_t>(n); ++k) value[k] = b.distance[k] + b.elevation[k];
    show(model.recipe_layers[i], false);
  }
  const std::vector<std::uint32_t> boulders = boulders_around(model, n, at);
  auto next = boulders.begin();
  std::size_t end = 0;  // of the numbers of this layer's boulders
  for (const LayerBoulders& layer : model.placed_boulders) {
    end += layer.boulders.size();
    for (; next != boulders.end() && *next < end; ++next) {
      join_boulder(model, *next, n, at, local, value.data());
    }
    show(layer.layer, true);
  }
}

void paint_batch(const FieldModel& model, const BatchLists& lists, std::span<const LayerPaint> paints, int n,
                 const PointArrays& at, Vec3f* color, const LocalPoints* local) {
  Batch b;
  begin_everywhere(model, lists, n, at, local, b);
  auto paint = paints.begin();
  for (std::size_t i = 0; i < model.layers.size() && paint != paints.end(); ++i) {
    if (paint->layer == i) paint_layer(model, model.layers[i], *paint++, b, color);
    b.spots = spots_of(lists.spots, i);
    apply_layer(model, model.layers[i], b);
  }
}

float layer_height_at(const FieldModel& model, std::size_t number, const Vec3d& p) {
  const float x = static_cast<float>(p.x), y = static_cast<float>(p.y), z = static_cast<float>(p.z);
  const PointArrays at{&x, &y, &z};
  Batch b;
  const PointArrays metaballs_at = begin_batch(model, {model.metaballs.lists(), {}}, 1, at, nullptr, b);
  std::array<int, kBatch> origin;
  keep_near_surface(
      1, 0.0f, [](int) { return true; }, at, metaballs_at, nullptr, b, origin);
  b.elevation[0] = 0.0f;
  b.kept.resize(model.num_kept_heights);
  for (std::size_t i = 0; i < number; ++i) {
    const LayerJoin& join = model.layers[i].join;
    // Heights do not depend on the elevation of earlier layers, but on their warps.
    if (join.keeps >= 0 || join.how.kind == Combine::kWarp) apply_layer(model, model.layers[i], b);
  }
  evaluate_layer(model, model.layers[number], b);
  return b.height[0];
}

float value_at(const FieldModel& model, const Vec3d& p) {
  const float x = static_cast<float>(p.x), y = static_cast<float>(p.y), z = static_cast<float>(p.z);
  float f = 0.0f;
  evaluate_batch(model, {model.metaballs.lists(), {}}, 1, {&x, &y, &z}, {}, &f);
  return f;
}

}  // namespace astrolith
