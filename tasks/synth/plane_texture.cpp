#include "tasks/synth/plane_texture.h"

#include <algorithm>
#include <atomic>
#include <string_view>

#include "numerics/errors.h"
#include "synthesis/exemplar/plane_exemplar.h"
#include "synthesis/gabor/color_texture.h"
#include "synthesis/picture/surface_maps.h"

namespace astrolith {
namespace {

// The index of the first layer with a colour; the number of layers where none has one.
std::size_t first_colored_layer(const Recipe& recipe) {
  const auto found = std::find_if(recipe.layers.begin(), recipe.layers.end(), has_color);
  return static_cast<std::size_t>(found - recipe.layers.begin());
}

// The index of the first layer that a plane can show.
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
class TextureDrawing {
 public:
  TextureDrawing(const Recipe& recipe, const std::string& file, const PlaneTextureRequest& request,
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
  TextureDrawing(const TextureDrawing&) = delete;
  TextureDrawing& operator=(const TextureDrawing&) = delete;

  PlaneTexture heights(std::size_t i) {
    return finished(with_plane_layer<PlaneTexture>(
        recipe_.layers[i], [&](const auto& layer) { return heights_on_plane(layer, drawing(i)); }));
  }
  PlaneTexture colors(std::size_t i) {
    return finished(with_plane_layer<PlaneTexture>(
        recipe_.layers[i], [&](const auto& layer) { return colors_on_plane(layer, drawing(i)); }));
  }

  const Progress& progress() const { return progress_; }
  void expect_complete() const {
    if (stopped_) throw WorkError("stopped before the texture was complete");
  }

 private:
  PlaneDrawing drawing(std::size_t i) const {
    return {recipe_,
            i,
            file_ + ": layers[" + std::to_string(i) + "]",
            request_.width,
            request_.height,
            request_.tileable,
            progress_};
  }
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
  TextureDrawing drawing(recipe, file, request, progress);
  const std::size_t colored = first_colored_layer(recipe);
  const bool has_color = colored < recipe.layers.size();
  if (request.content == "color" && !has_color) {
    throw InputError(
        file + ": layers: none has a color; fit a photo with fit_gabor --channels pca, or draw the height");
  }
  const bool colors = has_color && request.content != "height";
  return colors ? drawing.colors(colored) : drawing.heights(first_plane_layer(recipe, file));
}

PlaneMaterial draw_material(const Recipe& recipe, const std::string& file, const PlaneTextureRequest& request,
                            const Progress& progress) {
  const std::size_t first = first_plane_layer(recipe, file);
  const std::string place = file + ": layers[" + std::to_string(first) + "]";
  const Layer& layer = recipe.layers[first];
  TextureDrawing drawing(recipe, file, request, progress);
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
