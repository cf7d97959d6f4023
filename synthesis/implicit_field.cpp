#include "synthesis/implicit_field.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "synthesis/field_model_internal.h"

namespace astrolith {
static_assert(BlockField<ImplicitField>);

namespace {

// Points evaluated together: a block of 9^3 samples and some, on the stack.
constexpr int kBatch = 1024;

constexpr std::uint32_t kBodyStream = 0xffffffffu;  // of the recipe's seed; layers have their numbers

// Points, where the metaballs are evaluated for them, s and grad L there, and a layer's heights.
struct Batch {
  int n = 0;
  std::array<float, kBatch> x, y, z, mx, my, mz, distance, gx, gy, gz, height;
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
  noise.evaluate(b.n, b.x.data(), b.y.data(), b.z.data(), b.height.data());
}

void layer_heights(const FieldModel&, const SpotNoise& noise, Batch& b) {
  noise.evaluate(b.n, b.x.data(), b.y.data(), b.z.data(), b.height.data());
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
  along(b.mx, b.gx, projected);
  along(b.my, b.gy, projected + kBatch);
  along(b.mz, b.gz, projected + 2 * kBatch);
  noise.evaluate(model.metaballs, b.n, projected, projected + kBatch, projected + 2 * kBatch,
                 b.height.data());
}

struct PointArrays {
  const float *x, *y, *z;
};

// Keeps the points whose F the heights may bring into the band, and where the metaballs were evaluated for
// them; returns how many, and where they were.
int keep_near_surface(int n, float reach, const PointArrays& at, const PointArrays& metaballs_at, Batch& b,
                      std::array<int, kBatch>& origin) {
  int kept = 0;
  for (int i = 0; i < n; ++i) {
    const auto from = static_cast<std::size_t>(i), to = static_cast<std::size_t>(kept);
    if (std::fabs(b.distance[from]) > reach) continue;
    b.x[to] = at.x[i], b.y[to] = at.y[i], b.z[to] = at.z[i];
    b.mx[to] = metaballs_at.x[i], b.my[to] = metaballs_at.y[i], b.mz[to] = metaballs_at.z[i];
    for (auto* a : {&b.distance, &b.gx, &b.gy, &b.gz}) (*a)[to] = (*a)[from];
    origin[to] = i;
    ++kept;
  }
  return kept;
}

void evaluate_batch(const FieldModel& model, const PreparedMetaballs& metaballs, int n, const PointArrays& at,
                    float band, float* value) {
  Batch b;
  PointArrays metaballs_at = at;
  if (model.warp) {
    model.warp->evaluate(n, at.x, at.y, at.z, b.mx.data(), b.my.data(), b.mz.data());
    metaballs_at = {b.mx.data(), b.my.data(), b.mz.data()};
    band *= static_cast<float>(model.warp->stretch());  // s changes so much faster than a distance does
  }
  evaluate_metaballs(metaballs, n, metaballs_at.x, metaballs_at.y, metaballs_at.z, b.distance.data(),
                     b.gx.data(), b.gy.data(), b.gz.data());
  std::copy_n(b.distance.data(), n, value);
  if (model.layers.empty()) return;
  std::array<int, kBatch> origin;
  const float reach = static_cast<float>(model.height_bound * (1.0 + 1e-5)) + band;
  b.n = keep_near_surface(n, reach, at, metaballs_at, b, origin);
  if (b.n == 0) return;
  for (const HeightLayer& layer : model.layers) {
    std::visit([&](const auto& noise) { layer_heights(model, noise, b); }, layer);
    for (std::size_t i = 0; i < static_cast<std::size_t>(b.n); ++i) value[origin[i]] += b.height[i];
  }
}

// Layers' coordinates are kept within the supports of the body's kernels, outside of which no surface is.
std::vector<HeightLayer> prepare_layers(const Recipe& recipe, const FieldModel& model) {
  const Box supports = support_bounds(model.metaballs);
  const Box domain = model.warp ? widened(supports, model.warp->bound()) : supports;
  std::vector<HeightLayer> layers;
  for (std::size_t i = 0; i < recipe.layers.size(); ++i) {
    if (const auto* fractal = std::get_if<FractalLayer>(&recipe.layers[i])) {
      layers.emplace_back(FractalNoise(*fractal, recipe.seed, static_cast<int>(i), domain));
    } else if (const auto* spots = std::get_if<SpotLayer>(&recipe.layers[i])) {
      layers.emplace_back(SpotNoise(*spots, recipe.seed, static_cast<int>(i), domain));
    } else if (const auto* gabor = std::get_if<GaborLayer>(&recipe.layers[i])) {
      // A layer of colour alone has no height.
      if (gabor->height_rms > 0.0) {
        layers.emplace_back(GaborSurfaceNoise(*gabor, recipe.seed, static_cast<int>(i), supports));
      }
    }
  }
  return layers;
}

}  // namespace

BlockContent FieldBlock::content() const { return content_of(*model_, metaballs_, box_); }

FieldBlock FieldBlock::restricted_to(const Box& child) const {
  return {*model_, metaballs_reaching(metaballs_, metaball_box(*model_, child)), child};
}

void FieldBlock::evaluate(std::span<const float> x, std::span<const float> y, std::span<const float> z,
                          std::span<float> value, float band) const {
  for (std::size_t begin = 0; begin < value.size(); begin += kBatch) {
    const int n = static_cast<int>(std::min<std::size_t>(kBatch, value.size() - begin));
    evaluate_batch(*model_, metaballs_, n, {&x[begin], &y[begin], &z[begin]}, band, &value[begin]);
  }
}

ImplicitField::ImplicitField(const Recipe& recipe) {
  if (!recipe.body || recipe.body->spheres.empty()) {
    throw InputError("recipe: body: is missing; give a body, or lay these layers on one");
  }
  FieldModel model;
  model.metaballs = prepare_metaballs(*recipe.body);
  if (recipe.body->warp) {
    model.warp.emplace(*recipe.body->warp, hash_seed(recipe.seed, kBodyStream),
                       support_bounds(model.metaballs));
  }
  model.layers = prepare_layers(recipe, model);
  for (const HeightLayer& layer : model.layers) {
    model.height_bound += std::visit([](const auto& l) { return l.height_bound(); }, layer);
  }
  model.bounds = surface_bounds(model);
  model_ = std::make_shared<const FieldModel>(std::move(model));
}

double ImplicitField::value(const Vec3d& p) const {
  const float x = static_cast<float>(p.x), y = static_cast<float>(p.y), z = static_cast<float>(p.z);
  float f = 0.0f;
  evaluate_batch(*model_, model_->metaballs, 1, {&x, &y, &z}, kExactEverywhere, &f);
  return static_cast<double>(f);
}

Vec3d ImplicitField::gradient(const Vec3d& p) const {
  if (model_->layers.empty() && !model_->warp) return distance_gradient(model_->metaballs, p);
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
  return {*model_, metaballs_reaching(model_->metaballs, metaball_box(*model_, box)), box};
}

}  // namespace astrolith
