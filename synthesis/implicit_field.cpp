#include "synthesis/implicit_field.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "numerics/errors.h"
#include "synthesis/field_model_internal.h"
#include "synthesis/metaballs_near.h"
#include "synthesis/surface_projection.h"

namespace astrolith {
static_assert(BlockField<ImplicitField>);

namespace {

// Points evaluated together: a block of 9^3 samples and some, on the stack.
constexpr int kBatch = 1024;

// Points, where the metaballs are evaluated for them, s and grad L there, what the layers so far have made of
// the surface, and a layer's heights.
struct Batch {
  int n = 0;
  std::array<float, kBatch> x, y, z, mx, my, mz, distance, gx, gy, gz, elevation, height;
  std::array<float, kBatch> px, py, pz;  // projected on the bare surface
  bool is_projected = false;             // for the first layer that asks
  const SpotImpulses* spots = nullptr;   // of the layer, that reach the points; null where none were drawn
  std::array<float, kBatch> lx, ly, lz;  // of points near an origin: their local coordinates
  const Vec3d* origin = nullptr;         // null: there is none
  std::array<float, kBatch> weight;
  // Displacements by the layers that warp those after them, and displaced coordinates; of a model with such.
  bool is_displaced = false;
  std::array<float, kBatch> dx, dy, dz, qx, qy, qz;
  std::vector<std::array<float, kBatch>> kept;  // heights that masks ask for, by slot
  bool tetrahedra = false;  // whether points are the corners of such, and none may be left out
};

ASTROLITH_SIMD_CLONES void project(int n, const float* __restrict p, const float* __restrict gradient,
                                   const float* __restrict divisor, const float* __restrict distance,
                                   float longest_step, float* __restrict projected) {
#pragma omp simd
  for (int i = 0; i < n; ++i) {
    projected[i] = projected_coordinate(p[i], gradient[i], divisor[i], distance[i], longest_step);
  }
}

ASTROLITH_SIMD_CLONES void gradient_lengths(int n, const float* __restrict gx, const float* __restrict gy,
                                            const float* __restrict gz, float floor,
                                            float* __restrict length) {
#pragma omp simd
  for (int i = 0; i < n; ++i) {
    length[i] = gradient_length(gx[i], gy[i], gz[i], floor);
  }
}

void project(const FieldModel& model, Batch& b) {
  if (b.is_projected) return;
  b.is_projected = true;
  std::array<float, kBatch> length;
  gradient_lengths(b.n, b.gx.data(), b.gy.data(), b.gz.data(), model.body.metaballs.parameters.gradient_floor,
                   length.data());
  const float longest_step = static_cast<float>(model.height_bound);
  const auto along = [&](const std::array<float, kBatch>& p, const std::array<float, kBatch>& g, float* out) {
    project(b.n, p.data(), g.data(), length.data(), b.distance.data(), longest_step, out);
  };
  along(b.mx, b.gx, b.px.data());
  along(b.my, b.gy, b.py.data());
  along(b.mz, b.gz, b.pz.data());
}

struct PointArrays {
  const float *x, *y, *z;
};

// The points as far as layers have displaced them.
PointArrays displaced(Batch& b, const PointArrays& p) {
  if (!b.is_displaced) return p;
  for (std::size_t i = 0; i < static_cast<std::size_t>(b.n); ++i) {
    b.qx[i] = p.x[i] + b.dx[i];
    b.qy[i] = p.y[i] + b.dy[i];
    b.qz[i] = p.z[i] + b.dz[i];
  }
  return {b.qx.data(), b.qy.data(), b.qz.data()};
}
PointArrays layer_points(Batch& b) { return displaced(b, {b.x.data(), b.y.data(), b.z.data()}); }

void layer_heights(const FieldModel&, const FractalNoise& noise, Batch& b) {
  if (b.origin != nullptr && noise.has_near_form()) {
    const PointArrays p = displaced(b, {b.lx.data(), b.ly.data(), b.lz.data()});
    noise.evaluate_near(*b.origin, b.n, p.x, p.y, p.z, b.height.data());
  } else {
    const PointArrays p = layer_points(b);
    noise.evaluate(b.n, p.x, p.y, p.z, b.height.data());
  }
}

// Of a noise in space.
template <typename Noise>
void layer_heights(const FieldModel&, const Noise& noise, Batch& b) {
  const PointArrays p = layer_points(b);
  noise.evaluate(b.n, p.x, p.y, p.z, b.height.data());
}

void layer_heights(const FieldModel&, const SpotNoise& noise, Batch& b) {
  const PointArrays p = layer_points(b);
  noise.evaluate(b.n, p.x, p.y, p.z, b.height.data(), b.spots);
}

void layer_heights(const FieldModel& model, const GaborSurfaceNoise& noise, Batch& b) {
  project(model, b);
  if (b.tetrahedra) {
    noise.evaluate_tetrahedra(b.n, b.px.data(), b.py.data(), b.pz.data(), b.height.data());
  } else {
    noise.evaluate(b.n, b.px.data(), b.py.data(), b.pz.data(), b.height.data());
  }
}

// Null where the layer counts fully everywhere.
const float* layer_weights(const LayerJoin& join, Batch& b) {
  if (!join.locality && !join.mask) return nullptr;
  std::fill_n(b.weight.data(), b.n, 1.0f);
  if (join.mask) {
    join.mask->multiply(b.n, b.kept[static_cast<std::size_t>(join.mask->slot)].data(), b.weight.data());
  }
  if (join.locality) {
    join.locality->multiply(b.n, b.x.data(), b.y.data(), b.z.data(), b.weight.data());
  }
  return b.weight.data();
}

void displace(const Vec3d& direction, const float* weight, Batch& b) {
  if (!b.is_displaced) {
    b.is_displaced = true;
    for (auto* d : {&b.dx, &b.dy, &b.dz}) std::fill_n(d->data(), b.n, 0.0f);
  }
  const auto along = [&](double per_height, std::array<float, kBatch>& d) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(b.n); ++i) {
      const float height = weight == nullptr ? b.height[i] : weight[i] * b.height[i];
      d[i] = math::fma(static_cast<float>(per_height), height, d[i]);
    }
  };
  along(direction.x, b.dx);
  along(direction.y, b.dy);
  along(direction.z, b.dz);
}

