#include "recipe/body_internal.h"
#include "recipe/noise_layers_internal.h"

namespace astrolith {

using nlohmann::ordered_json;

namespace {

const char* type_of(Noise noise) {
  return noise == Noise::kSimplex ? "simplex" : noise == Noise::kPerlin ? "perlin" : "worley";
}

const char* distance_of(Noise noise) {
  return noise == Noise::kWorleyF1 ? "f1" : noise == Noise::kWorleyF2 ? "f2" : "f2-f1";
}

ordered_json to_json(const Combination& combination) {
  ordered_json object{{"type", combine_word(combination.kind)}};
  if (combination.kind == Combine::kBlend) {
    object["operator"] = combination.intersection ? "intersection" : "union";
    object["width"] = combination.width;
  } else if (combination.kind == Combine::kWarp) {
    object["direction"] = to_json(combination.direction);
  }
  return object;
}

ordered_json to_json(const SpotPart& part) {
  return {{"center", to_json(part.center)},
          {"axes", to_json(part.axes)},
          {"turn", to_json(part.turn)},
          {"weight", part.weight}};
}

}  // namespace

void add_use(const LayerUse& use, ordered_json& layer) {
  if (use.locality) layer["locality"] = {{"group", use.locality->group}, {"width", use.locality->width}};
  if (use.mask) layer["mask"] = {{"layer", use.mask->layer}, {"from", use.mask->from}, {"to", use.mask->to}};
  if (use.combination.kind != Combine::kAdd) layer["combine"] = to_json(use.combination);
}

ordered_json to_json(const FractalLayer& layer) {
  ordered_json object{{"type", type_of(layer.noise)},   {"name", layer.name},
                      {"amplitude", layer.amplitude},   {"frequency", layer.frequency},
                      {"octaves", layer.octaves},       {"gain", layer.gain},
                      {"lacunarity", layer.lacunarity}, {"scale", to_json(layer.scale)},
                      {"bias", to_json(layer.bias)},    {"weight", layer.weight}};
  if (is_worley(layer.noise)) {
    object["distance"] = distance_of(layer.noise);
  } else {
    object["gradient_modulation"] = layer.gradient_modulation;
  }
  if (layer.warp) object["warp"] = to_json(*layer.warp);
  return object;
}

ordered_json to_json(const GaborLayer& layer) {
  ordered_json lobes = ordered_json::array();
  for (const GaborLobe& l : layer.lobes) {
    lobes.push_back(ordered_json::array({l.bandwidth, l.frequency_x, l.frequency_y, l.variance}));
  }
  ordered_json object{{"type", "gabor"},
                      {"name", layer.name},
                      {"pixel_size", layer.pixel_size},
                      {"height_rms", layer.height_rms},
                      {"impulses_per_kernel", layer.impulses_per_kernel},
                      {"exemplar_mean", layer.exemplar_mean},
                      {"exemplar_rms", layer.exemplar_rms}};
  if (layer.color) {
    object["color"] = {{"axis", to_json(layer.color->axis)}, {"mean", to_json(layer.color->mean)}};
  }
  object["lobes"] = std::move(lobes);
  return object;
}

ordered_json to_json(const SpotLayer& layer) {
  const CellEdges& edges = layer.lattice;
  ordered_json object{
      {"type", "spots"},
      {"name", layer.name},
      {"amplitude", layer.amplitude},
      {"inverted", layer.inverted},
      {"size", layer.size},
      {"cell_size", layer.cell_size},
      {"lattice", ordered_json::array({to_json(edges.a), to_json(edges.b), to_json(edges.c)})},
      {"density", layer.density},
      {"probability", layer.probability},
      {"even", layer.even},
      {"reach", layer.reach},
      {"least_weight", layer.least_weight},
      {"gaussian", layer.gaussian},
      {"alpha", layer.alpha},
      {"kappa", layer.kappa},
      {"beta", layer.beta},
      {"gamma", layer.gamma},
      {"variances", to_json(layer.variances)},
      {"sigma", layer.sigma},
      {"layers", layer.layers},
      {"lacunarity", layer.lacunarity},
      {"gain", layer.gain},
      {"exponent", layer.exponent}};
  for (const SpotPart& part : layer.parts) object["parts"].push_back(to_json(part));
  return object;
}

ordered_json to_json(const SparseLayer& layer) {
  return {{"type", "sparse"},
          {"name", layer.name},
          {"amplitude", layer.amplitude},
          {"cell_size", layer.cell_size},
          {"levels", layer.levels},
          {"probability", layer.probability},
          {"threshold", layer.threshold},
          {"gain", layer.gain},
          {"merged", layer.merged}};
}

ordered_json to_json(const RandomPhaseLayer& layer) {
  return {{"type", "random_phase"},
          {"name", layer.name},
          {"height_rms", layer.height_rms},
          {"cell_size", layer.cell_size},
          {"waves", layer.waves},
          {"frequency_min", layer.frequency_min},
          {"frequency_max", layer.frequency_max},
          {"exponent", layer.exponent},
          {"direction", to_json(layer.direction)},
          {"spread", layer.spread},
          {"randomness", layer.randomness}};
}

ordered_json to_json(const PhasorLayer& layer) {
  return {{"type", "phasor"},
          {"name", layer.name},
          {"amplitude", layer.amplitude},
          {"frequency", layer.frequency},
          {"cell_size", layer.cell_size},
          {"impulses_per_cell", layer.impulses_per_cell},
          {"direction", to_json(layer.direction)},
          {"spread", layer.spread},
          {"profile", profile_word(layer.profile)}};
}

}  // namespace astrolith
