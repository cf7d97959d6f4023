#include <utility>

#include "recipe/body_internal.h"
#include "recipe/noise_layers_internal.h"

namespace astrolith {
namespace {

using nlohmann::json;

void read_lobe(const json& value, const Place& place, GaborLobe& out) {
  expect_row(value, place, {"bandwidth", "frequency_x", "frequency_y", "variance"});
  read_value(value[0], place.field("bandwidth"), out.bandwidth);
  read_value(value[1], place.field("frequency_x"), out.frequency_x);
  read_value(value[2], place.field("frequency_y"), out.frequency_y);
  read_value(value[3], place.field("variance"), out.variance);
}

// What a Worley layer's field "distance" says, and the noise it means.
constexpr std::pair<std::string_view, Noise> kWorleyDistances[] = {
    {"f1", Noise::kWorleyF1}, {"f2", Noise::kWorleyF2}, {"f2-f1", Noise::kWorleyF2MinusF1}};

void read_worley_distance(ObjectReader& object, Noise& out) {
  std::string word = "f1";
  object.allow("distance", word);
  for (const auto& [name, noise] : kWorleyDistances) {
    if (word == name) {
      out = noise;
      return;
    }
  }
  object.at("distance").fail("must be \"f1\", \"f2\" or \"f2-f1\", is " + quote_text(word));
}

void read_color(const json& value, const Place& place, LayerColor& out) {
  ObjectReader object(value, place);
  object.require("axis", out.axis);
  object.allow("mean", out.mean);
  object.finish();
}

void read_profile(ObjectReader& object, PhasorProfile& out) {
  std::string word(profile_word(out));
  object.allow("profile", word);
  for (const PhasorProfile profile : kPhasorProfiles) {
    if (word == profile_word(profile)) {
      out = profile;
      return;
    }
  }
  object.at("profile").fail("must be \"sine\", \"triangle\", \"sawtooth\" or \"square\", is " +
                            quote_text(word));
}

void read_part(const json& value, const Place& place, SpotPart& out) {
  ObjectReader object(value, place);
  object.allow("center", out.center);
  object.allow("axes", out.axes);
  object.allow("turn", out.turn);
  object.allow("weight", out.weight);
  object.finish();
}

void read_lattice(ObjectReader& object, CellEdges& out) {
  const json* value = object.find("lattice");
  if (value == nullptr) return;
  const Place place = object.at("lattice");
  expect_row(*value, place, {"edge", "edge", "edge"});
  read_value((*value)[0], place.element(0), out.a);
  read_value((*value)[1], place.element(1), out.b);
  read_value((*value)[2], place.element(2), out.c);
}

}  // namespace

void read_fields(ObjectReader& object, FractalLayer& out) {
  if (is_worley(out.noise)) {
    read_worley_distance(object, out.noise);
  } else {
    object.allow("gradient_modulation", out.gradient_modulation);
  }
  object.allow("amplitude", out.amplitude);
  object.allow("frequency", out.frequency);
  object.allow("octaves", out.octaves);
  object.allow("gain", out.gain);
  object.allow("lacunarity", out.lacunarity);
  object.allow("scale", out.scale);
  object.allow("bias", out.bias);
  object.allow("weight", out.weight);
  read_warp(object, out.warp);
}

void read_fields(ObjectReader& object, GaborLayer& out) {
  object.allow("pixel_size", out.pixel_size);
  object.allow("height_rms", out.height_rms);
  object.allow("impulses_per_kernel", out.impulses_per_kernel);
  object.allow("exemplar_mean", out.exemplar_mean);
  object.allow("exemplar_rms", out.exemplar_rms);
  if (const json* color = object.find("color")) read_color(*color, object.at("color"), out.color.emplace());
  require_elements(object, "lobes", out.lobes, read_lobe);
}

void read_fields(ObjectReader& object, SpotLayer& out) {
  object.allow("amplitude", out.amplitude);
  object.allow("inverted", out.inverted);
  object.allow("size", out.size);
  object.allow("cell_size", out.cell_size);
  read_lattice(object, out.lattice);
  object.allow("density", out.density);
  object.allow("probability", out.probability);
  object.allow("even", out.even);
  object.allow("reach", out.reach);
  object.allow("least_weight", out.least_weight);
  object.allow("gaussian", out.gaussian);
  object.allow("alpha", out.alpha);
  object.allow("kappa", out.kappa);
  object.allow("beta", out.beta);
  object.allow("gamma", out.gamma);
  object.allow("variances", out.variances);
  object.allow("sigma", out.sigma);
  object.allow("layers", out.layers);
  object.allow("lacunarity", out.lacunarity);
  object.allow("gain", out.gain);
  object.allow("exponent", out.exponent);
  if (const json* parts = object.find("parts"))
    read_elements(*parts, object.at("parts"), out.parts, read_part);
}

void read_fields(ObjectReader& object, SparseLayer& out) {
  object.allow("amplitude", out.amplitude);
  object.allow("cell_size", out.cell_size);
  object.allow("levels", out.levels);
  object.allow("probability", out.probability);
  object.allow("threshold", out.threshold);
  object.allow("gain", out.gain);
  object.allow("merged", out.merged);
}

void read_fields(ObjectReader& object, RandomPhaseLayer& out) {
  object.allow("height_rms", out.height_rms);
  object.allow("cell_size", out.cell_size);
  object.allow("waves", out.waves);
  object.allow("frequency_min", out.frequency_min);
  object.allow("frequency_max", out.frequency_max);
  object.allow("exponent", out.exponent);
  object.allow("direction", out.direction);
  object.allow("spread", out.spread);
  object.allow("randomness", out.randomness);
}

void read_fields(ObjectReader& object, PhasorLayer& out) {
  object.allow("amplitude", out.amplitude);
  object.allow("frequency", out.frequency);
  object.allow("cell_size", out.cell_size);
  object.allow("impulses_per_cell", out.impulses_per_cell);
  object.allow("direction", out.direction);
  object.allow("spread", out.spread);
  read_profile(object, out.profile);
}

}  // namespace astrolith
