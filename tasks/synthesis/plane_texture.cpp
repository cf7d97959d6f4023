#include "tasks/synthesis/plane_texture.h"

#include <algorithm>
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
  const auto found = std::find_if(recipe.layers.begin(), recipe.layers.end(), has_color);
  return static_cast<std::size_t>(found - recipe.layers.begin());
}

// The place of the first layer that a plane can show.
std::size_t first_plane_layer(const Recipe& recipe, const std::string& file) {
  for (std::size_t i = 0; i < recipe.layers.size(); ++i) {
    if (traits_of(recipe.layers[i]).in_plane) return i;
  }
  throw InputError(
      file + ": layers: hold no Gabor or exemplar layer, which a texture draws; make one with fit_gabor");
}

void check_side(int side) {
  if (side >= 1 && side <= kMaxTextureSide) return;
  throw InputError("texture: a side of " + std::to_string(side) + " pixels; give 1 to " +
                   std::to_string(kMaxTextureSide));
}

// A layer that is drawn.
struct PlaneJob {
  const Recipe& recipe;
  const std::string& file;
  std::size_t index;  // of the layer
  const PlaneTextureRequest& request;
  const Progress& progress;

  std::string place() const { return file + ": layers[" + std::to_string(index) + "]"; }
};

TextureOptions gabor_options(const PlaneJob& job) {
  TextureOptions options{job.recipe.seed};
  if (job.request.tileable) {
    options.period_width = job.request.width;
    options.period_height = job.request.height;
  }
  return options;
}

PlaneTexture draw_heights(GaborLayer layer, const PlaneJob& job) {
  PlaneTexture texture;
  // A layer without a height is drawn in units of its own standard deviation.
  texture.has_height = layer.has_height();
  if (!texture.has_height) layer.height_rms = 1.0;
  texture.height_rms = layer.height_rms;
  texture.values =
      synthesize_texture(layer, job.request.width, job.request.height, gabor_options(job), job.progress);
  return texture;
}

PlaneTexture draw_heights(ExemplarLayer layer, const PlaneJob& job) {
  PlaneTexture texture;
  texture.has_height = layer.has_height();
  if (!texture.has_height) layer.height_rms = 1.0;
  const int number = layer_number(layer.seed, static_cast<int>(job.index));
  texture.values = synthesize_exemplar(layer, job.place(), job.request.width, job.request.height,
                                       {job.recipe.seed, number, job.request.tileable}, job.progress);
  texture.height_rms = exemplar_height_rms(layer);
  return texture;
}

PlaneTexture draw_colors(const ExemplarLayer& layer, const PlaneJob& job) {
  PlaneTexture texture;
  texture.channels = 3;
  const int number = layer_number(layer.seed, static_cast<int>(job.index));
  texture.values = synthesize_exemplar_colors(layer, job.place(), job.request.width, job.request.height,
                                              {job.recipe.seed, number, job.request.tileable}, job.progress);
  return texture;
}

// The colours of all Gabor layers that have one, since each has only one axis of an image's colours.
PlaneTexture draw_colors(const GaborLayer&, const PlaneJob& job) {
  const std::vector<GaborLayer> layers = colored_layers(job.recipe);
  PlaneTexture texture;
  texture.channels = 3;
  texture.layers = layers.size();
  texture.values = synthesize_color_texture(layers, job.request.width, job.request.height, gabor_options(job),
                                            job.progress);
  return texture;
}

// Calls use(layer) with a layer that a plane can show. Expects that it can.
template <class Result, class Use>
Result with_plane_layer(const Layer& layer, const Use& use) {
  return std::visit(
      [&]<class Kind>(const Kind& l) -> Result {
        if constexpr (Kind::kTraits.in_plane) {
          return use(l);
        } else {
          return {};
        }
      },
      layer);
}

// The side of a pixel of a layer that a plane can show, length units.
double pixel_size_of(const Layer& layer) {
  return with_plane_layer<double>(layer, [](const auto& l) { return l.pixel_size; });
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
    return finished(with_plane_layer<PlaneTexture>(
        recipe_.layers[i], [&](const auto& layer) { return draw_heights(layer, job(i)); }));
  }
  PlaneTexture colors(std::size_t i) {
    return finished(with_plane_layer<PlaneTexture>(
        recipe_.layers[i], [&](const auto& layer) { return draw_colors(layer, job(i)); }));
  }

  const Progress& progress() const { return progress_; }
  void expect_complete() const {
    if (stopped_) throw WorkError("stopped before the texture was complete");
  }

 private:
  PlaneJob job(std::size_t i) const { return {recipe_, file_, i, request_, progress_}; }
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
