#include "synthesis/finish/lay_on_base.h"

#include "numerics/errors.h"

namespace astrolith {
namespace {

// The length of one unit of the details in units of the base.
double unit_ratio(const Recipe& details, const std::string& details_name, const Recipe& base,
                  const std::string& base_name) {
  const std::string &from = details.length_unit, &to = base.length_unit;
  if (from == to) return 1.0;
  if (from == "m" && to == "km") return 1e-3;
  if (from == "km" && to == "m") return 1e3;
  throw InputError(details_name + ": length_unit: \"" + from + "\" has no physical scale on " + base_name +
                   ", which is in \"" + to + "\"; state length_unit \"m\" or \"km\" and the lengths in it");
}

Layer scaled(FractalLayer layer, double ratio) {
  layer.amplitude *= ratio;
  layer.frequency /= ratio;
  layer.bias *= ratio;
  if (layer.warp) {
    layer.warp->amplitude *= ratio;
    layer.warp->frequency /= ratio;
  }
  return layer;
}

Layer scaled(SpotLayer layer, double ratio) {
  layer.amplitude *= ratio;
  layer.size *= ratio;
  layer.cell_size *= ratio;
  return layer;
}

Layer scaled(SparseLayer layer, double ratio) {
  layer.amplitude *= ratio;
  layer.cell_size *= ratio;
  return layer;
}

Layer scaled(RandomPhaseLayer layer, double ratio) {
  layer.height_rms *= ratio;
  layer.cell_size *= ratio;
  layer.frequency_min /= ratio;
  layer.frequency_max /= ratio;
  return layer;
}

Layer scaled(PhasorLayer layer, double ratio) {
  layer.amplitude *= ratio;
  layer.cell_size *= ratio;
  layer.frequency /= ratio;
  return layer;
}

Layer scaled(GaborLayer layer, double ratio) {
  layer.pixel_size *= ratio;
  layer.height_rms *= ratio;
  return layer;
}

void rescale(Population& population, double ratio) {
  population.least_diameter *= ratio;
  population.greatest_diameter *= ratio;
  if (population.density) *population.density /= ratio * ratio;
}

Layer scaled(CraterLayer layer, double ratio) {
  if (layer.complex_from) *layer.complex_from *= ratio;
  for (Crater& crater : layer.craters) {
    crater.place.vector *= ratio;
    crater.diameter *= ratio;
    if (crater.depth) *crater.depth *= ratio;
    if (crater.rim_height) *crater.rim_height *= ratio;
  }
  if (layer.population) rescale(layer.population->drawn, ratio);
  return layer;
}

Layer scaled(BoulderLayer layer, double ratio) {
  for (Boulder& boulder : layer.boulders) {
    boulder.place.vector *= ratio;
    boulder.axes *= ratio;
  }
  if (layer.population) rescale(layer.population->drawn, ratio);
  return layer;
}

}  // namespace

Recipe lay_on_base(const Recipe& details, const std::string& details_name, const Recipe& base,
                   const std::string& base_name) {
  if (!base.body) throw InputError(base_name + ": body: absent; give a recipe with a body as the base");
  const double ratio = unit_ratio(details, details_name, base, base_name);
  Recipe result = base;
  for (const Layer& layer : details.layers) result.layers.push_back(rescaled(layer, ratio));
  return result;
}

Layer rescaled(const Layer& layer, double ratio) {
  Layer result = std::visit([ratio](const auto& l) { return scaled(l, ratio); }, layer);
  LayerUse* use = use_of(result);
  if (use == nullptr) return result;
  if (use->locality) use->locality->width *= ratio;
  if (use->mask) {
    use->mask->from *= ratio;
    use->mask->to *= ratio;
  }
  use->combination.width *= ratio;
  return result;
}

}  // namespace astrolith
