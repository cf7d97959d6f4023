#include "tasks/synth/texture.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "numerics/errors.h"
#include "synthesis/exemplar/plane_exemplar.h"
#include "synthesis/gabor/color_texture.h"
#include "synthesis/picture/image_file.h"
#include "synthesis/picture/surface_maps.h"
#include "tasks/job/pixel_size.h"
#include "tasks/job/words.h"

namespace astrolith {
namespace {

namespace fs = std::filesystem;

// The index of the first layer with a colour; the number of layers where none has one.
std::size_t first_colored_layer(const Recipe& recipe) {
  const auto found = std::find_if(recipe.layers.begin(), recipe.layers.end(), has_color);
  return static_cast<std::size_t>(found - recipe.layers.begin());
}

// The index of the first layer that a plane can show.
std::size_t first_plane_layer(const Recipe& recipe, const std::string& file) {
  for (std::size_t i = 0; i < recipe.layers.size(); ++i) {
    if (layer_traits(recipe.layers[i]).in_plane) return i;
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
double layer_pixel_size(const Layer& layer) {
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

// The maps of a material, which belong to the same pixels of the recipe's first Gabor or exemplar layer.
struct PlaneMaterial {
  PlaneTexture height;
  std::optional<PlaneTexture> color;  // absent where the layer has no color
  std::vector<float> normal;          // normal_map() of the heights
  std::vector<float> occlusion;       // occlusion_map() of the heights
  double pixel_size = 1.0;            // length units
};

// Draws a material; the request's content is not read. Throws as draw_texture() does, and InputError for a
// layer without a height.
PlaneMaterial draw_material(const Recipe& recipe, const std::string& file, const PlaneTextureRequest& request,
                            const Progress& progress) {
  const std::size_t first = first_plane_layer(recipe, file);
  const std::string place = file + ": layers[" + std::to_string(first) + "]";
  const Layer& layer = recipe.layers[first];
  TextureDrawing drawing(recipe, file, request, progress);
  PlaneMaterial material;
  material.pixel_size = layer_pixel_size(layer);
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

// PNG heights map this many standard deviations either way to the full range.
constexpr double kTextureRange = 4.0;

// Turns values into whole numbers from 0 to `top`: offset + scale * value, clamped to [0, 1], times `top`.
template <typename Integer>
std::vector<Integer> quantised(std::span<const float> values, double offset, double scale, double top) {
  std::vector<Integer> whole;
  whole.reserve(values.size());
  for (const float value : values) {
    const double t = std::clamp(offset + scale * static_cast<double>(value), 0.0, 1.0);
    whole.push_back(static_cast<Integer>(std::lround(top * t)));
  }
  return whole;
}

struct Picture {
  PixelSize size;
  int channels;  // 1 or 3
  const std::vector<float>& values;
  double offset, scale;  // offset + scale * value lies in [0, 1] for a PNG
};

void write_picture(const Picture& p, int bits, const fs::path& output) {
  const auto [width, height] = p.size;
  if (output.extension() != ".png") return write_tiff_float(p.values, width, height, output, p.channels);
  if (bits == 8) {
    std::vector<std::uint8_t> bytes = quantised<std::uint8_t>(p.values, p.offset, p.scale, 255.0);
    if (p.channels == 3) return write_png8_rgb({width, height, std::move(bytes)}, output);
    return write_png8_grey(bytes, width, height, output);
  }
  const std::vector<std::uint16_t> words = quantised<std::uint16_t>(p.values, p.offset, p.scale, 65535.0);
  if (p.channels == 3) return write_png16_rgb(words, width, height, output);
  write_png16_grey(words, width, height, output);
}

void write_heights(Job& job, const TextureRequest& request, const Recipe& recipe, const PlaneTexture& texture,
                   const PixelSize& size, const fs::path& output) {
  const double rms = texture.height_rms;
  write_picture({size, 1, texture.values, 0.5, 0.5 / (kTextureRange * rms)}, request.bits, output);
  job.summary["content"] = "height";
  job.summary["height_unit"] = texture.has_height ? recipe.length_unit : "standard deviations";
  job.summary["height_rms"] = rms;
  if (output.extension() == ".png") {
    job.summary["height_at_0"] = -kTextureRange * rms;
    job.summary[request.bits == 8 ? "height_at_255" : "height_at_65535"] = kTextureRange * rms;
  }
  job.say(output.string() + ": height of a texture layer, " + request.size + " pixels");
}

void write_colors(Job& job, const TextureRequest& request, const PlaneTexture& texture, const PixelSize& size,
                  const fs::path& output) {
  const std::vector<float>& rgb = texture.values;
  write_picture({size, 3, rgb, 0.0, 1.0}, request.bits, output);
  const auto outside = std::count_if(rgb.begin(), rgb.end(), [](float v) { return v < 0.0f || v > 1.0f; });
  job.summary["content"] = "color";
  job.summary["layers"] = texture.layers;
  job.summary["share_outside_full_scale"] = static_cast<double>(outside) / static_cast<double>(rgb.size());
  job.say(output.string() + ": colours of " +
          counted(static_cast<std::size_t>(texture.layers), "texture layer") + ", " + request.size +
          " pixels");
}

// "rock.png" and "normal" give "rock_normal" with the extension.
fs::path map_name(const fs::path& output, const std::string& map, const char* extension) {
  return fs::path(output).replace_filename(output.stem().string() + "_" + map + extension);
}

// The files of a material, by their map.
struct MaterialFiles {
  explicit MaterialFiles(const fs::path& output)
      : height(map_name(output, "height", ".tif")),
        color(map_name(output, "color", ".png")),
        normal(map_name(output, "normal", ".png")),
        occlusion(map_name(output, "occlusion", ".png")) {}
  fs::path height, color, normal, occlusion;
};

void summarize_material(Job& job, const Recipe& recipe, const PlaneMaterial& material,
                        const MaterialFiles& files) {
  const auto [low, high] = std::minmax_element(material.height.values.begin(), material.height.values.end());
  job.summary["content"] = "material";
  job.summary["height_unit"] = recipe.length_unit;
  job.summary["pixel_size"] = material.pixel_size;
  job.summary["height_rms"] = material.height.height_rms;
  job.summary["least_height"] = *low;
  job.summary["greatest_height"] = *high;
  job.summary["normal_convention"] = "OpenGL";
  job.summary["occlusion_reach"] = kOcclusionReach;
  job.summary["files"]["height"] = files.height.string();
  if (material.color) job.summary["files"]["color"] = files.color.string();
  job.summary["files"]["normal"] = files.normal.string();
  job.summary["files"]["occlusion"] = files.occlusion.string();
}

void write_material(Job& job, const TextureRequest& request, const Recipe& recipe, const fs::path& file,
                    const fs::path& output, const PixelSize& size) {
  const MaterialFiles files(output);
  const PlaneMaterial material = draw_material(
      recipe, file.string(), {size.width, size.height, "", request.tileable}, job.progress("texture"));
  write_tiff_float(material.height.values, size.width, size.height, files.height);
  if (material.color) write_picture({size, 3, material.color->values, 0.0, 1.0}, request.bits, files.color);
  write_picture({size, 3, material.normal, 0.5, 0.5}, request.bits, files.normal);
  write_picture({size, 1, material.occlusion, 0.0, 1.0}, request.bits, files.occlusion);
  summarize_material(job, recipe, material, files);
  job.say(files.height.string() + ": height in " + recipe.length_unit +
          (material.color ? "; with it colour, normals" : "; with it normals (no layer has a color)") +
          " and occlusion as .png, " + request.size + " pixels");
}

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

std::vector<fs::path> texture_files(const TextureRequest& request, const fs::path& output) {
  if (request.content != "material") return {output};
  const MaterialFiles files(output);
  return {files.height, files.color, files.normal, files.occlusion};
}

void declare_texture_options(Job& job, TextureRequest& request) {
  OptionTable& app = job.options;
  app.add_option("--texture", request.size,
                 "a plane of WxH pixels instead of a mesh: the colours of the recipe's layers where they "
                 "have some (0 to 1 in a .tif of 32-bit floats, full scale in a .png; see fit_gabor "
                 "--channels), otherwise the height of its first Gabor or exemplar layer (a .tif holds "
                 "heights, a .png "
                 "maps -4 to +4 standard deviations to its full scale)")
      .placeholder("WxH");
  app.add_option("--texture-of", request.content,
                 "what --texture draws: height, color, or material: of -o rock.png the files rock_height.tif "
                 "(32-bit floats, length units), rock_color.png, rock_normal.png (OpenGL: x right, y up) and "
                 "rock_occlusion.png (open sky in 16 directions up to 64 pixels away)")
      .check(one_of({"height", "color", "material"}))
      .default_text("");
  app.add_flag("--tileable", request.tileable, "the texture repeats without a seam in both directions");
  app.add_option("--bits", request.bits, "bits for each channel of a texture's .png")
      .check(one_of({8, 16}))
      .needs(app.option("--texture"));
}

void write_texture(Job& job, const TextureRequest& request, const Recipe& recipe, const fs::path& file,
                   const fs::path& output) {
  const PixelSize size = parse_pixel_size("--texture", request.size, 1, kMaxTextureSide);
  job.summary["width"] = size.width;
  job.summary["height"] = size.height;
  job.summary["tileable"] = request.tileable;
  if (request.content == "material") return write_material(job, request, recipe, file, output, size);
  const PlaneTexture texture =
      draw_texture(recipe, file.string(), {size.width, size.height, request.content, request.tileable},
                   job.progress("texture"));
  if (texture.channels == 3) return write_colors(job, request, texture, size, output);
  write_heights(job, request, recipe, texture, size, output);
}

}  // namespace astrolith
