#include "synthesis/flat_field_data.h"

#include "numerics/parallel_for.h"
#include "synthesis/field_model_internal.h"

namespace astrolith {
namespace {

// Of a Gabor layer, that a block's impulses are drawn from: every point of the block adds them all.
constexpr double kMostGaborCells = 32768.0;

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
                   static_cast<std::uint32_t>(noise.num_kinds())};
    for (int j = 0; j < noise.num_kinds(); ++j) {
      data.spots.push_back({noise.kernel(j), noise.clip(j), static_cast<std::uint32_t>(data.spots.size())});
    }
  }
  void operator()(const PhasorNoise& noise) const {
    const PhasorNoise::Parts parts = noise.parts();
    layer.kind = FlatNoise::kPhasor;
    layer.low = parts.domain_min;
    layer.high = parts.domain_max;
    layer.kernels = parts.kernels;
    layer.inverse_cell = parts.inverse_cell;
    layer.amplitude = parts.amplitude;
    layer.profile = parts.profile;
    layer.parts.count = static_cast<std::uint32_t>(parts.impulses);
    layer.seed = parts.seed;
  }
  void operator()(const RandomPhaseNoise& noise) const {
    const RandomPhaseNoise::Parts parts = noise.parts();
    layer.kind = FlatNoise::kRandomPhase;
    layer.low = parts.domain_min;
    layer.high = parts.domain_max;
    layer.inverse_cell = parts.inverse_cell;
    layer.randomness = parts.randomness;
    layer.coherence = parts.coherence;
    layer.clip = parts.clip;
    layer.seed = parts.seed;
    layer.parts = append(std::span<const Wave>(noise.waves()), data.waves);
  }
  void operator()(const CraterRelief& relief) const {
    layer.kind = FlatNoise::kCraters;
    layer.clip = static_cast<float>(relief.elevation_bound());
    layer.list = static_cast<std::uint32_t>(data.lists++);
    layer.parts = append(std::span<const CraterKernel>(relief.kernels()), data.craters);
  }
  void operator()(const GaborSurfaceNoise& noise) const {
    layer.kind = FlatNoise::kGabor;
    layer.low = noise.domain_min();
    layer.high = noise.domain_max();
    layer.clip = noise.clip();
    layer.parts = {static_cast<std::uint32_t>(data.bands.size()),
                   static_cast<std::uint32_t>(noise.num_bands())};
    for (std::size_t b = 0; b < noise.num_bands(); ++b) data.bands.push_back({noise.amplitude(b)});
  }
};

// The body's leaves and steps, after those there are.
void add_steps(const PreparedBody& body, FlatFieldData& data) {
  FlatLeaf leaf{body.metaballs.parameters, body.warp != nullptr, {}};
  if (leaf.warped) leaf.warp = flat_warp(*body.warp, data);
  data.steps.push_back({true, static_cast<std::uint32_t>(data.leaves.size()), {}});
  data.leaves.push_back(leaf);
  for (const PreparedOperation& operation : body.operations) {
    add_steps(operation.operand, data);
    data.steps.push_back({false, 0, in_float(operation.parameters)});
  }
}

void add_body(const FieldModel& model, FlatFieldData& data) {
  if (!model.body.plain()) return add_steps(model.body, data);
  FlatLeaf leaf{model.body.metaballs.parameters, model.warp.has_value(), {}};
  if (leaf.warped) leaf.warp = flat_warp(*model.warp, data);
  data.leaves.push_back(leaf);
}

void add_boulders(const BoulderField& field, FlatFieldData& data) {
  for (std::size_t i = 0; i < field.kernels().size(); ++i) {
    data.boulders.push_back({field.kernels()[i], field.boxes()[i].min, field.boxes()[i].max});
  }
  data.values.boulder_list = static_cast<std::uint32_t>(data.lists++);
}

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

}  // namespace

