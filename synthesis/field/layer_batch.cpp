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

void find_gradient_lengths(const FieldModel& model, const Batch& b, std::array<float, kBatch>& length) {
  const BatchPoints& g = b.gradient;
  gradient_lengths(b.n, g.x.data(), g.y.data(), g.z.data(), model.tables.leaf(0).metaballs.gradient_floor,
                   length.data());
}

// Finds the projections of the points on the bare surface, if they are not there.
void project(const FieldModel& model, const Batch& b, BatchFrame& frame) {
  if (frame.is_projected) return;
  frame.is_projected = true;
  std::array<float, kBatch> length;
  find_gradient_lengths(model, b, length);
  const float longest_step = static_cast<float>(model.height_bound);
  const auto along = [&](std::array<float, kBatch> BatchPoints::*axis) {
    project(b.n, (frame.mapped.*axis).data(), (b.gradient.*axis).data(), length.data(), b.distance.data(),
            longest_step, (frame.feet.*axis).data());
  };
  along(&BatchPoints::x);
  along(&BatchPoints::y);
  along(&BatchPoints::z);
}

ASTROLITH_SIMD_CLONES void lift_coordinates(int n, const float* __restrict projected,
                                            const float* __restrict gradient, const float* __restrict divisor,
                                            const float* __restrict elevation, float* __restrict lifted) {
#pragma omp simd
  for (int i = 0; i < n; ++i) {
    lifted[i] = lifted_coordinate(projected[i], gradient[i], divisor[i], elevation[i]);
  }
}

// The points of a frame, displaced by the layers so far that warp later layers.
PointArrays displaced(Batch& b, const BatchFrame& frame) {
  if (!b.is_displaced) return frame.at.arrays();
  for (std::size_t i = 0; i < static_cast<std::size_t>(b.n); ++i) {
    b.displaced.x[i] = frame.at.x[i] + b.displacement.x[i];
    b.displaced.y[i] = frame.at.y[i] + b.displacement.y[i];
    b.displaced.z[i] = frame.at.z[i] + b.displacement.z[i];
  }
  return b.displaced.arrays();
}

// Projections, lifted to the surface that the layers so far make. Uses the arrays of displaced coordinates.
PointArrays lifted(const FieldModel& model, const BatchFrame& frame, Batch& b) {
  std::array<float, kBatch> length;
  find_gradient_lengths(model, b, length);
  const auto along = [&](std::array<float, kBatch> BatchPoints::*axis) {
    lift_coordinates(b.n, (frame.feet.*axis).data(), (b.gradient.*axis).data(), length.data(),
                     b.elevation.data(), (b.displaced.*axis).data());
  };
  along(&BatchPoints::x);
  along(&BatchPoints::y);
  along(&BatchPoints::z);
  return b.displaced.arrays();
}

// Where a noise is evaluated for the points, in the frame of local coordinates if `in_patch`.
template <class Noise>
PointArrays noise_points(const FieldModel& model, const Noise& noise, bool in_patch, Batch& b) {
  BatchFrame& frame = in_patch ? b.local : b.body;
  if constexpr (Noise::kTraits.on_surface) {
    project(model, b, frame);
    if constexpr (Noise::kTraits.lifts) {
      if (noise.lifted) return lifted(model, frame, b);
    }
    return frame.feet.arrays();
  } else {
    return displaced(b, frame);
  }
}

// Visits a layer's noise: evaluates its heights at the points of a batch. Kinds without heights are skipped.
struct LayerHeights {
  const FieldModel& model;
  const FieldLayer& layer;
  Batch& b;
  bool in_patch;  // whether the noise is that in the frame of the field's patch

  template <class Noise>
  void operator()(const Noise& noise) const {
    if constexpr (Noise::kTraits.has_heights) {
      if constexpr (Noise::kTraits.local_form) {
        if (!in_patch && b.origin != nullptr && noise.has_local_form()) return evaluate_locally(noise);
      }
      evaluate(noise, noise_points(model, noise, in_patch, b));
    }
  }

