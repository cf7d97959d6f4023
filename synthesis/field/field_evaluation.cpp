#include <algorithm>
#include <cmath>
#include <numeric>

#include "synthesis/body/local_metaballs.h"
#include "synthesis/field/field_batch_internal.h"

namespace astrolith {
namespace {

// Keeps the points where |F| with the layers so far is at most `reach`, and the points that boulders reach.
// Fine layers cost most, and the coarse layers before them already tell for most points that no surface is
// near. value[i] of a dropped point becomes F with the layers so far. `number` holds the points' numbers i.
void keep_undecided(const FieldModel& model, std::span<const std::uint32_t> boulders, float reach, Batch& b,
                    std::array<int, kBatch>& number, float* value) {
  const BatchPoints& at = b.body.at;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(b.n); ++i) {
    if (std::fabs(b.distance[i] + b.elevation[i]) > reach &&
        !is_reached(model, boulders, at.x[i], at.y[i], at.z[i])) {
      value[number[i]] += b.elevation[i];
      continue;
    }
    if (i != kept) b.move(i, kept);
    number[kept++] = number[i];
  }
  b.n = static_cast<int>(kept);
}

// Writes the local points, displaced by the body's warp. Fine layers need the displacement in the frame of
// the patch.
void displace_locally(const FieldModel& model, Batch& b) {
  const BatchPoints &p = b.local.at, &at = b.body.at, &mapped = b.body.mapped;
  BatchPoints& out = b.local.mapped;
  if (model.patch_warp) {
    warp_points(*model.patch_warp, model.tables.arrays, b.n, p.x.data(), p.y.data(), p.z.data(), out.x.data(),
                out.y.data(), out.z.data());
    return;
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(b.n); ++i) {
    out.x[i] = p.x[i] + (mapped.x[i] - at.x[i]);
    out.y[i] = p.y[i] + (mapped.y[i] - at.y[i]);
    out.z[i] = p.z[i] + (mapped.z[i] - at.z[i]);
  }
}

// Adds to value[i] the elevation that the layers make, close to the surface and wherever boulders reach.
void add_elevations(const FieldModel& model, const BatchLists& lists, std::span<const std::uint32_t> boulders,
                    float band, std::size_t layers, Batch& b, float* value) {
  std::array<int, kBatch> number;
  std::iota(number.begin(), number.begin() + b.n, 0);
  keep_undecided(model, boulders, model.tables.height_reach + band, b, number, value);
  for (std::size_t i = 0; i < std::min(layers, model.layers.size()); ++i) {
    const FieldLayer& layer = model.layers[i];
    keep_undecided(model, boulders, layer.join.remaining_change + band, b, number, value);
    if (b.n == 0) return;
    b.spots = find_spots(lists.spots, i);
    apply_layer(model, layer, b);
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(b.n); ++i) value[number[i]] += b.elevation[i];
}

// Begins a batch: evaluates the bare body at n points. No layer has changed the elevation yet.
void begin_batch(const FieldModel& model, const BatchLists& lists, int n, const PointArrays& at,
                 const LocalPoints* local, Batch& b) {
  const FieldView& f = model.tables;
  const BodyLeaf& first = f.leaf(0);
  const bool plain = f.body.plain();
  b.n = n;
  b.body.at.copy(n, at);
  BatchPoints &mapped = b.body.mapped, &gradient = b.gradient;
  mapped.copy(n, at);
  if (plain && first.warped) {
    warp_points(first.warp, f.arrays, n, at.x, at.y, at.z, mapped.x.data(), mapped.y.data(), mapped.z.data());
  }
  if (local != nullptr) {
    b.origin = &local->origin;
    b.local.at.copy(n, local->local);
  }
  if (local != nullptr && plain) {
    displace_locally(model, b);
    const PointArrays p = b.local.mapped.arrays();
    evaluate_local_metaballs(plain_metaballs(f.body, f.arrays, lists.metaballs), local->origin, n, p.x, p.y,
                             p.z, b.distance.data(), gradient.x.data(), gradient.y.data(), gradient.z.data());
  } else {
    evaluate_body(f.body, f.arrays, lists.metaballs, n, mapped.x.data(), mapped.y.data(), mapped.z.data(),
                  b.distance.data(), gradient.x.data(), gradient.y.data(), gradient.z.data());
  }
  std::fill_n(b.elevation.data(), n, 0.0f);
  b.kept.resize(model.num_kept_heights);
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

// Paints the points that lie on boulders: where a boulder's surface is above the ground and other boulders.
void paint_boulders(const FieldModel& model, std::span<const BoulderTone> tones, const PointArrays& at,
                    const LocalPoints* local, const Batch& b, PaintedPoint* points) {
  std::array<float, kBatch> highest;
  const auto n = static_cast<std::size_t>(b.n);
  const std::vector<PaintedPoint> ground(points, points + n);
  for (std::size_t i = 0; i < n; ++i) highest[i] = b.distance[i] + b.elevation[i];
  for (const std::uint32_t k : boulders_around(model, b.n, at)) {
    const bool in_patch = local != nullptr && k < model.patch_boulders.size() && model.patch_boulders[k];
    const BoulderKernel& kernel = in_patch ? *model.patch_boulders[k] : model.boulders[k].kernel;
    const PointArrays& p = in_patch ? local->local : at;
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3f u = boulder_coordinates(kernel, p.x[i], p.y[i], p.z[i]);
      if (!(squared_length(u.x, u.y, u.z) < kernel.reach_squared)) continue;
      const float distance = boulder_distance(kernel, u);
      if (!(distance > highest[i])) continue;
      highest[i] = distance;
      points[i] = ground[i];
      points[i].on_boulder = tones[k].covers;
      if (!tones[k].covers) continue;
      points[i].color = tones[k].color;
      points[i].tone = tones[k].tone;
    }
  }
}

}  // namespace

