#include "tasks/synthesis/plane_texture.h"

#include <atomic>
#include <string_view>

#include "numerics/errors.h"
#include "synthesis/exemplar/exemplar_texture.h"
#include "synthesis/exemplar/plane_exemplar.h"
#include "synthesis/gabor/color_texture.h"
#include "synthesis/gabor/gabor_texture.h"
#include "synthesis/picture/surface_maps.h"

namespace astrolith {
namespace {

// The place of the first layer with a colour; the number of layers where none has one.
std::size_t first_colored_layer(const Recipe& recipe) {
  std::size_t i = 0;
  for (; i < recipe.layers.size(); ++i) {
    const auto* gabor = std::get_if<GaborLayer>(&recipe.layers[i]);
    const auto* exemplar = std::get_if<ExemplarLayer>(&recipe.layers[i]);
    if ((gabor != nullptr && gabor->color) || (exemplar != nullptr && exemplar->color)) break;
  }
  return i;
}

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

PlaneTexture draw_colors(const ExemplarLayer& layer, std::size_t index, const std::string& file,
                         const PlaneTextureRequest& request, std::uint64_t seed, const Progress& progress) {
  PlaneTexture texture;
  texture.channels = 3;
  const std::string place = file + ": layers[" + std::to_string(index) + "]";
  const int number = layer_number(layer.seed, static_cast<int>(index));
  texture.values = synthesize_exemplar_colors(layer, place, request.width, request.height,
                                              {seed, number, request.tileable}, progress);
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

// The side of a pixel of a Gabor or exemplar layer, length units.
double pixel_size_of(const Layer& layer) {
  const auto* exemplar = std::get_if<ExemplarLayer>(&layer);
  return exemplar != nullptr ? exemplar->pixel_size : std::get<GaborLayer>(layer).pixel_size;
}

TextureOptions gabor_options(const Recipe& recipe, const PlaneTextureRequest& request) {
  TextureOptions options{recipe.seed};
  if (request.tileable) {
    options.period_width = request.width;
    options.period_height = request.height;
  }
  return options;
}

// A recipe's textures, with one progress that remembers whether it was told to stop.
class PlaneDrawing {
 public:
  PlaneDrawing(const Recipe& recipe, const std::string& file, const PlaneTextureRequest& request,
               const Progress& progress)
      : recipe_(recipe), file_(file), request_(request) {
    check_side(request.width);
    check_side(request.height);
    progress_ = [this, &progress](double fraction, std::string_view words) {
      const bool go_on = report(progress, fraction, words);
      if (!go_on) stopped_ = true;
      return go_on;
    };
  }
  PlaneDrawing(const PlaneDrawing&) = delete;
  PlaneDrawing& operator=(const PlaneDrawing&) = delete;

  PlaneTexture heights(std::size_t i) {
    const auto* exemplar = std::get_if<ExemplarLayer>(&recipe_.layers[i]);
    return finished(exemplar != nullptr ? draw_heights(*exemplar, i, file_, request_, recipe_.seed, progress_)
                                        : draw_heights(std::get<GaborLayer>(recipe_.layers[i]), request_,
                                                       gabor_options(recipe_, request_), progress_));
  }

  // The colours of an exemplar layer, or of all Gabor layers that have one.
  PlaneTexture colors(std::size_t i) {
    const auto* exemplar = std::get_if<ExemplarLayer>(&recipe_.layers[i]);
    return finished(exemplar != nullptr ? draw_colors(*exemplar, i, file_, request_, recipe_.seed, progress_)
                                        : draw_colors(colored_layers(recipe_), request_,
                                                      gabor_options(recipe_, request_), progress_));
  }

  const Progress& progress() const { return progress_; }
  void expect_complete() const {
    if (stopped_) throw WorkError("stopped before the texture was complete");
  }

 private:
  PlaneTexture finished(PlaneTexture texture) const {
    expect_complete();
    return texture;
  }

  const Recipe& recipe_;
  const std::string& file_;
  const PlaneTextureRequest& request_;
  Progress progress_;
  std::atomic<bool> stopped_{false};
};

}  // namespace

PlaneTexture draw_texture(const Recipe& recipe, const std::string& file, const PlaneTextureRequest& request,
                          const Progress& progress) {
  PlaneDrawing drawing(recipe, file, request, progress);
  const std::size_t colored = first_colored_layer(recipe);
  const bool has_color = colored < recipe.layers.size();
  if (request.content == "color" && !has_color) {
    throw InputError(file +
                     ": layers: none has a color; fit a photo with fit_gabor --channels pca, or draw the "
                     "height");
  }
  const bool colors = has_color && request.content != "height";
  return colors ? drawing.colors(colored) : drawing.heights(first_plane_layer(recipe, file));
}

PlaneMaterial draw_material(const Recipe& recipe, const std::string& file, const PlaneTextureRequest& request,
                            const Progress& progress) {
  const std::size_t first = first_plane_layer(recipe, file);
  const std::string place = file + ": layers[" + std::to_string(first) + "]";
  const Layer& layer = recipe.layers[first];
  PlaneDrawing drawing(recipe, file, request, progress);
  PlaneMaterial material;
  material.pixel_size = pixel_size_of(layer);
  material.height = drawing.heights(first);
  if (!material.height.has_height) {
    throw InputError(place + ".height_rms: is 0, and a material needs a relief; state the height");
  }
  if (first_colored_layer(recipe) == first) material.color = drawing.colors(first);
  const HeightGrid grid{material.height.values, request.width, request.height, material.pixel_size,
                        request.tileable};
  material.normal = normal_map(grid, drawing.progress());
  material.occlusion = occlusion_map(grid, drawing.progress());
  drawing.expect_complete();
  return material;
}

}  // namespace astrolith