template <typename Noise>
void apply_layer(const FieldModel& model, const Noise& noise, const LayerJoin& join, Batch& b) {
  layer_heights(model, noise, b);
  if (join.keeps >= 0) {
    std::copy_n(b.height.data(), b.n, b.kept[static_cast<std::size_t>(join.keeps)].data());
  }
  const float* weight = layer_weights(join, b);
  if (join.how.kind == Combine::kWarp) displace(join.how.direction, weight, b);
  if (join.changes_elevation()) join_elevation(join.how, b.n, weight, b.height.data(), b.elevation.data());
}

void apply_layer(const FieldModel& model, const CraterRelief& craters, const LayerJoin&, Batch& b) {
  project(model, b);
  craters.apply(b.n, b.px.data(), b.py.data(), b.pz.data(), b.elevation.data());
}

// The same points in coordinates local to an origin.
struct NearPoints {
  Vec3d origin;
  PointArrays local;
};

// Keeps the points whose F the heights may bring into the band and those that boulders reach, and where the
// metaballs were evaluated for them; returns how many, and where they were.
template <typename Reach>
int keep_near_surface(int n, float reach, const Reach& boulders_reach, const PointArrays& at,
                      const PointArrays& metaballs_at, const NearPoints* near, Batch& b,
                      std::array<int, kBatch>& origin) {
  int kept = 0;
  for (int i = 0; i < n; ++i) {
    const auto from = static_cast<std::size_t>(i), to = static_cast<std::size_t>(kept);
    if (std::fabs(b.distance[from]) > reach && !boulders_reach(i)) continue;
    b.x[to] = at.x[i], b.y[to] = at.y[i], b.z[to] = at.z[i];
    b.mx[to] = metaballs_at.x[i], b.my[to] = metaballs_at.y[i], b.mz[to] = metaballs_at.z[i];
    for (auto* a : {&b.distance, &b.gx, &b.gy, &b.gz}) (*a)[to] = (*a)[from];
    if (near != nullptr) {
      b.lx[to] = near->local.x[i], b.ly[to] = near->local.y[i], b.lz[to] = near->local.z[i];
    }
    origin[to] = i;
    ++kept;
  }
  return kept;
}

