#include "synthesis/field/implicit_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "numerics/errors.h"
#include "synthesis/body/body_tables.h"
#include "synthesis/field/field_batch_internal.h"
#include "synthesis/field/patch_place.h"

namespace astrolith {
static_assert(BlockField<ImplicitField>);

BlockContent FieldBlock::content() const { return block_content(*model_, metaballs_, spots_, box_); }

FieldBlock FieldBlock::restricted_to(const Box& child) const {
  const FieldView& f = model_->tables;
  return {*model_,
          metaballs_reaching(f.body, f.arrays, metaballs_.lists(), body_box(f.body, f.arrays, child)),
          spots_reaching(*model_, child, spots_), child};
}

double FieldBlock::list_bytes() const {
  std::size_t bytes = metaballs_.spheres.capacity() * sizeof(MetaballSphere<float>) +
                      metaballs_.first.capacity() * sizeof(std::uint32_t) +
                      spots_.capacity() * sizeof(DrawnSpots::value_type);
  for (const auto& layer : spots_) {
    if (layer == nullptr) continue;
    for (const std::vector<SpotImpulse>& impulses : *layer) {
      bytes += sizeof(std::vector<SpotImpulse>) + impulses.capacity() * sizeof(SpotImpulse);
    }
  }
  return static_cast<double>(bytes);
}

namespace {

// Points given in coordinates local to an origin, as float coordinates of the body's frame.
BatchPoints in_body(const LocalPoints& points, std::size_t n) {
  BatchPoints at;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3f p = rounded_in_body(points.origin, {points.local.x[i], points.local.y[i], points.local.z[i]});
    at.x[i] = p.x, at.y[i] = p.y, at.z[i] = p.z;
  }
  return at;
}

// A field for a patch holds its fine layers relative to the centre of the patch.
void check_origin(const FieldModel& model, const Vec3d& origin) {
  if (!model.patch) return;
  const Vec3d& center = model.patch->center;
  if (origin.x != center.x || origin.y != center.y || origin.z != center.z) {
    throw std::invalid_argument("FieldBlock: the origin is not the centre of the patch of the field");
  }
}

}  // namespace

// Calls use(first, n, lists, at, local) for the points in batches: n of them from `first` on, in the body's
// frame and, with an origin, local to it.
template <class Use>
void FieldBlock::for_each_batch(const Vec3d* origin, std::size_t count, std::span<const float> x,
                                std::span<const float> y, std::span<const float> z, const Use& use) const {
  if (origin != nullptr) check_origin(*model_, *origin);
  const BatchLists lists{metaballs_.lists(), spots_};
  for (std::size_t i = 0; i < count; i += kBatch) {
    const std::size_t n = std::min<std::size_t>(kBatch, count - i);
    const PointArrays given{&x[i], &y[i], &z[i]};
    if (origin == nullptr) {
      use(i, static_cast<int>(n), lists, given, nullptr);
    } else {
      const LocalPoints local{*origin, given};
      const BatchPoints at = in_body(local, n);
      use(i, static_cast<int>(n), lists, at.arrays(), &local);
    }
  }
}

void FieldBlock::evaluate_at(const Vec3d* origin, std::span<const float> x, std::span<const float> y,
                             std::span<const float> z, std::span<float> value, float band,
                             bool tetrahedra) const {
  for_each_batch(
      origin, value.size(), x, y, z,
      [&](std::size_t i, int n, const BatchLists& lists, const PointArrays& at, const LocalPoints* local) {
        evaluate_batch(*model_, lists, n, at, {band, tetrahedra}, &value[i], local);
      });
}

void FieldBlock::find_signs(std::span<const float> x, std::span<const float> y, std::span<const float> z,
                            float tolerance, std::span<std::int8_t> sign) const {
  for_each_batch(nullptr, sign.size(), x, y, z,
                 [&](std::size_t i, int n, const BatchLists& lists, const PointArrays& at,
                     const LocalPoints*) { find_sure_signs(*model_, lists, n, at, tolerance, &sign[i]); });
}

void FieldBlock::evaluate_stages(const Vec3d* origin, std::span<const float> x, std::span<const float> y,
                                 std::span<const float> z,
                                 const std::function<void(std::size_t, const FieldStage&)>& visit) const {
  for_each_batch(
      origin, x.size(), x, y, z,
      [&](std::size_t i, int n, const BatchLists& lists, const PointArrays& at, const LocalPoints* local) {
        const auto show = [&](const FieldStage& stage) { visit(i, stage); };
        astrolith::evaluate_stages(*model_, lists, n, at, show, local);
      });
}

void FieldBlock::paint(const SurfacePaints& paints, const Vec3d* origin, std::span<const float> x,
                       std::span<const float> y, std::span<const float> z,
                       std::span<PaintedPoint> points) const {
  for_each_batch(
      origin, points.size(), x, y, z,
      [&](std::size_t i, int n, const BatchLists& lists, const PointArrays& at, const LocalPoints* local) {
        paint_batch(*model_, lists, paints, n, at, &points[i], local);
      });
}

