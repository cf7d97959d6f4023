#include "synthesis/gabor/color_texture.h"

#include <array>

namespace astrolith {
namespace {

std::array<float, 3> channels(const Vec3d& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

TextureOptions make_options(const PlaneDrawing& drawing) {
  if (!drawing.tileable) return {drawing.recipe.seed};
  return {drawing.recipe.seed, 0, drawing.width, drawing.height};
}

}  // namespace

std::vector<GaborLayer> colored_layers(const Recipe& recipe) {
  std::vector<GaborLayer> layers;
  for (const Layer& layer : recipe.layers) {
    const auto* gabor = std::get_if<GaborLayer>(&layer);
    if (gabor != nullptr && gabor->color) layers.push_back(*gabor);
  }
  return layers;
}

std::vector<float> synthesize_color_texture(const std::vector<GaborLayer>& layers, int width, int height,
                                            const TextureOptions& options, const Progress& progress) {
  std::vector<float> rgb;
  for (std::size_t k = 0; k < layers.size(); ++k) {
    GaborLayer layer = layers[k];
    layer.height_rms = layer.exemplar_rms;
    TextureOptions own = options;
    own.stream += static_cast<int>(k);
    const auto share = [&](double done, std::string_view words) {
      return report(progress, (static_cast<double>(k) + done) / static_cast<double>(layers.size()), words);
    };
    const std::vector<float> noise = synthesize_texture(layer, width, height, own, share);
    rgb.resize(3 * noise.size(), 0.0f);
    const std::array<float, 3> mean = channels(layer.color->mean), axis = channels(layer.color->axis);
    for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] += mean[i % 3] + axis[i % 3] * noise[i / 3];
  }
  return rgb;
}

PlaneTexture heights_on_plane(const GaborLayer& layer, const PlaneDrawing& drawing) {
  PlaneTexture texture;
  const GaborLayer high = with_height(layer, texture);
  texture.height_rms = high.height_rms;
  texture.values =
      synthesize_texture(high, drawing.width, drawing.height, make_options(drawing), drawing.progress);
  return texture;
}

PlaneTexture colors_on_plane(const GaborLayer&, const PlaneDrawing& drawing) {
  const std::vector<GaborLayer> layers = colored_layers(drawing.recipe);
  return {3,
          synthesize_color_texture(layers, drawing.width, drawing.height, make_options(drawing),
                                   drawing.progress),
          layers.size()};
}

}  // namespace astrolith