// Keeps the points whose F, as far as it is known, may still come within `reach` of 0, and those that
// boulders reach: fine layers are the dearest, and coarse ones have told by then where the surface is not.
// The others' F is left as known.
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
    for (auto* a : {&b.x, &b.y, &b.z, &b.mx, &b.my, &b.mz, &b.lx, &b.ly, &b.lz, &b.distance, &b.gx, &b.gy,
                    &b.gz, &b.elevation, &b.px, &b.py, &b.pz}) {
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

// s and grad L of the body near an origin; `metaballs_at` holds the points `at` displaced by the body's warp.
void evaluate_body_near(const PreparedMetaballs& metaballs, int n, const NearPoints& near,
                        const PointArrays& at, const PointArrays& metaballs_at, Batch& b) {
  const auto displaced = [n](const float* local, const float* from, const float* to, float* out) {
    for (int i = 0; i < n; ++i) out[i] = local[i] + (to[i] - from[i]);
  };
  displaced(near.local.x, at.x, metaballs_at.x, b.lx.data());
  displaced(near.local.y, at.y, metaballs_at.y, b.ly.data());
  displaced(near.local.z, at.z, metaballs_at.z, b.lz.data());
  evaluate_metaballs_near(metaballs, near.origin, n, b.lx.data(), b.ly.data(), b.lz.data(), b.distance.data(),
                          b.gx.data(), b.gy.data(), b.gz.data());
}

// What reaches the points of a block.
struct BlockParts {
  const DrawnSpots& spots;
  std::vector<std::uint32_t> boulders;
};

// Adds what the layers make of the surface, near to it and wherever boulders reach.
void add_elevations(const FieldModel& model, const BlockParts& parts, const PointArrays& at,
                    const PointArrays& metaballs_at, const NearPoints* near, float band, Batch& b,
                    float* value) {
  std::array<int, kBatch> origin;
  const float reach = height_reach(model) + band;
  const auto boulders_reach = [&](int i) {
    return model.boulders.reach(parts.boulders, at.x[i], at.y[i], at.z[i]);
  };
  b.n = keep_near_surface(b.n, reach, boulders_reach, at, metaballs_at, near, b, origin);
  if (b.n == 0) return;
  std::fill_n(b.elevation.data(), b.n, 0.0f);
  b.kept.resize(static_cast<std::size_t>(model.kept_heights));
  for (std::size_t i = 0; i < model.layers.size(); ++i) {
    keep_undecided(change_bound(model, i) + band, boulders_reach, b, origin, value);
    if (b.n == 0) return;
    b.spots = spots_of(parts.spots, i);
    const PlacedLayer& layer = model.layers[i];
    std::visit([&](const auto& l) { apply_layer(model, l, layer.join, b); }, layer.noise);
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(b.n); ++i) value[origin[i]] += b.elevation[i];
}

// How well F is asked for.
struct Accuracy {
  float band = kExactEverywhere;
  bool tetrahedra = false;
};

void evaluate_batch(const FieldModel& model, const PreparedBody& body, const DrawnSpots& spots, int n,
                    const PointArrays& at, const Accuracy& accuracy, float* value,
                    const NearPoints* near = nullptr) {
  float band = accuracy.band;
  Batch b;
  b.n = n;
  b.tetrahedra = accuracy.tetrahedra;
  PointArrays metaballs_at = at;
  if (model.warp) {
    model.warp->evaluate(n, at.x, at.y, at.z, b.mx.data(), b.my.data(), b.mz.data());
    metaballs_at = {b.mx.data(), b.my.data(), b.mz.data()};
    band *= static_cast<float>(model.warp->stretch());  // s changes so much faster than a distance does
  }
  if (!body.plain()) band *= model.stretch;
  if (near != nullptr) b.origin = &near->origin;
  if (near != nullptr && body.plain()) {
    evaluate_body_near(body.metaballs, n, *near, at, metaballs_at, b);
  } else {
    evaluate_body(body, n, metaballs_at.x, metaballs_at.y, metaballs_at.z, b.distance.data(), b.gx.data(),
                  b.gy.data(), b.gz.data());
  }
  std::copy_n(b.distance.data(), n, value);
  const BlockParts parts{spots, model.boulders.near(n, at.x, at.y, at.z)};
  if (!model.layers.empty()) add_elevations(model, parts, at, metaballs_at, near, band, b, value);
  model.boulders.join(parts.boulders, n, at.x, at.y, at.z, value);
}

}  // namespace

