// Puts a recipe's layers on the model of its body.
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "synthesis/field/bare_body.h"
#include "synthesis/field/field_model_internal.h"

namespace astrolith {
namespace {

// What the layers so far have made of the bare surface at points of it, where s = 0.
std::vector<float> elevations_at(const FieldModel& model, std::span<const Vec3d> points) {
  std::vector<float> elevations(points.size());
  parallel_for(0, static_cast<std::int64_t>(points.size()), [&](std::int64_t i) {
    elevations[static_cast<std::size_t>(i)] = value_at(model, points[static_cast<std::size_t>(i)]);
  });
  return elevations;
}

// One by one.
class LayerStack {
 public:
  LayerStack(const Recipe& recipe, const std::string& name, FieldModel& model)
      : recipe_(recipe),
        name_(name),
        model_(model),
        supports_(support_bounds(model.body)),
        domain_(model.warp ? widened(supports_, model.warp->bound()) : supports_) {}

  void add_all() {
    for (index_ = 0; index_ < static_cast<int>(recipe_.layers.size()); ++index_) {
      std::visit([this](const auto& layer) { add(layer); }, recipe_.layers[static_cast<std::size_t>(index_)]);
    }
    add_boulders();
  }

 private:
  void add(const FractalLayer& layer) { push(FractalNoise(layer, recipe_.seed, number_of(layer), domain_)); }
  void add(const SpotLayer& layer) { push(SpotNoise(layer, recipe_.seed, number_of(layer), domain_)); }
  void add(const SparseLayer& layer) { push(SparseNoise(layer, recipe_.seed, number_of(layer), domain_)); }
  void add(const RandomPhaseLayer& layer) {
    push(RandomPhaseNoise(layer, recipe_.seed, number_of(layer), domain_));
  }
  void add(const PhasorLayer& layer) { push(PhasorNoise(layer, recipe_.seed, number_of(layer), domain_)); }
  void add(const GaborLayer& layer) {
    // A layer of colour alone has no height.
    if (layer.height_rms > 0.0)
      push(GaborSurfaceNoise(layer, recipe_.seed, number_of(layer), model_.body, supports_));
  }
  void add(const CraterLayer& layer) {
    std::vector<PlacedCrater> craters =
        place_craters(layer, bare(), recipe_.seed, number_of(layer), place_of(index_));
    std::vector<Vec3d> centers;
    for (const PlacedCrater& crater : craters) centers.push_back(crater.position);
    const std::vector<float> elevations = elevations_at(model_, centers);
    if (model_.warp) centers = warped(centers);
    CraterRelief relief(layer, craters, centers, elevations, model_.height_bound);
    model_.height_bound = relief.elevation_bound();
    LayerJoin join;
    join.change_bound = std::numeric_limits<double>::infinity();  // they replace what was
    model_.layers.push_back({std::move(relief), std::move(join)});
    model_.craters.push_back({index_, std::move(craters)});
  }

  void add(const BoulderLayer&) {}  // once the surface is there

  void add_boulders() {
    BoulderField boulders;
    const Terrain terrain{[this](const Vec3d& p) { return static_cast<double>(value_at(model_, p)); },
                          model_.height_bound};
    for (int i = 0; i < static_cast<int>(recipe_.layers.size()); ++i) {
      const auto* layer = std::get_if<BoulderLayer>(&recipe_.layers[static_cast<std::size_t>(i)]);
      if (layer == nullptr) continue;
      std::vector<PlacedBoulder> placed =
          place_boulders(*layer, bare(), terrain, recipe_.seed, layer_number(layer->seed, i), place_of(i));
      boulders.add(*layer, placed);
      model_.placed_boulders.push_back({i, std::move(placed)});
    }
    boulders.finish();
    model_.boulders = std::move(boulders);
  }

  template <typename AnyLayer>
  int number_of(const AnyLayer& layer) const {
    return layer_number(layer.seed, index_);
  }

  const BareSurface& bare() {
    if (!bare_) bare_.emplace(bare_body(recipe_));
    return *bare_;
  }
  std::string place_of(int layer) const { return name_ + ": layers[" + std::to_string(layer) + "]"; }

  template <typename Noise>
  void push(Noise noise) {
    const LayerUse& use = *use_of(recipe_.layers[static_cast<std::size_t>(index_)]);
    LayerJoin join;
    join.how = use.combination;
    join.height_bound = noise.height_bound();
    join.displaced = displaced_;
    if (use.locality) join.locality.emplace(*use.locality, *recipe_.body, place_of(index_));
    if (use.mask) join.mask = mask_of(*use.mask);
    if (is_masking(index_)) slots_[index_] = join.keeps = model_.kept_heights++;
    const double before = model_.height_bound;
    model_.height_bound = elevation_bound(join.how, before, join.height_bound);
    if (join.changes_elevation()) {
      const bool is_change = join.how.kind == Combine::kAdd;
      join.change_bound = is_change ? join.height_bound : before + model_.height_bound;
    }
    if (join.how.kind == Combine::kWarp) displace_later(join.how.direction, join.height_bound);
    model_.layers.push_back({std::move(noise), std::move(join)});
  }

  // Later layers are evaluated so much farther out.
  void displace_later(const Vec3d& direction, double height) {
    const Vec3d d{std::fabs(direction.x) * height, std::fabs(direction.y) * height,
                  std::fabs(direction.z) * height};
    displaced_ += d;
    domain_.min -= d;
    domain_.max += d;
  }

  // The layer that a mask of layer number `index` names.
  int masking_layer(const LayerMask& mask, int index) const {
    return find_layer(std::span(recipe_.layers).first(static_cast<std::size_t>(index)), mask.layer);
  }
  bool is_masking(int index) const {
    for (int i = index + 1; i < static_cast<int>(recipe_.layers.size()); ++i) {
      const LayerUse* use = use_of(recipe_.layers[static_cast<std::size_t>(i)]);
      if (use != nullptr && use->mask && masking_layer(*use->mask, i) == index) return true;
    }
    return false;
  }
  HeightMask mask_of(const LayerMask& mask) const {
    const auto slot = slots_.find(masking_layer(mask, index_));
    if (slot == slots_.end()) {
      throw InputError(place_of(index_) + ".mask.layer: \"" + mask.layer +
                       "\" has no height; give that layer one, or name another");
    }
    return {slot->second, static_cast<float>(mask.from), static_cast<float>(mask.to)};
  }

  std::vector<Vec3d> warped(std::vector<Vec3d> points) const {
    for (Vec3d& p : points) {
      const float x = static_cast<float>(p.x), y = static_cast<float>(p.y), z = static_cast<float>(p.z);
      float mx, my, mz;
      model_.warp->evaluate(1, &x, &y, &z, &mx, &my, &mz);
      p = {mx, my, mz};
    }
    return points;
  }

  const Recipe& recipe_;
  const std::string& name_;  // for errors
  FieldModel& model_;
  // Layers' coordinates are kept within the supports of the body's kernels, outside of which no surface is.
  Box supports_, domain_;
  Vec3d displaced_;                  // of the coordinates of later layers, at most, by axis
  std::map<int, int> slots_;         // of masking layers
  std::optional<BareSurface> bare_;  // for the first layer that asks
  int index_ = 0;
};

}  // namespace

void add_layers(const Recipe& recipe, const std::string& name, FieldModel& model) {
  LayerStack(recipe, name, model).add_all();
}

}  // namespace astrolith