void Batch::move(std::size_t from, std::size_t to) {
  for (auto* a : {&distance, &elevation}) (*a)[to] = (*a)[from];
  gradient.move(from, to);
  const auto move_frame = [&](BatchFrame& frame) {
    frame.at.move(from, to);
    frame.mapped.move(from, to);
    if (frame.is_projected) frame.feet.move(from, to);
  };
  move_frame(body);
  if (origin != nullptr) move_frame(local);
  if (is_displaced) displacement.move(from, to);
  for (auto& heights : kept) heights[to] = heights[from];
}

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
  begin_batch(model, lists, n, at, local, b);
  // The band is a distance, and s may change faster than a distance by this factor.
  const float band = accuracy.band * model.tables.steepest;
  std::copy_n(b.distance.data(), n, value);
  const std::vector<std::uint32_t> boulders = boulders_around(model, n, at);
  if (!model.layers.empty()) {
    add_elevations(model, lists, boulders, band, accuracy.layers, b, value);
  }
  for (const std::uint32_t k : boulders) join_boulder(model, k, n, at, local, value);
}

void evaluate_stages(const FieldModel& model, const BatchLists& lists, int n, const PointArrays& at,
                     const std::function<void(const FieldStage&)>& visit, const LocalPoints* local) {
  Batch b;
  begin_batch(model, lists, n, at, local, b);
  std::array<float, kBatch> value;
  const auto show = [&](int layer, bool is_boulders) {
    visit({layer, is_boulders, {value.data(), static_cast<std::size_t>(n)}});
  };
  std::copy_n(b.distance.data(), n, value.data());
  show(-1, false);
  for (std::size_t i = 0; i < model.layers.size(); ++i) {
    b.spots = find_spots(lists.spots, i);
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

void paint_batch(const FieldModel& model, const BatchLists& lists, const SurfacePaints& paints, int n,
                 const PointArrays& at, PaintedPoint* points, const LocalPoints* local) {
  Batch b;
  begin_batch(model, lists, n, at, local, b);
  auto image = paints.images.begin();
  auto noise = paints.noises.begin();
  auto craters = paints.craters.begin();
  for (std::size_t i = 0; i < model.layers.size(); ++i) {
    const FieldLayer& layer = model.layers[i];
    b.spots = find_spots(lists.spots, i);
    const auto paint = [&](auto& next, const auto end) {
      if (next != end && next->layer == i) paint_layer(model, layer, *next++, b, points);
    };
    paint(image, paints.images.end());
    paint(noise, paints.noises.end());
    paint(craters, paints.craters.end());
    apply_layer(model, layer, b);
  }
  for (std::size_t k = 0; k < static_cast<std::size_t>(n); ++k) {
    points[k].up = -normalized(Vec3f{b.gradient.x[k], b.gradient.y[k], b.gradient.z[k]});
    points[k].elevation = b.elevation[k];
  }
  if (!paints.boulders.empty()) paint_boulders(model, paints.boulders, at, local, b, points);
}

float layer_height_at(const FieldModel& model, std::size_t number, const Vec3d& p) {
  const float x = static_cast<float>(p.x), y = static_cast<float>(p.y), z = static_cast<float>(p.z);
  Batch b;
  begin_batch(model, {model.metaballs.lists(), {}}, 1, {&x, &y, &z}, nullptr, b);
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
