#include "synthesis/flat_field_data.h"

#include "synthesis/field_model_internal.h"

namespace astrolith {
namespace {

template <typename T>
FlatRange append(std::span<const T> values, std::vector<T>& array) {
  const FlatRange range{static_cast<std::uint32_t>(array.size()), static_cast<std::uint32_t>(values.size())};
  array.insert(array.end(), values.begin(), values.end());
  return range;
}

FlatWarp flat_warp(const CoordinateWarp& warp, FlatFieldData& data) {
  FlatWarp flat;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    flat.octaves[axis] = append(std::span<const NoiseOctave>(warp.octaves(axis)), data.octaves);
  }
  flat.low = warp.domain_min();
  flat.high = warp.domain_max();
  return flat;
}

FlatRange flat_spheres(const std::vector<Sphere>& spheres, FlatFieldData& data) {
  std::vector<FlatSphere> single;
  for (const Sphere& s : spheres) {
    single.push_back(
        {{static_cast<float>(s.center.x), static_cast<float>(s.center.y), static_cast<float>(s.center.z)},
         static_cast<float>(s.radius)});
  }
  return append(std::span<const FlatSphere>(single), data.weight_spheres);
}

// One overload for every layer that can be flattened.
struct Flatten {
  FlatFieldData& data;
  FlatLayer& layer;

  void operator()(const FractalNoise& noise) const {
    const FractalNoise::Parts parts = noise.parts();
    layer.kind = FlatNoise::kFractal;
    layer.low = parts.domain_min;
    layer.high = parts.domain_max;
    layer.noise = parts.noise;
    layer.scale = parts.scale;
    layer.bias = parts.bias;
    layer.gradient_modulation = parts.gradient_modulation;
    layer.warped = parts.warp != nullptr;
    if (layer.warped) layer.warp = flat_warp(*parts.warp, data);
    layer.parts = append(parts.octaves, data.octaves);
  }
  void operator()(const SparseNoise& noise) const {
    const SparseNoise::Parts parts = noise.parts();
    layer.kind = FlatNoise::kSparse;
    layer.low = parts.domain_min;
    layer.high = parts.domain_max;
    layer.amplitude = parts.amplitude;
    layer.level_cut = parts.level_cut;
    layer.sum_cut = parts.sum_cut;
    layer.probability = parts.probability;
    layer.inverse_probability = parts.inverse_probability;
    layer.parts = append(parts.levels, data.sparse_levels);
  }
  void operator()(const SpotNoise& noise) const {
    layer.kind = FlatNoise::kSpots;
    layer.low = noise.domain_min();
    layer.high = noise.domain_max();
    layer.parts = {static_cast<std::uint32_t>(data.spots.size()),
                   static_cast<std::uint32_t>(noise.num_sizes())};
    for (int j = 0; j < noise.num_sizes(); ++j) {
      data.spots.push_back({noise.kernel(j), noise.clip(j), static_cast<std::uint32_t>(data.spots.size())});
    }
  }
  template <typename Other>
  void operator()(const Other&) const {}
};

Vec3f single(const Vec3d& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

FlatJoin flat_join(const LayerJoin& join, float change_bound, FlatFieldData& data) {
  FlatJoin flat;
  flat.change_bound = change_bound;
  flat.changes_elevation = join.changes_elevation();
  flat.warps = join.how.kind == Combine::kWarp;
  flat.blends = join.how.kind == Combine::kBlend;
  flat.is_change = join.how.kind == Combine::kAdd;
  flat.sign = join.how.intersection ? -1.0f : 1.0f;
  flat.width = static_cast<float>(join.how.width);
  flat.direction = single(join.how.direction);
  flat.keeps = join.keeps;
  if (join.locality) {
    flat.local = true;
    flat.locality = {flat_spheres(join.locality->near(), data), flat_spheres(join.locality->others(), data),
                     join.locality->inverse_width()};
  }
  if (join.mask) {
    flat.mask = join.mask->slot;
    flat.mask_from = join.mask->from;
    flat.mask_inverse_range = 1.0f / (join.mask->to - join.mask->from);
  }
  return flat;
}

struct Obstacle {
  std::string operator()(const FractalNoise&) const { return {}; }
  std::string operator()(const SparseNoise&) const { return {}; }
  std::string operator()(const SpotNoise&) const { return {}; }
  std::string operator()(const GaborSurfaceNoise&) const { return "Gabor layers"; }
  std::string operator()(const CraterRelief&) const { return "layers of craters"; }
  std::string operator()(const RandomPhaseNoise&) const { return "layers of random-phase noise"; }
  std::string operator()(const PhasorNoise&) const { return "layers of phasor noise"; }
};

}  // namespace

std::string obstacle_to_flattening(const ImplicitField& field) {
  const FieldModel& model = field.model();
  if (!model.body.plain()) return "bodies with operations";
  if (!model.boulders.empty()) return "layers of boulders";
  if (model.kept_heights > kFlatSlots) return "masks by more than four layers";
  for (const PlacedLayer& layer : model.layers) {
    std::string obstacle = std::visit(Obstacle{}, layer.noise);
    if (!obstacle.empty()) return obstacle;
  }
  return {};
}

FlatFieldData::FlatFieldData(const ImplicitField& field) : values{} {
  const FieldModel& model = field.model();
  values.body = model.body.metaballs.parameters;
  values.warped = model.warp.has_value();
  values.stretch = model.warp ? static_cast<float>(model.warp->stretch()) : 1.0f;
  if (model.warp) values.warp = flat_warp(*model.warp, *this);
  values.height_reach = height_reach(model);
  for (std::size_t i = 0; i < model.layers.size(); ++i) {
    const PlacedLayer& placed = model.layers[i];
    FlatLayer layer;
    std::visit(Flatten{*this, layer}, placed.noise);
    layer.join = flat_join(placed.join, change_bound(model, i), *this);
    layers.push_back(layer);
  }
  values.num_layers = static_cast<std::uint32_t>(layers.size());
}

FlatFieldData::FlatFieldData(const MetaballParameters<float>& body) : values{} {
  values.body = body;
  values.stretch = 1.0f;
}

void FlatFieldData::add(const FractalNoise& noise) {
  FlatLayer layer;
  Flatten{*this, layer}(noise);
  layers.push_back(layer);
  values.num_layers = static_cast<std::uint32_t>(layers.size());
}

FlatField FlatFieldData::view() const {
  FlatField flat = values;
  flat.layers = layers.data();
  flat.octaves = octaves.data();
  flat.weight_spheres = weight_spheres.data();
  flat.sparse_levels = sparse_levels.data();
  flat.spots = spots.data();
  return flat;
}

void FlatBlocksData::add(std::span<const MetaballSphere<float>> of_block) {
  append(of_block, spheres);
  first_sphere.push_back(static_cast<std::uint32_t>(spheres.size()));
}

void FlatBlocksData::add(const FieldBlock& block) {
  add(std::span<const MetaballSphere<float>>(block.body().metaballs.spheres));
  for (const SpotImpulses& of_layer : block.all_spots()) {
    for (const std::vector<SpotImpulse>& list : of_layer) {
      append(std::span<const SpotImpulse>(list), impulses);
      first_impulse.push_back(static_cast<std::uint32_t>(impulses.size()));
    }
  }
}

FlatBlocks FlatBlocksData::view() const {
  return {spheres.data(), first_sphere.data(), impulses.data(), first_impulse.data(),
          static_cast<std::uint32_t>(lists)};
}

}  // namespace astrolith