float height_reach(const FieldModel& model) { return static_cast<float>(model.height_bound * (1.0 + 1e-5)); }

float change_bound(const FieldModel& model, std::size_t first) {
  double bound = 0.0;
  for (std::size_t i = first; i < model.layers.size(); ++i) bound += model.layers[i].join.change_bound;
  return static_cast<float>(bound * (1.0 + 1e-5));
}

float value_at(const FieldModel& model, const Vec3d& p) {
  const float x = static_cast<float>(p.x), y = static_cast<float>(p.y), z = static_cast<float>(p.z);
  float f = 0.0f;
  evaluate_batch(model, model.body, {}, 1, {&x, &y, &z}, {}, &f);
  return f;
}

BlockContent FieldBlock::content() const { return content_of(*model_, body_, spots_, box_); }

BlockLists FieldBlock::lists() const {
  // Craters and Gabor noise are looked up where points are projected to.
  const Box at = body_box(*model_, box_);
  const Box projected = widened(at, model_->height_bound * (1.0 + 1e-5) + 2e-6 * largest_coordinate(at));
  BlockLists all;
  for (std::size_t i = 0; i < model_->layers.size(); ++i) {
    const HeightLayer& noise = model_->layers[i].noise;
    if (const auto* spots = std::get_if<SpotNoise>(&noise)) {
      const SpotImpulses* drawn = spots_of(spots_, i);
      for (auto& size : drawn != nullptr ? *drawn : spots->draw(layer_box(model_->layers[i], box_))) {
        all.spots.push_back(size);
      }
    } else if (const auto* gabor = std::get_if<GaborSurfaceNoise>(&noise)) {
      for (std::size_t b = 0; b < gabor->num_bands(); ++b) all.gabor.push_back(gabor->impulses(b, projected));
    } else if (const auto* craters = std::get_if<CraterRelief>(&noise)) {
      all.features.push_back(craters->reaching(projected));
    }
  }
  all.features.push_back(model_->boulders.empty() ? std::vector<std::uint32_t>()
                                                  : model_->boulders.reaching(box_));
  return all;
}

FieldBlock FieldBlock::restricted_to(const Box& child) const {
  return {*model_, body_reaching(body_, body_box(*model_, child)), spots_reaching(*model_, child, spots_),
          child};
}

namespace {

// Calls evaluate(first, count) for batches of n points.
template <typename Evaluate>
void for_each_batch(std::size_t n, const Evaluate& evaluate) {
  for (std::size_t begin = 0; begin < n; begin += kBatch)
    evaluate(begin, std::min<std::size_t>(kBatch, n - begin));
}

// The body's float coordinates of points near an origin.
struct BodyPoints {
  std::array<float, kBatch> x, y, z;

  BodyPoints(const NearPoints& near, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) {
      x[i] = static_cast<float>(near.origin.x + double{near.local.x[i]});
      y[i] = static_cast<float>(near.origin.y + double{near.local.y[i]});
      z[i] = static_cast<float>(near.origin.z + double{near.local.z[i]});
    }
  }
  PointArrays arrays() const { return {x.data(), y.data(), z.data()}; }
};

}  // namespace

