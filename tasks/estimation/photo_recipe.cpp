#include "tasks/estimation/photo_recipe.h"

#include <string>
#include <utility>

#include "numerics/files/sha256.h"
#include "numerics/length_unit.h"
#include "recipe/recipe_json.h"
#include "synthesis/picture/image_file.h"

namespace astrolith {
namespace {

GaborLayer make_layer(const PhotoRecipeOptions& o, const FittedChannel& channel, bool first) {
  GaborLayer layer = make_gabor_layer(channel, first);
  layer.name = o.layer_name;
  layer.pixel_size = o.mm_per_px > 0.0 ? o.mm_per_px / (1e3 * metres_per_unit(o.unit)) : 1.0;
  if (first) layer.height_rms = o.height_rms >= 0.0 ? o.height_rms : layer.height_rms * o.unit_per_value;
  return layer;
}

nlohmann::ordered_json details(const Gaussianity& g) {
  return {{"plausible", g.plausible()},           {"skewness", g.skewness},
          {"excess_kurtosis", g.excess_kurtosis}, {"edge_kurtosis", g.edge_kurtosis},
          {"variance_spread", g.variance_spread}, {"sentence", g.sentence}};
}

nlohmann::ordered_json details(const std::vector<BandVariance>& bands) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const BandVariance& band : bands) {
    list.push_back(
        {{"cycles_per_pixel", {band.lowest, band.highest}}, {"photo", band.photo}, {"noise", band.noise}});
  }
  return list;
}

nlohmann::ordered_json details(const FittedChannel& channel) {
  const GaborFit& fit = channel.fit;
  const LobeQuality& q = fit.quality;
  nlohmann::ordered_json figures = {{"lobes", fit.lobes.size()},
                                    {"pursuit_lobes", fit.pursuit_lobes},
                                    {"pursuit_gap", fit.pursuit.relative_gap},
                                    {"pursuit_reached", fit.pursuit.reached},
                                    {"refinement_reached", fit.refinement_reached},
                                    {"spectrum_distance", fit.spectrum_distance},
                                    {"periodogram_distance", q.periodogram_distance},
                                    {"perfect_periodogram_distance", q.perfect_distance},
                                    {"spectrum_residual", q.residual},
                                    {"weak_above", q.weak_above},
                                    {"weak", q.weak()},
                                    {"band_overlap", q.band_overlap},
                                    {"bands", details(q.bands)},
                                    {"variance", channel.variance()},
                                    {"pixel_variance", channel.pixel_variance()},
                                    {"variance_ratio_before_scaling", fit.variance_before_scaling}};
  // A fit that was stopped ends at once, without this test.
  if (channel.gaussianity) figures["gaussianity"] = channel.gaussianity->p_value;
  return figures;
}

}  // namespace

namespace fs = std::filesystem;

Recipe exemplar_recipe(ExemplarLayer layer, const PhotoRecipeOptions& options) {
  layer.name = options.layer_name;
  if (options.mm_per_px > 0.0) layer.pixel_size = options.mm_per_px / (1e3 * metres_per_unit(options.unit));
  layer.height_rms =
      options.height_rms >= 0.0 ? options.height_rms : layer.height_rms * options.unit_per_value;
  Recipe recipe;
  recipe.length_unit = options.mm_per_px > 0.0 ? options.unit : "px";
  recipe.seed = options.seed;
  recipe.layers = {std::move(layer)};
  return recipe;
}

fs::path exemplar_image_path(const fs::path& recipe) {
  return fs::path(recipe).replace_filename(recipe.stem().string() + "_exemplar.png");
}

void write_exemplar_recipe(Recipe recipe, const fs::path& file) {
  const fs::path image = exemplar_image_path(file);
  auto& layer = std::get<ExemplarLayer>(recipe.layers.front());
  const ExemplarImage& pixels = *layer.pixels;
  if (layer.color) {
    write_png16_rgb(pixels.rgb, pixels.width, pixels.height, image);
  } else {
    write_png16_grey(pixels.values, pixels.width, pixels.height, image);
  }
  layer.image = image.filename().string();
  layer.image_sha256 = file_sha256(image);
  write_recipe(recipe, file);
}

Recipe photo_recipe(const PhotoFit& photo, const PhotoRecipeOptions& o) {
  Recipe recipe;
  recipe.length_unit = o.mm_per_px > 0.0 ? o.unit : "px";
  recipe.seed = o.seed;
  recipe.provenance.achieved = {{"band_overlap", photo.band_overlap()},
                                {"pursuit_gap", photo.pursuit_gap()},
                                {"spectrum_distance", photo.spectrum_distance()},
                                {"spectrum_residual", photo.spectrum_residual()}};
  for (const FittedChannel& channel : photo.channels)
    recipe.layers.push_back(make_layer(o, channel, recipe.layers.empty()));
  return recipe;
}

nlohmann::ordered_json photo_figures(const PhotoFit& photo) {
  nlohmann::ordered_json s;
  s["lobes"] = photo.lobes();
  s["pursuit_gap"] = photo.pursuit_gap();
  s["pursuit_reached"] = photo.pursuit_reached();
  s["refinement_reached"] = photo.refinement_reached();
  s["spectrum_distance"] = photo.spectrum_distance();
  s["spectrum_residual"] = photo.spectrum_residual();
  s["weak_above"] = photo.weak_above();
  s["weak"] = photo.weak();
  s["band_overlap"] = photo.band_overlap();
  s["variance_in_spectrum"] = photo.variance_in_spectrum();
  int iterations = 0;
  double before_scaling = 0.0, variance = 0.0;
  for (const FittedChannel& channel : photo.channels) {
    iterations += channel.fit.pursuit.iterations;
    before_scaling += channel.fit.variance_before_scaling * channel.variance();
    variance += channel.variance();
    s["channels"].push_back(details(channel));
  }
  s["variance_ratio_before_scaling"] = before_scaling / variance;
  s["iterations"] = iterations;
  return s;
}

nlohmann::ordered_json gaussianity_figures(const Gaussianity& gaussianity) {
  return {{"gaussianity", gaussianity.p_value}, {"gaussianity_details", details(gaussianity)}};
}

}  // namespace astrolith