std::string obstacle_to_flattening(const ImplicitField& field, double block_side) {
  const FieldModel& model = field.model();
  if (model.kept_heights > kFlatSlots) return "masks by more than four layers";
  double cells = 0.0;
  for (const PlacedLayer& layer : model.layers) {
    const auto* gabor = std::get_if<GaborSurfaceNoise>(&layer.noise);
    if (gabor != nullptr) cells += gabor->cells(block_side + 2.0 * model.height_bound);
  }
  return cells > kMostGaborCells ? "Gabor kernels so much smaller than the mesh's cells" : "";
}

FlatFieldData::FlatFieldData(const ImplicitField& field) : values{} {
  const FieldModel& model = field.model();
  add_body(model, *this);
  values.stretch = model.warp ? static_cast<float>(model.warp->stretch()) : model.stretch;
  values.height_reach = height_reach(model);
  values.longest_step = static_cast<float>(model.height_bound);
  for (std::size_t i = 0; i < model.layers.size(); ++i) {
    const PlacedLayer& placed = model.layers[i];
    FlatLayer layer;
    std::visit(Flatten{*this, layer}, placed.noise);
    layer.join = flat_join(placed.join, change_bound(model, i), *this);
    layers.push_back(layer);
  }
  add_boulders(model.boulders, *this);
}

FlatFieldData::FlatFieldData(const MetaballParameters<float>& body) : leaves{{body, false, {}}}, values{} {}

void FlatFieldData::add(const FractalNoise& noise) {
  FlatLayer layer;
  Flatten{*this, layer}(noise);
  layers.push_back(layer);
}

FlatField FlatFieldData::view() const {
  FlatField flat = values;
  flat.num_layers = static_cast<std::uint32_t>(layers.size());
  flat.num_steps = static_cast<std::uint32_t>(steps.size());
  flat.layers = layers.data();
  flat.leaves = leaves.data();
  flat.steps = steps.data();
  flat.octaves = octaves.data();
  flat.weight_spheres = weight_spheres.data();
  flat.sparse_levels = sparse_levels.data();
  flat.spots = spots.data();
  flat.waves = waves.data();
  flat.bands = bands.data();
  flat.craters = craters.data();
  flat.boulders = boulders.data();
  return flat;
}

void FlatBlocksData::add(std::span<const MetaballSphere<float>> of_leaf) {
  append(of_leaf, spheres);
  first_sphere.push_back(static_cast<std::uint32_t>(spheres.size()));
}

void FlatBlocksData::add(const PreparedBody& body) {
  add(std::span<const MetaballSphere<float>>(body.metaballs.spheres));
  for (const PreparedOperation& operation : body.operations) add(operation.operand);
}

void FlatBlocksData::add(const FieldBlock& block, const BlockLists& of_block) {
  add(block.body());
  const auto append_all = [](const auto& parts, auto& array, std::vector<std::uint32_t>& first) {
    for (const auto& list : parts) {
      array.insert(array.end(), list.begin(), list.end());
      first.push_back(static_cast<std::uint32_t>(array.size()));
    }
  };
  append_all(of_block.spots, impulses, first_impulse);
  append_all(of_block.gabor, gabor, first_gabor);
  append_all(of_block.features, features, first_feature);
}

void FlatBlocksData::add(std::span<const FieldBlock* const> blocks) {
  std::vector<BlockLists> of_blocks(blocks.size());
  parallel_for(0, static_cast<std::int64_t>(blocks.size()), [&](std::int64_t i) {
    const auto k = static_cast<std::size_t>(i);
    of_blocks[k] = blocks[k]->lists();
  });
  for (std::size_t i = 0; i < blocks.size(); ++i) add(*blocks[i], of_blocks[i]);
}

FlatBlocks FlatBlocksData::view() const {
  const auto number = [](std::size_t n) { return static_cast<std::uint32_t>(n); };
  return {spheres.data(), first_sphere.data(), impulses.data(), first_impulse.data(),
          gabor.data(),   first_gabor.data(),  features.data(), first_feature.data(),
          number(leaves), number(sizes),       number(bands),   number(lists)};
}

}  // namespace astrolith
