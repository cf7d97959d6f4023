#include "synthesis/field/field_batch_internal.h"

#include <algorithm>

#include "synthesis/body/surface_projection.h"

namespace astrolith {
namespace {

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

}  // namespace

void apply_layer(const FieldModel& model, const PlacedLayer& layer, Batch& b) {
  std::visit([&](const auto& noise) { apply_layer(model, noise, layer.join, b); }, layer.noise);
}

}  // namespace astrolith
