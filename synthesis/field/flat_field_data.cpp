#include "synthesis/field/flat_field_data.h"

#include "synthesis/field/field_model_internal.h"

namespace astrolith {
namespace {

// Of all Gabor layers, and of all layers of spots, that a block's impulses are drawn from: every point of the
// block adds them all.
constexpr double kMostCells = 32768.0;

double cells_of(const SpotNoise& spots, double side) {
  double cells = 0.0;
  for (const SpotKind& kind : spots.kinds())
    cells += spot_cells_around(kind, {{}, {side, side, side}}).count();
  return cells;
}

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
  flat.bound = warp.bound();
  return flat;
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
    const FlatRange thresholds =
        append(std::span<const std::uint32_t>(noise.thresholds()), data.spot_thresholds);
    for (SpotKind kind : noise.kinds()) {
      kind.lattice.first_threshold += thresholds.first;
      data.spots.push_back({kind, static_cast<std::uint32_t>(data.spots.size()), data.next_layer()});
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
    data.crater_layers.push_back(data.next_layer());
    layer.parts = append(std::span<const CraterKernel>(relief.kernels()), data.craters);
  }
  void operator()(const GaborSurfaceNoise& noise) const {
    layer.kind = FlatNoise::kGabor;
    layer.low = noise.domain_min();
    layer.high = noise.domain_max();
    layer.clip = noise.clip();
    layer.parts = {static_cast<std::uint32_t>(data.bands.size()),
                   static_cast<std::uint32_t>(noise.num_bands())};
    for (std::size_t b = 0; b < noise.num_bands(); ++b) {
      const SurfaceBand& band = noise.band(b);
      data.bands.push_back(
          {band, append(std::span<const GaborLobeShare>(band.band.lobes), data.lobes), data.next_layer()});
    }
  }
};

FlatLeaf flat_leaf(const PreparedMetaballs& metaballs, const CoordinateWarp* warp, FlatFieldData& data) {
  FlatLeaf leaf{metaballs.parameters, warp != nullptr, {}, {}};
  if (leaf.warped) leaf.warp = flat_warp(*warp, data);
  leaf.spheres = append(std::span<const MetaballSphere<float>>(metaballs.spheres), data.spheres);
  return leaf;
}

// The body's leaves and steps, after those there are.
void add_steps(const PreparedBody& body, FlatFieldData& data) {
  data.steps.push_back({true, static_cast<std::uint32_t>(data.leaves.size()), {}, {}});
  data.leaves.push_back(flat_leaf(body.metaballs, body.warp.get(), data));
  for (const PreparedOperation& operation : body.operations) {
    add_steps(operation.operand, data);
    data.steps.push_back({false, 0, in_float(operation.parameters), operation.parameters});
  }
}

void add_body(const FieldModel& model, FlatFieldData& data) {
  if (!model.body.plain()) return add_steps(model.body, data);
  data.leaves.push_back(flat_leaf(model.body.metaballs, model.warp ? &*model.warp : nullptr, data));
}

void add_boulders(const BoulderField& field, FlatFieldData& data) {
  for (std::size_t i = 0; i < field.kernels().size(); ++i) {
    data.boulders.push_back({field.kernels()[i], field.boxes()[i].min, field.boxes()[i].max});
  }
  data.values.boulder_list = static_cast<std::uint32_t>(data.lists++);
}

double height_bound_of(const HeightLayer& layer) {
  if (const auto* craters = std::get_if<CraterRelief>(&layer)) return craters->elevation_bound();
  return std::visit(
      [](const auto& noise) {
        if constexpr (requires { noise.height_bound(); }) return noise.height_bound();
        return 0.0;
      },
      layer);
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
  flat.direction = to_float(join.how.direction);
  flat.keeps = join.keeps;
  flat.how = {join.how.kind, join.how.intersection, join.how.width};
  flat.displaced = join.displaced;
  flat.height_bound = join.height_bound;
  if (join.locality) {
    flat.local = true;
    flat.locality = {append(std::span<const WeightSphere>(join.locality->near()), data.weight_spheres),
                     append(std::span<const WeightSphere>(join.locality->others()), data.weight_spheres),
                     join.locality->inverse_width()};
  }
  if (join.mask) {
    flat.mask = join.mask->slot;
    flat.mask_from = join.mask->from;
    flat.mask_to = join.mask->to;
    flat.mask_inverse_range = 1.0f / (join.mask->to - join.mask->from);
  }
  return flat;
}

}  // namespace

std::string obstacle_to_flattening(const ImplicitField& field, double block_side) {
  const FieldModel& model = field.model();
  if (model.kept_heights > kFlatSlots) return "masks by more than four layers";
  double gabor_cells = 0.0, spot_cells = 0.0;
  for (const PlacedLayer& layer : model.layers) {
    if (const auto* gabor = std::get_if<GaborSurfaceNoise>(&layer.noise)) {
      gabor_cells += gabor->cells(block_side + 2.0 * model.height_bound);
    } else if (const auto* spots = std::get_if<SpotNoise>(&layer.noise)) {
      spot_cells += cells_of(*spots, block_side);
    }
  }
  if (spot_cells > kMostCells) return "spots so much smaller than the mesh's cells";
  return gabor_cells > kMostCells ? "Gabor kernels so much smaller than the mesh's cells" : "";
}

FlatFieldData::FlatFieldData(const ImplicitField& field) : values{} {
  const FieldModel& model = field.model();
  add_body(model, *this);
  values.lipschitz_bound =
      model.warp ? static_cast<float>(model.warp->lipschitz_bound()) : model.lipschitz_bound;
  values.height_reach = height_reach(model);
  values.longest_step = static_cast<float>(model.height_bound);
  values.height_bound = model.height_bound;
  for (std::size_t i = 0; i < model.layers.size(); ++i) {
    const PlacedLayer& placed = model.layers[i];
    FlatLayer layer;
    std::visit(Flatten{*this, layer}, placed.noise);
    layer.height_bound = height_bound_of(placed.noise);
    layer.join = flat_join(placed.join, change_bound(model, i), *this);
    layers.push_back(layer);
  }
  add_boulders(model.boulders, *this);
}

FlatFieldData::FlatFieldData(const MetaballParameters<float>& body)
    : leaves{{body, false, {}, {}}}, values{} {}

void FlatFieldData::add(const FractalNoise& noise) {
  FlatLayer layer;
  Flatten{*this, layer}(noise);
  layers.push_back(layer);
}

FlatField FlatFieldData::view() const {
  FlatField flat = values;
  flat.num_layers = static_cast<std::uint32_t>(layers.size());
  flat.num_leaves = static_cast<std::uint32_t>(leaves.size());
  flat.num_steps = static_cast<std::uint32_t>(steps.size());
  flat.layers = layers.data();
  flat.leaves = leaves.data();
  flat.spheres = spheres.data();
  flat.steps = steps.data();
  flat.octaves = octaves.data();
  flat.weight_spheres = weight_spheres.data();
  flat.sparse_levels = sparse_levels.data();
  flat.spots = spots.data();
  flat.spot_thresholds = spot_thresholds.data();
  flat.waves = waves.data();
  flat.bands = bands.data();
  flat.lobes = lobes.data();
  flat.craters = craters.data();
  flat.crater_layers = crater_layers.data();
  flat.boulders = boulders.data();
  return flat;
}

}  // namespace astrolith
