#include "synthesis/field/implicit_field.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "numerics/errors.h"
#include "synthesis/field/field_batch_internal.h"

namespace astrolith {
static_assert(BlockField<ImplicitField>);

BlockContent FieldBlock::content() const { return content_of(*model_, body_, spots_, box_); }

BlockLists FieldBlock::lists() const {
  // Craters and Gabor noise are looked up where points are projected to.
  const Box at = body_box(*model_, box_);
  const Box projected = farthest_projected_box(at, model_->height_bound);
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
      all.landforms.push_back(craters->reaching(projected));
    }
  }
  all.landforms.push_back(model_->boulders.empty() ? std::vector<std::uint32_t>()
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
  model.lipschitz_bound = static_cast<float>(lipschitz_bound_of(model.body));
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