void FieldBlock::evaluate(std::span<const float> x, std::span<const float> y, std::span<const float> z,
                          std::span<float> value, float band) const {
  for_each_batch(value.size(), [&](std::size_t i, std::size_t n) {
    evaluate_batch(*model_, body_, spots_, static_cast<int>(n), {&x[i], &y[i], &z[i]}, {band}, &value[i]);
  });
}

void FieldBlock::evaluate_tetrahedra(std::span<const float> x, std::span<const float> y,
                                     std::span<const float> z, std::span<float> value) const {
  for_each_batch(value.size(), [&](std::size_t i, std::size_t n) {
    evaluate_batch(*model_, body_, spots_, static_cast<int>(n), {&x[i], &y[i], &z[i]},
                   {kExactEverywhere, true}, &value[i]);
  });
}

void FieldBlock::evaluate_near(const Vec3d& origin, std::span<const float> x, std::span<const float> y,
                               std::span<const float> z, std::span<float> value, float band) const {
  for_each_batch(value.size(), [&](std::size_t i, std::size_t n) {
    const NearPoints near{origin, {&x[i], &y[i], &z[i]}};
    const BodyPoints at(near, n);
    evaluate_batch(*model_, body_, spots_, static_cast<int>(n), at.arrays(), {band}, &value[i], &near);
  });
}

void FieldBlock::evaluate_tetrahedra_near(const Vec3d& origin, std::span<const float> x,
                                          std::span<const float> y, std::span<const float> z,
                                          std::span<float> value) const {
  for_each_batch(value.size(), [&](std::size_t i, std::size_t n) {
    const NearPoints near{origin, {&x[i], &y[i], &z[i]}};
    const BodyPoints at(near, n);
    evaluate_batch(*model_, body_, spots_, static_cast<int>(n), at.arrays(), {kExactEverywhere, true},
                   &value[i], &near);
  });
}

ImplicitField::ImplicitField(const Recipe& recipe, const std::string& name) {
  if (!recipe.body || recipe.body->spheres.empty()) {
    throw InputError(name + ": body: is missing; give a body, or lay these layers on one");
  }
  FieldModel model;
  model.body = prepare_body(*recipe.body, recipe.seed);
  model.stretch = static_cast<float>(body_stretch(model.body));
  if (recipe.body->warp && model.body.plain()) {
    model.warp.emplace(*recipe.body->warp, body_warp_seed(recipe.seed, 0), support_bounds(model.body));
  }
  add_layers(recipe, name, model);
  model.bounds = surface_bounds(model);
  model_ = std::make_shared<const FieldModel>(std::move(model));
}

double ImplicitField::value(const Vec3d& p) const { return static_cast<double>(value_at(*model_, p)); }

Vec3d ImplicitField::gradient(const Vec3d& p) const {
  const bool bare = model_->layers.empty() && model_->boulders.empty() && !model_->warp;
  if (bare && model_->body.plain()) return distance_gradient(model_->body.metaballs, p);
  const double h = gradient_step();
  const auto slope = [&](const Vec3d& d) { return (value(p + d) - value(p - d)) / (2.0 * h); };
  return {slope({h, 0, 0}), slope({0, h, 0}), slope({0, 0, h})};
}

double ImplicitField::gradient_step() const {
  const Vec3d e = model_->bounds.empty() ? Vec3d{1, 1, 1} : model_->bounds.extent();
  return std::max({e.x, e.y, e.z}) * 0x1p-11;
}

Box ImplicitField::bounds() const { return model_->bounds; }

bool ImplicitField::has_near_form() const { return model_->body.plain(); }

double ImplicitField::height_bound() const { return model_->height_bound; }

std::span<const LayerCraters> ImplicitField::craters() const { return model_->craters; }

std::span<const LayerBoulders> ImplicitField::boulders() const { return model_->placed_boulders; }

FieldBlock ImplicitField::gather(const Box& box) const {
  return {*model_, body_reaching(model_->body, body_box(*model_, box)), spots_reaching(*model_, box, {}),
          box};
}

}  // namespace astrolith