 private:
  const ArrayView& arrays() const { return model.tables.arrays; }
  template <class Noise>
  void evaluate_locally(const Noise& noise) const {
    const PointArrays p = displaced(b, b.local);
    evaluate_local_heights(noise, arrays(), *b.origin, b.n, p.x, p.y, p.z, b.height.data());
  }
  template <class Noise>
  void evaluate(const Noise& noise, const PointArrays& p) const {
    if constexpr (Noise::kTraits.lists == NoiseLists::kGabor) {
      evaluate_gabor(noise, p);
    } else if constexpr (Noise::kTraits.lists == NoiseLists::kSpots) {
      evaluate_heights(noise, arrays(), b.n, p.x, p.y, p.z, b.height.data(), b.spots);
    } else {
      static_assert(Noise::kTraits.lists == NoiseLists::kNone);
      evaluate_heights(noise, arrays(), b.n, p.x, p.y, p.z, b.height.data());
    }
  }
  template <class GaborNoise>
  void evaluate_gabor(const GaborNoise& noise, const PointArrays& p) const {
    BodyGround ground{model.body, arrays(), model.metaballs.lists()};
    if (in_patch) ground.origin = b.origin;
    const GaborBrickCache* caches = in_patch
                                        ? model.patch_caches[static_cast<std::size_t>(layer.in_patch)].data()
                                        : model.gabor_caches.data() + layer.first_list;
    if (b.tetrahedra) {
      evaluate_tetrahedron_heights(noise, ground, caches, b.n, p.x, p.y, p.z, b.height.data());
    } else {
      evaluate_heights(noise, ground, caches, b.n, p.x, p.y, p.z, b.height.data());
    }
  }
};

// The weights of a layer at the points; null where the layer has weight 1 everywhere.
const float* layer_weights(const FieldModel& model, const LayerJoin& join, Batch& b) {
  if (!join.weighted()) return nullptr;
  std::fill_n(b.weight.data(), b.n, 1.0f);
  if (join.mask >= 0) {
    multiply_by_mask(join, b.n, b.kept[static_cast<std::size_t>(join.mask)].data(), b.weight.data());
  }
  if (join.local) {
    multiply_by_weight(join.locality, model.tables.arrays, b.n, b.body.at.x.data(), b.body.at.y.data(),
                       b.body.at.z.data(), b.weight.data());
  }
  return b.weight.data();
}

void displace(const Vec3d& direction, const float* weight, Batch& b) {
  if (!b.is_displaced) {
    b.is_displaced = true;
    for (auto* d : {&b.displacement.x, &b.displacement.y, &b.displacement.z})
      std::fill_n(d->data(), b.n, 0.0f);
  }
  const auto along = [&](double per_height, std::array<float, kBatch>& d) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(b.n); ++i) {
      const float height = weight == nullptr ? b.height[i] : weight[i] * b.height[i];
      d[i] = math::fma(static_cast<float>(per_height), height, d[i]);
    }
  };
  along(direction.x, b.displacement.x);
  along(direction.y, b.displacement.y);
  along(direction.z, b.displacement.z);
}

void join_heights(const FieldModel& model, const LayerJoin& join, Batch& b) {
  if (join.keeps >= 0) {
    std::copy_n(b.height.data(), b.n, b.kept[static_cast<std::size_t>(join.keeps)].data());
  }
  const float* weight = layer_weights(model, join, b);
  if (join.how.kind == Combine::kWarp) displace(join.how.direction, weight, b);
  if (join.changes_elevation()) join_elevations(join.how, b.n, weight, b.height.data(), b.elevation.data());
}

// Whether the noise of a layer is that in the frame of the field's patch.
bool stands_in_patch(const FieldLayer& layer, const Batch& b) {
  return b.origin != nullptr && layer.in_patch >= 0;
}

// The craters of a layer in the frame of the field's patch; null where they are evaluated in the body's.
const PatchCraters* craters_in_patch(const FieldModel& model, const CraterRelief& relief, const Batch& b) {
  if (b.origin == nullptr || relief.list >= model.patch_craters.size()) return nullptr;
  const std::optional<PatchCraters>& local = model.patch_craters[relief.list];
  return local ? &*local : nullptr;
}

void change_elevation(const FieldModel& model, const CraterRelief& relief, Batch& b) {
  const PatchCraters* local = craters_in_patch(model, relief, b);
  const PointArrays p = noise_points(model, relief, local != nullptr, b);
  apply_craters(local ? local->relief : relief, model.tables.arrays,
                local ? local->tree : model.crater_trees[relief.list], b.n, p.x, p.y, p.z,
                b.elevation.data());
}

