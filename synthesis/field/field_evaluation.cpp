#include <algorithm>
#include <cmath>

#include "synthesis/body/metaballs_near.h"
#include "synthesis/field/field_batch_internal.h"

namespace astrolith {
namespace {

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
    apply_layer(model, model.layers[i], b);
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(b.n); ++i) value[origin[i]] += b.elevation[i];
}

}  // namespace

void evaluate_batch(const FieldModel& model, const PreparedBody& body, const DrawnSpots& spots, int n,
                    const PointArrays& at, const Accuracy& accuracy, float* value, const NearPoints* near) {
  float band = accuracy.band;
  Batch b;
  b.n = n;
  b.tetrahedra = accuracy.tetrahedra;
  PointArrays metaballs_at = at;
  if (model.warp) {
    model.warp->evaluate(n, at.x, at.y, at.z, b.mx.data(), b.my.data(), b.mz.data());
    metaballs_at = {b.mx.data(), b.my.data(), b.mz.data()};
    band *=
        static_cast<float>(model.warp->lipschitz_bound());  // s changes so much faster than a distance does
  }
  if (!body.plain()) band *= model.lipschitz_bound;
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

}  // namespace astrolith
