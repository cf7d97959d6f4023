#include "tasks/synthesis/plane_texture.h"

#include <atomic>
#include <string_view>

#include "numerics/errors.h"
#include "synthesis/gabor/color_texture.h"
#include "synthesis/gabor/gabor_texture.h"

namespace astrolith {
namespace {

GaborLayer first_gabor_layer(const Recipe& recipe, const std::string& file) {
  for (const Layer& layer : recipe.layers) {
    if (const auto* gabor = std::get_if<GaborLayer>(&layer)) return *gabor;
  }
  throw InputError(file + ": layers: hold no Gabor layer, which a texture draws; fit one with fit_gabor");
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
  PlaneTexture texture = colors ? draw_colors(layers, request, options, watched)
                                : draw_heights(first_gabor_layer(recipe, file), request, options, watched);
  if (stopped) throw WorkError("stopped before the texture was complete");
  return texture;
}

}  // namespace astrolith
