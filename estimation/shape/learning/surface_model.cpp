#include "estimation/shape/learning/surface_model.h"

#include <algorithm>
#include <cmath>

#include "numerics/portable_double.h"
#include "recipe/recipe_json.h"

namespace astrolith {
namespace {

constexpr double kModelLacunarity = 1.95;
constexpr int kMostNoiseOctaves = 8;
// Waves below two edges do not show.
constexpr double kFinestWave = 2.0;

// Layer seeds, so that noise and landforms keep their places whatever else a recipe has.
constexpr int kMaskSeed = 519'001, kNoiseSeed = 519'002, kLandformSeed = 519'003;
constexpr const char* kMaskName = "where it is rough";

// The distance that x = 1 moves a number, as a logarithm or as it is.
constexpr double kAmplitudeReach = 0.4, kWavelengthReach = 0.5, kGainReach = 0.12, kContrastReach = 0.5,
                 kMaskWavelengthReach = 0.35, kCountReach = 0.9, kExponentReach = 0.7, kGreatestReach = 0.5,
                 kBurialReach = 0.2, kDepthReach = 0.6;

int octaves_of(const SurfaceModel& model) {
  int octaves = 1;
  double wave = model.wavelength / kModelLacunarity;
  for (; octaves < kMostNoiseOctaves && wave >= kFinestWave; ++octaves) wave /= kModelLacunarity;
  return octaves;
}

double moved(double centre, double reach, double x) { return centre * portable::exp(reach * x); }

// The mask noise: heights of the length unit's order, whatever the body's size.
FractalLayer mask_layer(const SurfaceModel& model, double edge) {
  FractalLayer mask;
  mask.name = kMaskName;
  mask.seed = kMaskSeed;
  mask.use.combination.kind = Combine::kMask;
  mask.amplitude = round_to_seven_digits(edge);
  mask.frequency = round_to_seven_digits(1.0 / (model.mask_wavelength * edge));
  mask.octaves = 2;
  return mask;
}

FractalLayer noise_layer(const SurfaceModel& model, double edge) {
  FractalLayer noise;
  noise.name = "noise";
  noise.seed = kNoiseSeed;
  noise.frequency = round_to_seven_digits(1.0 / (model.wavelength * edge));
  noise.octaves = octaves_of(model);
  noise.gain = round_to_seven_digits(model.gain);
  noise.lacunarity = kModelLacunarity;
  // Half of the weight is the mask's mean.
  noise.amplitude = round_to_seven_digits(2.0 * model.amplitude * edge);
  const double half_width = round_to_seven_digits(edge / model.contrast);
  noise.use.mask = LayerMask{kMaskName, -half_width, half_width};
  return noise;
}

Population drawn_landforms(const SurfaceModel& model, double edge) {
  Population drawn;
  drawn.count = static_cast<int>(std::lround(std::clamp(model.count, 1.0, 1e5)));
  drawn.least_diameter = round_to_seven_digits(model.least * edge);
  drawn.greatest_diameter = round_to_seven_digits(std::max(model.greatest, model.least) * edge);
  drawn.exponent = round_to_seven_digits(model.exponent);
  return drawn;
}

BoulderLayer boulder_layer(const SurfaceModel& model, double edge) {
  constexpr double kBurialSpread = 0.15;
  BoulderLayer layer;
  layer.name = "boulders";
  layer.seed = kLandformSeed;
  layer.smoothing = 0.15;
  layer.population.emplace().drawn = drawn_landforms(model, edge);
  layer.population->least_burial = round_to_seven_digits(std::max(model.shape - kBurialSpread, 0.0));
  layer.population->greatest_burial = round_to_seven_digits(std::min(model.shape + kBurialSpread, 1.0));
  return layer;
}

CraterLayer crater_layer(const SurfaceModel& model, double edge) {
  constexpr double kRimOverDepth = 0.25;
  CraterLayer layer;
  layer.name = "craters";
  layer.seed = kLandformSeed;
  layer.simple.depth = round_to_seven_digits(model.shape);
  layer.simple.rim_height = round_to_seven_digits(kRimOverDepth * model.shape);
  layer.simple.smoothing = 0.2;
  layer.population.emplace().drawn = drawn_landforms(model, edge);
  layer.population->degradation = 0.5;
  layer.population->depth_deviation = 0.3;
  return layer;
}

}  // namespace

const char* name_of(LandformKind kind) {
  if (kind == LandformKind::none) return "none";
  return kind == LandformKind::boulders ? "boulders" : "craters";
}

std::vector<Layer> layers_of(const SurfaceModel& model, double edge, const std::string& group, double width) {
  std::vector<Layer> layers;
  std::optional<Locality> locality;
  if (!group.empty()) locality = Locality{group, round_to_seven_digits(width)};
  if (model.amplitude > 0.0) {
    layers.emplace_back(mask_layer(model, edge));
    FractalLayer noise = noise_layer(model, edge);
    noise.use.locality = locality;
    layers.emplace_back(noise);
  }
  if (model.landforms == LandformKind::boulders) {
    BoulderLayer boulders = boulder_layer(model, edge);
    boulders.population->drawn.locality = locality;
    layers.emplace_back(boulders);
  } else if (model.landforms == LandformKind::craters) {
    CraterLayer craters = crater_layer(model, edge);
    craters.population->drawn.locality = locality;
    layers.emplace_back(craters);
  }
  return layers;
}

std::size_t searched_numbers(LandformKind kind) { return kind == LandformKind::none ? 5 : 9; }

SurfaceModel model_at(const SurfaceModel& centre, const std::vector<double>& x) {
  SurfaceModel model = centre;
  model.amplitude = moved(centre.amplitude, kAmplitudeReach, x[0]);
  model.wavelength = std::clamp(moved(centre.wavelength, kWavelengthReach, x[1]), 6.0, 100.0);
  model.gain = std::clamp(centre.gain + kGainReach * x[2], 0.15, 0.9);
  model.contrast = std::clamp(moved(centre.contrast, kContrastReach, x[3]), 0.03, 8.0);
  model.mask_wavelength = std::clamp(moved(centre.mask_wavelength, kMaskWavelengthReach, x[4]), 6.0, 300.0);
  if (centre.landforms == LandformKind::none) return model;
  model.count = moved(centre.count, kCountReach, x[5]);
  model.exponent = std::clamp(centre.exponent + kExponentReach * x[6], 0.5, 6.0);
  model.greatest = std::max(moved(centre.greatest, kGreatestReach, x[7]), 1.2 * centre.least);
  model.shape = centre.landforms == LandformKind::boulders
                    ? std::clamp(centre.shape + kBurialReach * x[8], 0.15, 0.85)
                    : std::clamp(moved(centre.shape, kDepthReach, x[8]), 0.01, 0.3);
  return model;
}

}  // namespace astrolith