// Writes what a layer paints at the points of a batch.
void evaluate_colors(const FieldModel& model, const FieldLayer& layer, const LayerPaint& paint, Batch& b,
                     Vec3f* color) {
  std::fill_n(color, b.n, paint.mean);
  const bool in_patch = stands_in_patch(layer, b);
  ExemplarNoise noise = *(in_patch ? find_noise(model, layer) : layer.noise).get_if<ExemplarNoise>();
  if (noise.lattice.anchors.count == 0) return;
  const PointArrays p = noise_points(model, noise, in_patch, b);
  const ExemplarAnchor* anchors = model.tables.arrays[noise.lattice.anchors];
  for (const PaintChannel& channel : paint.channels) {
    noise.texture = channel.texture;
    evaluate_heights(noise, paint.arrays, anchors, b.n, p.x, p.y, p.z, b.height.data());
    const Vec3f& axis = channel.axis;
    for (std::size_t i = 0; i < static_cast<std::size_t>(b.n); ++i) {
      color[i] = {math::fma(axis.x, b.height[i], color[i].x), math::fma(axis.y, b.height[i], color[i].y),
                  math::fma(axis.z, b.height[i], color[i].z)};
    }
  }
}

}  // namespace

namespace {

// Covers a share of the ground at a point, with the tone that it had.
void cover(const Vec3f& color, float share, PaintedPoint& point) {
  const auto blend = [share](float below, float above) {
    return math::fma(share, above, (1.0f - share) * below);
  };
  point.color = {blend(point.color.x, color.x), blend(point.color.y, color.y), blend(point.color.z, color.z)};
  point.tone *= 1.0f - share;
}

}  // namespace

void paint_layer(const FieldModel& model, const FieldLayer& layer, const LayerPaint& paint, Batch& b,
                 PaintedPoint* points) {
  std::array<Vec3f, kBatch> painted;
  evaluate_colors(model, layer, paint, b, painted.data());
  const float* weight = layer_weights(model, layer.join, b);
  for (std::size_t i = 0; i < static_cast<std::size_t>(b.n); ++i)
    cover(painted[i], weight == nullptr ? 1.0f : weight[i], points[i]);
}

void paint_layer(const FieldModel& model, const FieldLayer& layer, const NoiseTone& tone, Batch& b,
                 PaintedPoint* points) {
  if (tone.per_height != 0.0f) evaluate_layer(model, layer, b);
  const float* weight = layer_weights(model, layer.join, b);
  for (std::size_t i = 0; i < static_cast<std::size_t>(b.n); ++i) {
    const float w = weight == nullptr ? 1.0f : weight[i];
    if (tone.covers) cover(tone.color, w, points[i]);
    if (tone.per_height == 0.0f) continue;
    const float gain = w * tone.per_height * b.height[i];
    points[i].tone += Vec3f{gain, gain, gain};
  }
}

void paint_layer(const FieldModel& model, const FieldLayer& layer, const CraterTone& tone, Batch& b,
                 PaintedPoint* points) {
  const CraterRelief& relief = *layer.noise.get_if<CraterRelief>();
  const PatchCraters* local = craters_in_patch(model, relief, b);
  const PointArrays p = noise_points(model, relief, local != nullptr, b);
  const BoxTree& tree = local ? local->tree : model.crater_trees[relief.list];
  const CraterKernel* craters = model.tables.arrays[(local ? local->relief : relief).craters];
  for (std::size_t i = 0; i < static_cast<std::size_t>(b.n); ++i) {
    float share = 0.0f;
    const Vec3d at{double{p.x[i]}, double{p.y[i]}, double{p.z[i]}};
    for (const std::uint32_t k : tree.touching({at, at})) {
      const CraterKernel& c = craters[k];
      const float squared = crater_distance_squared(c, p.x[i], p.y[i], p.z[i]);
      if (!(squared < c.extent_squared)) continue;
      const float out = squared < 1.0f ? 1.0f : (c.extent - math::sqrt(squared)) * c.inverse_flank_width;
      share = math::fma(out * out, tone.freshness[k], (1.0f - out * out) * share);
    }
    points[i].tone += share * tone.fresh;
  }
}

void apply_layer(const FieldModel& model, const FieldLayer& layer, Batch& b) {
  layer.noise.visit([&]<class Noise>(const Noise& noise) {
    if constexpr (Noise::kTraits.has_heights) {
      if (layer.join.idle()) return;
      evaluate_layer(model, layer, b);
      join_heights(model, layer.join, b);
    } else {
      change_elevation(model, noise, b);
    }
  });
}

void evaluate_layer(const FieldModel& model, const FieldLayer& layer, Batch& b) {
  const bool in_patch = stands_in_patch(layer, b);
  (in_patch ? find_noise(model, layer) : layer.noise).visit(LayerHeights{model, layer, b, in_patch});
}

}  // namespace astrolith
