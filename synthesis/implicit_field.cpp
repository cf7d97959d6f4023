#include "synthesis/implicit_field.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "numerics/errors.h"
#include "synthesis/field_model_internal.h"

namespace astrolith {
static_assert(BlockField<ImplicitField>);

namespace {

// Points evaluated together: a block of 9^3 samples and some, on the stack.
constexpr int kBatch = 1024;

// Points, s and grad L there, and a layer's heights.
struct Batch {
  int n = 0;
  std::array<float, kBatch> x, y, z, distance, gx, gy, gz, height;
  std::array<float, 3 * kBatch> scratch;
};

// First-order projection on the base surface, p0 = p - s g/|g|, so that heights are constant along the
// normal. Steps end at `longest_step`: no point of the surface is farther from the base than that.
ASTROLITH_SIMD_CLONES void project(int n, const float* __restrict p, const float* __restrict gradient,
                                   const float* __restrict divisor, const float* __restrict distance,
                                   float longest_step, float* __restrict projected) {
#pragma omp simd
  for (int i = 0; i < n; ++i) {
    const float step = math::clamp(distance[i], -longest_step, longest_step);
    projected[i] = math::fma(-step, gradient[i] / divisor[i], p[i]);
  }
}

ASTROLITH_SIMD_CLONES void gradient_lengths(int n, const float* __restrict gx, const float* __restrict gy,
                                            const float* __restrict gz, float floor,
                                            float* __restrict length) {
#pragma omp simd
  for (int i = 0; i < n; ++i) {
    length[i] = math::sqrt(math::fma(gx[i], gx[i], math::fma(gy[i], gy[i], gz[i] * gz[i])) + floor);
  }
}

void layer_heights(const FieldModel&, const FractalNoise& noise, Batch& b) {
  noise.evaluate(b.n, b.x.data(), b.y.data(), b.z.data(), b.height.data(), b.scratch.data());
}

void layer_heights(const FieldModel& model, const GaborSurfaceNoise& noise, Batch& b) {
  // `height` holds the gradient's length until the heights replace it.
  gradient_lengths(b.n, b.gx.data(), b.gy.data(), b.gz.data(), model.metaballs.parameters.gradient_floor,
                   b.height.data());
  const float longest_step = static_cast<float>(model.height_bound);
  float* const projected = b.scratch.data();
  const auto along = [&](const std::array<float, kBatch>& p, const std::array<float, kBatch>& g, float* out) {
    project(b.n, p.data(), g.data(), b.height.data(), b.distance.data(), longest_step, out);
  };
  along(b.x, b.gx, projected);
  along(b.y, b.gy, projected + kBatch);
  along(b.z, b.gz, projected + 2 * kBatch);
  noise.evaluate(model.metaballs, b.n, projected, projected + kBatch, projected + 2 * kBatch,
                 b.height.data());
}

// Keeps the points whose F the heights may bring into the band; returns where they were.
int keep_near_surface(float reach, Batch& b, std::array<int, kBatch>& origin) {
  int kept = 0;
  for (int i = 0; i < b.n; ++i) {
    const auto from = static_cast<std::size_t>(i), to = static_cast<std::size_t>(kept);
    if (std::fabs(b.distance[from]) > reach) continue;
    for (auto* a : {&b.x, &b.y, &b.z, &b.distance, &b.gx, &b.gy, &b.gz}) (*a)[to] = (*a)[from];
    origin[to] = i;
    ++kept;
  }
  return kept;
}

void evaluate_batch(const FieldModel& model, const PreparedMetaballs& metaballs, int n, const float* x,
                    const float* y, const float* z, float band, float* value) {
  Batch b;
  std::copy_n(x, n, b.x.data());
  std::copy_n(y, n, b.y.data());
  std::copy_n(z, n, b.z.data());
  evaluate_metaballs(metaballs, n, x, y, z, b.distance.data(), b.gx.data(), b.gy.data(), b.gz.data());
  std::copy_n(b.distance.data(), n, value);
  if (model.layers.empty()) return;
  std::array<int, kBatch> origin;
  b.n = n;
  b.n = keep_near_surface(static_cast<float>(model.height_bound * (1.0 + 1e-5)) + band, b, origin);
  if (b.n == 0) return;
  for (const HeightLayer& layer : model.layers) {
    std::visit([&](const auto& noise) { layer_heights(model, noise, b); }, layer);
    for (std::size_t i = 0; i < static_cast<std::size_t>(b.n); ++i) value[origin[i]] += b.height[i];
  }
}

// Whether F keeps one sign over the box: F has the sign of L - log T + height * divisor.
BlockContent content_of(const PreparedMetaballs& metaballs, double height_bound, const Box& box) {
  const MetaballInterval bound = bound_metaballs(metaballs, box);
  const double margin = height_bound * bound.gradient_max * (1.0 + 1e-5);
  if (bound.level_max < -margin) return BlockContent::kOutside;
  if (bound.level_min > margin) return BlockContent::kInside;
  return BlockContent::kMixed;
}

std::array<Box, 8> octants(const Box& box) {
  const Vec3d c = box.center();
  std::array<Box, 8> children;
  for (unsigned k = 0; k < 8; ++k) {
    Box& child = children[k];
    child.min = {k & 1 ? c.x : box.min.x, k & 2 ? c.y : box.min.y, k & 4 ? c.z : box.min.z};
    child.max = {k & 1 ? box.max.x : c.x, k & 2 ? box.max.y : c.y, k & 4 ? box.max.z : c.z};
  }
  return children;
}

bool within(const Box& inner, const Box& outer) {
  return inner.min.x >= outer.min.x && inner.min.y >= outer.min.y && inner.min.z >= outer.min.z &&
         inner.max.x <= outer.max.x && inner.max.y <= outer.max.y && inner.max.z <= outer.max.z;
}

// Extends `bounds` by the smallest boxes of an octree that are not proved empty.
void extend_bounds(const PreparedMetaballs& metaballs, double height_bound, const Box& box, int depth,
                   Box& bounds) {
  if (!bounds.empty() && within(box, bounds)) return;
  const PreparedMetaballs reaching = metaballs_reaching(metaballs, box);
  const BlockContent content = content_of(reaching, height_bound, box);
  if (content == BlockContent::kOutside) return;
  if (depth == 0 || content == BlockContent::kInside) {
    bounds.extend(box.min);
    bounds.extend(box.max);
    return;
  }
  for (const Box& child : octants(box)) extend_bounds(reaching, height_bound, child, depth - 1, bounds);
}

// Repeated on what is left until that stops shrinking much, because supports reach far beyond the surface.
Box surface_bounds(const PreparedMetaballs& metaballs, double height_bound) {
  constexpr int kDepth = 6;
  Box box = support_bounds(metaballs);
  for (int pass = 0; pass < 4; ++pass) {
    Box tighter;
    extend_bounds(metaballs, height_bound, box, kDepth, tighter);
    if (tighter.empty()) return tighter;
    const bool shrunk = norm(tighter.extent()) < 0.7 * norm(box.extent());
    box = tighter;
    if (!shrunk) break;
  }
  return box;
}

// Layers' coordinates are kept within the supports of the body's kernels, outside of which no surface is.
std::vector<HeightLayer> prepare_layers(const Recipe& recipe, const Box& domain) {
  std::vector<HeightLayer> layers;
  for (std::size_t i = 0; i < recipe.layers.size(); ++i) {
    if (const auto* fractal = std::get_if<FractalLayer>(&recipe.layers[i])) {
      layers.emplace_back(FractalNoise(*fractal, recipe.seed, static_cast<int>(i), domain));
    } else if (const auto* gabor = std::get_if<GaborLayer>(&recipe.layers[i])) {
      // A layer of colour alone has no height.
      if (gabor->height_rms > 0.0) {
        layers.emplace_back(GaborSurfaceNoise(*gabor, recipe.seed, static_cast<int>(i), domain));
      }
    }
  }
  return layers;
}

}  // namespace

BlockContent FieldBlock::content() const { return content_of(metaballs_, model_->height_bound, box_); }

FieldBlock FieldBlock::restricted_to(const Box& child) const {
  return {*model_, metaballs_reaching(metaballs_, child), child};
}

void FieldBlock::evaluate(std::span<const float> x, std::span<const float> y, std::span<const float> z,
                          std::span<float> value, float band) const {
  for (std::size_t begin = 0; begin < value.size(); begin += kBatch) {
    const int n = static_cast<int>(std::min<std::size_t>(kBatch, value.size() - begin));
    evaluate_batch(*model_, metaballs_, n, &x[begin], &y[begin], &z[begin], band, &value[begin]);
  }
}

ImplicitField::ImplicitField(const Recipe& recipe) {
  if (!recipe.body || recipe.body->spheres.empty()) {
    throw InputError("recipe: body: is missing; give a body, or lay these layers on one");
  }
  FieldModel model;
  model.metaballs = prepare_metaballs(*recipe.body);
  model.layers = prepare_layers(recipe, support_bounds(model.metaballs));
  for (const HeightLayer& layer : model.layers) {
    model.height_bound += std::visit([](const auto& l) { return l.height_bound(); }, layer);
  }
  model.bounds = surface_bounds(model.metaballs, model.height_bound);
  model_ = std::make_shared<const FieldModel>(std::move(model));
}

double ImplicitField::value(const Vec3d& p) const {
  const float x = static_cast<float>(p.x), y = static_cast<float>(p.y), z = static_cast<float>(p.z);
  float f = 0.0f;
  evaluate_batch(*model_, model_->metaballs, 1, &x, &y, &z, kExactEverywhere, &f);
  return static_cast<double>(f);
}

Vec3d ImplicitField::gradient(const Vec3d& p) const {
  if (model_->layers.empty()) return distance_gradient(model_->metaballs, p);
  const double h = gradient_step();
  const auto slope = [&](const Vec3d& d) { return (value(p + d) - value(p - d)) / (2.0 * h); };
  return {slope({h, 0, 0}), slope({0, h, 0}), slope({0, 0, h})};
}

double ImplicitField::gradient_step() const {
  const Vec3d e = model_->bounds.empty() ? Vec3d{1, 1, 1} : model_->bounds.extent();
  return std::max({e.x, e.y, e.z}) * 0x1p-11;
}

Box ImplicitField::bounds() const { return model_->bounds; }

double ImplicitField::height_bound() const { return model_->height_bound; }

FieldBlock ImplicitField::gather(const Box& box) const {
  return {*model_, metaballs_reaching(model_->metaballs, box), box};
}

}  // namespace astrolith
