#include "tasks/job/load_recipe.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "geometry/io/mesh_io.h"
#include "numerics/errors.h"
#include "numerics/files/input_file.h"
#include "numerics/files/relative_path.h"
#include "numerics/files/sha256.h"
#include "recipe/recipe_json.h"
#include "synthesis/picture/image_file.h"
#include "tasks/job/body_library.h"

namespace astrolith {
namespace {

// A PNG of the largest exemplar takes less.
constexpr std::uintmax_t kMostImageBytes = std::uintmax_t{1} << 28;

std::vector<std::uint8_t> read_bytes(const std::filesystem::path& file, const std::string& place) {
  require_plain_file(file, place + ": ");
  const std::uintmax_t size = std::filesystem::file_size(file);
  if (size > kMostImageBytes) {
    throw InputError(place + ": " + file.string() + " is larger than 256 MB; scale the image down");
  }
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size));
  std::ifstream stream(file, std::ios::binary);
  if (!stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size))) {
    throw InputError(place + ": " + file.string() + " cannot be read; check its permissions");
  }
  return bytes;
}

bool same_digits(const std::string& a, const std::string& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

// Decodes an image; without `keeps_colors` only its grey values.
void load_image(NamedImage& named, bool keeps_colors, const std::filesystem::path& folder,
                const std::string& place) {
  const std::filesystem::path file = folder / named.image;
  const std::vector<std::uint8_t> bytes = read_bytes(file, place + ".image");
  const std::string digits = sha256({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  if (!same_digits(digits, named.image_sha256)) {
    throw InputError(place + ".image: " + file.string() +
                     " has changed since the recipe was written; restore it, or state its SHA-256 " + digits);
  }
  GreyPng png =
      decode_grey_png(bytes, place + ".image: " + file.string(), kLeastExemplarSide, kMostExemplarSide);
  if (!keeps_colors) png.rgb.clear();
  named.pixels = std::make_shared<ExemplarImage>(ExemplarImage{
      png.width, png.height, std::move(png.values), std::filesystem::absolute(file), std::move(png.rgb)});
}

// Throws InputError for a mesh or a photo, of which a fit makes a recipe.
void refuse_fit_input(const std::filesystem::path& file) {
  const std::string extension = mesh_extension(file);
  const auto has_one = [&](std::initializer_list<const char*> extensions) {
    return std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
  };
  if (has_mesh_extension(file)) {
    throw InputError(file.string() + ": is a mesh and no recipe; fit_shape makes a recipe of it");
  }
  if (has_one({".png", ".jpg", ".jpeg", ".tif", ".tiff"})) {
    throw InputError(file.string() + ": is a picture and no recipe; fit_gabor makes a recipe of a photo");
  }
}

// The name of the image of a recipe's first relief, and of further ones: bennu.relief.png,
// bennu.relief_1.png.
std::filesystem::path relief_image_name(const std::filesystem::path& recipe, int number) {
  std::filesystem::path name = recipe;
  return name.replace_extension(number == 0 ? ".relief.png" : ".relief_" + std::to_string(number) + ".png");
}

// Writes pixels that no file holds yet, and names the file in the layer.
void write_image(NamedImage& named, const std::filesystem::path& file) {
  write_png16_grey(named.pixels->values, named.pixels->width, named.pixels->height, file);
  named.image = file.filename().string();
  named.image_sha256 = file_sha256(file);
}

}  // namespace

void load_images(Recipe& recipe, const std::filesystem::path& folder, const std::string& name) {
  for (std::size_t i = 0; i < recipe.layers.size(); ++i) {
    Layer& layer = recipe.layers[i];
    NamedImage* named = find_image(layer);
    if (named != nullptr && named->pixels == nullptr) {
      load_image(*named, has_color(layer), folder, name + ": layers[" + std::to_string(i) + "]");
    }
  }
}

Recipe load_recipe(const std::filesystem::path& file) {
  refuse_fit_input(file);
  Recipe recipe = read_recipe(find_body(file));
  load_images(recipe, file.parent_path(), file.string());
  return recipe;
}

void write_loaded_recipe(Recipe recipe, const std::filesystem::path& file) {
  int number = 0;
  for (Layer& layer : recipe.layers) {
    NamedImage* named = find_image(layer);
    if (named == nullptr || named->pixels == nullptr) continue;
    if (auto* relief = std::get_if<ReliefLayer>(&layer)) {
      if (is_compact_name(file)) {
        relief->image.clear(), relief->image_sha256.clear();  // the recipe holds the pixels
        continue;
      }
      if (named->pixels->file.empty()) {
        write_image(*named, relief_image_name(file, number++));
        continue;
      }
    }
    named->image = relative_to(file, named->pixels->file);
  }
  write_recipe(recipe, file);
}

std::vector<std::filesystem::path> recipe_and_images(const std::vector<std::string>& names) {
  std::vector<std::filesystem::path> files;
  for (const std::string& name : names) try {
      files.push_back(find_body(name));
      for (const std::string& image : named_images(files.back()))
        files.push_back(std::filesystem::path(name).parent_path() / image);
    } catch (const std::exception&) {  // is told where the recipe is read
    }
  return files;
}

std::vector<std::filesystem::path> recipe_and_relief(const std::vector<std::string>& names) {
  std::vector<std::filesystem::path> files(names.begin(), names.end());
  for (const std::string& name : names) {
    if (!is_compact_name(name)) files.push_back(relief_image_name(name, 0));
  }
  return files;
}

}  // namespace astrolith
