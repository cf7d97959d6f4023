#include "tasks/synthesis/plane_texture.h"

#include <atomic>
#include <string_view>

#include "numerics/errors.h"
#include "synthesis/exemplar/exemplar_texture.h"
#include "synthesis/exemplar/plane_exemplar.h"
#include "synthesis/gabor/color_texture.h"
#include "synthesis/gabor/gabor_texture.h"

namespace astrolith {
namespace {

// The place of the first layer that a plane can show.
std::size_t first_plane_layer(const Recipe& recipe, const std::string& file) {
  for (std::size_t i = 0; i < recipe.layers.size(); ++i) {
    const Layer& layer = recipe.layers[i];
    if (std::holds_alternative<GaborLayer>(layer) || std::holds_alternative<ExemplarLayer>(layer)) return i;
  }
  throw InputError(
      file + ": layers: hold no Gabor or exemplar layer, which a texture draws; make one with fit_gabor");
}

void check_side(int side) {
  if (side >= 1 && side <= kMaxTextureSide) return;
  throw InputError("texture: a side of " + std::to_string(side) + " pixels; give 1 to " +
                   std::to_string(kMaxTextureSide));
}

PlaneTexture draw_heights(GaborLayer layer, const PlaneTextureRequest& request, const TextureOptions& options,
                          const Progress& progress) {
  PlaneTexture texture;
  // A layer without a height is drawn in units of its own standard deviation.
  texture.has_height = layer.height_rms > 0.0;
  if (!texture.has_height) layer.height_rms = 1.0;
  texture.height_rms = layer.height_rms;
  texture.values = synthesize_texture(layer, request.width, request.height, options, progress);
  return texture;
}

PlaneTexture draw_heights(ExemplarLayer layer, std::size_t index, const std::string& file,
                          const PlaneTextureRequest& request, std::uint64_t seed, const Progress& progress) {
  PlaneTexture texture;
  texture.has_height = layer.has_height();
  if (!texture.has_height) layer.height_rms = 1.0;
  const std::string place = file + ": layers[" + std::to_string(index) + "]";
  const int number = layer_number(layer.seed, static_cast<int>(index));
  texture.values = synthesize_exemplar(layer, place, request.width, request.height,
                                       {seed, number, request.tileable}, progress);
  texture.height_rms = exemplar_height_rms(layer);
  return texture;
}

PlaneTexture draw_colors(const std::vector<GaborLayer>& layers, const PlaneTextureRequest& request,
                         const TextureOptions& options, const Progress& progress) {
  PlaneTexture texture;
  texture.channels = 3;
  texture.layers = layers.size();
  texture.values = synthesize_color_texture(layers, request.width, request.height, options, progress);
  return texture;
}

}  // namespace

PlaneTexture draw_texture(const Recipe& recipe, const std::string& file, const PlaneTextureRequest& request,
                          const Progress& progress) {
  check_side(request.width);
  check_side(request.height);
  const std::vector<GaborLayer> layers = colored_layers(recipe);
  if (request.content == "color" && layers.empty()) {
    throw InputError(file +
                     ": layers: none has a color; fit a photo with fit_gabor --channels pca, or draw the "
                     "height");
  }
  TextureOptions options{recipe.seed};
  if (request.tileable) {
    options.period_width = request.width;
    options.period_height = request.height;
  }
  std::atomic<bool> stopped{false};
  const Progress watched = [&](double fraction, std::string_view words) {
    const bool go_on = report(progress, fraction, words);
    if (!go_on) stopped = true;
    return go_on;
  };
  const bool colors = !layers.empty() && request.content != "height";
  PlaneTexture texture;
  if (colors) {
    texture = draw_colors(layers, request, options, watched);
  } else {
    const std::size_t first = first_plane_layer(recipe, file);
    const auto* exemplar = std::get_if<ExemplarLayer>(&recipe.layers[first]);
    texture = exemplar != nullptr
                  ? draw_heights(*exemplar, first, file, request, recipe.seed, watched)
                  : draw_heights(std::get<GaborLayer>(recipe.layers[first]), request, options, watched);
  }
  if (stopped) throw WorkError("stopped before the texture was complete");
  return texture;
}

}  // namespace astrolith