ImplicitField::ImplicitField(const Recipe& recipe, const std::string& name,
                             const std::optional<PatchCube>& patch, const Progress& progress,
                             const ImplicitField* like) {
  if (!recipe.body || (!recipe.body->morph && recipe.body->spheres.empty())) {
    throw InputError(name + ": body: is missing; give a body, or lay these layers on one");
  }
  auto model = std::make_shared<FieldModel>();
  model->patch = patch;
  if (like != nullptr) model->shared = like->model_->shared;
  model->body = make_body(*recipe.body, recipe.seed, model->arrays, &(*model->shared)["body"]);
  model->update();
  model->metaballs = all_metaballs(model->body, model->tables.arrays);
  add_layers(recipe, name, *model, progress);
  model->finish();
  model->bounds = surface_bounds(*model);
  model_ = std::move(model);
}

double ImplicitField::value(const Vec3d& p) const { return static_cast<double>(value_at(*model_, p)); }

Vec3d ImplicitField::gradient(const Vec3d& p) const {
  const BodyLeaf& first = model_->tables.leaf(0);
  const bool bare = model_->layers.empty() && model_->boulders.empty();
  if (bare && model_->body.plain() && !first.warped) {
    return distance_gradient({first.metaballs, model_->metaballs.spheres}, p);
  }
  const double h = gradient_step();
  const auto slope = [&](const Vec3d& d) { return (value(p + d) - value(p - d)) / (2.0 * h); };
  return {slope({h, 0, 0}), slope({0, h, 0}), slope({0, 0, h})};
}

double ImplicitField::gradient_step() const {
  const Vec3d e = model_->bounds.empty() ? Vec3d{1, 1, 1} : model_->bounds.extent();
  return std::max({e.x, e.y, e.z}) * 0x1p-11;
}

Box ImplicitField::bounds() const { return model_->bounds; }

bool ImplicitField::has_local_form() const { return model_->body.plain(); }

std::span<const LayerLeftOut> ImplicitField::left_out() const { return model_->left_out; }

bool ImplicitField::has_patch_layers() const { return model_->has_patch_layers; }

double ImplicitField::height_bound() const { return model_->height_bound; }

std::span<const LayerCraters> ImplicitField::craters() const { return model_->placed_craters; }

std::span<const LayerBoulders> ImplicitField::boulders() const { return model_->placed_boulders; }

FieldBlock ImplicitField::gather(const Box& box) const {
  const FieldView& f = model_->tables;
  return {*model_,
          metaballs_reaching(f.body, f.arrays, model_->metaballs.lists(), body_box(f.body, f.arrays, box)),
          spots_reaching(*model_, box, {}), box};
}

std::vector<GaborCacheUse> ImplicitField::gabor_caches() const {
  std::vector<GaborCacheUse> uses;
  for (const GaborBrickCache& cache : model_->gabor_caches) uses.push_back(cache_use(cache));
  return uses;
}

std::vector<double> ImplicitField::gabor_brick_seconds() const {
  const FieldView& f = model_->tables;
  const BodyGround ground{model_->body, f.arrays, model_->metaballs.lists()};
  const std::span<const ImpulseList> lists = f.arrays.span(f.gabor_lists);
  std::vector<double> seconds;
  for (std::size_t i = 0; i < lists.size(); ++i) {
    const GaborSurfaceNoise& noise = *f.layers[lists[i].layer].noise.get_if<GaborSurfaceNoise>();
    const SurfaceBand& band = f.arrays[noise.bands][lists[i].element];
    seconds.push_back(GaborBricks(band, ground, model_->gabor_caches[i]).seconds_per_brick());
  }
  return seconds;
}

std::span<const int> ImplicitField::recipe_layers() const { return model_->recipe_layers; }

const FieldView& ImplicitField::tables() const { return model_->tables; }

const FieldView& ImplicitField::patch_tables() const {
  if (!model_->patch) throw std::invalid_argument("ImplicitField: the field was made for no patch");
  return model_->patch_tables;
}

void FieldModel::finish() {
  tables.spot_lists = arrays.add(spot_lists);
  tables.gabor_lists = arrays.add(gabor_lists);
  tables.crater_layers = arrays.add(crater_layers);
  tables.boulders = arrays.add(boulders);
  update();
  if (patch) add_patch_tables(*this);
}

void FieldModel::update() {
  tables.arrays = arrays.view();
  tables.layers = layers.data();
  tables.num_layers = static_cast<std::uint32_t>(layers.size());
  tables.num_kept_heights = num_kept_heights;
  tables.body = body;
  tables.height_bound = height_bound;
  tables.height_reach = static_cast<float>(height_bound * (1.0 + 1e-5));
  tables.longest_step = static_cast<float>(height_bound);
  tables.steepest = static_cast<float>(body.lipschitz_bound);
  tables.reads_projections = std::any_of(layers.begin(), layers.end(), [](const FieldLayer& layer) {
    const NoiseTraits traits = noise_traits(layer.noise);
    return traits.on_surface && traits.bounded_by_box;
  });
  if (patch) tables.patch.origin = patch->center;
}

}  // namespace astrolith
