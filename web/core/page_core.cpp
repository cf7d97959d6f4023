#include "web/core/page_core.h"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <new>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/io/mesh_io.h"
#include "numerics/errors.h"
#include "numerics/files/sha256.h"
#include "numerics/vec3_json.h"
#include "numerics/version/code_version.h"
#include "recipe/recipe_json.h"
#include "synthesis/field/surface_colors.h"
#include "synthesis/finish/population_draw.h"
#include "tasks/synth/body_mesh.h"
#include "web/core/surface_values.h"

namespace astrolith {
namespace {

bool host_goes_on(double fraction, std::string_view) { return astrolith_host_goes_on(fraction) != 0; }

// An image beside a recipe, which the host has decoded.
struct GivenImage {
  std::string sha256;
  std::shared_ptr<const ExemplarImage> pixels;
};
std::map<std::string, GivenImage>& given_images() {
  static std::map<std::string, GivenImage> images;  // by the names of their files, without folders
  return images;
}

// Gives the layer its pixels, where the host has the image that it names. Pixels of a relief then lie in the
// recipe.
void take_image(NamedImage& named, const std::string& place) {
  const auto found = given_images().find(std::filesystem::path(named.image).filename().string());
  if (named.image.empty() || found == given_images().end()) return;
  const auto& [digits, pixels] = found->second;
  if (digits != named.image_sha256) {
    throw InputError(place + ".image: " + named.image +
                     " has changed since the recipe was written; restore it, or state its SHA-256 " + digits);
  }
  named.pixels = pixels;
}

// A recipe in the bytes of a file; no bytes are refused as require_plain_file() refuses an empty file.
Recipe recipe_in(std::string_view bytes, const std::string& name) {
  if (bytes.empty()) throw InputError(name + ": is empty; give another file");
  Recipe recipe = parse_recipe(bytes, name);
  for (std::size_t i = 0; i < recipe.layers.size(); ++i) {
    NamedImage* const named = find_image(recipe.layers[i]);
    if (named == nullptr || named->pixels != nullptr) continue;
    take_image(*named, name + ": layers[" + std::to_string(i) + "]");
    if (named->pixels != nullptr && std::holds_alternative<ReliefLayer>(recipe.layers[i]))
      named->image.clear(), named->image_sha256.clear();
  }
  return recipe;
}

// Refuses a recipe whose layers name files, which no page has beside it.
void require_own_pixels(const Recipe& recipe, const std::string& name) {
  for (std::size_t i = 0; i < recipe.layers.size(); ++i) {
    const NamedImage* named = find_image(recipe.layers[i]);
    if (named == nullptr || named->pixels != nullptr) continue;
    throw InputError(name + ": layers[" + std::to_string(i) + "].image: " + named->image +
                     " is a file beside the recipe; drop the recipe together with it, or use synth");
  }
}

Recipe body_recipe_in(std::string_view bytes, const std::string& name) {
  Recipe recipe = recipe_in(bytes, name);
  require_own_pixels(recipe, name);
  require_body(recipe, name);
  return recipe;
}

bool same_heights(const ExemplarImage& a, const ExemplarImage& b) {
  return a.width == b.width && a.height == b.height && a.values == b.values;
}

// The pixels of a recipe's reliefs, and as text all else that decides the work which ImplicitField takes from
// a field that is `like` it.
struct FieldWork {
  explicit FieldWork(const Recipe& recipe) {
    Recipe part;
    part.length_unit = recipe.length_unit;
    part.seed = recipe.seed;
    part.body = recipe.body;
    for (std::size_t i = 0; i < recipe.layers.size(); ++i) {
      const auto* const relief = std::get_if<ReliefLayer>(&recipe.layers[i]);
      if (relief == nullptr) continue;
      pixels.push_back(relief->pixels);
      ReliefLayer without = *relief;
      static_cast<NamedImage&>(without) = {"relief", std::string(64, '0'), nullptr};
      part.layers.push_back(without);
      text += std::to_string(i) + " ";
    }
    text += recipe_to_json(part);
  }
  bool operator==(const FieldWork& other) const {
    return text == other.text && std::equal(pixels.begin(), pixels.end(), other.pixels.begin(),
                                            other.pixels.end(), [](const auto& a, const auto& b) {
                                              return a == b || (a && b && same_heights(*a, *b));
                                            });
  }

  std::string text;
  std::vector<std::shared_ptr<const ExemplarImage>> pixels;
};

// The body that is meshed. Its field is kept for meshes of other resolutions, and what reliefs and morphs
// took seconds for is kept for the next recipe of the same body.
struct MeshedBody {
  MeshedBody(std::string_view bytes, const std::string& name, const MeshedBody* before)
      : text(bytes),
        file(name),
        recipe(body_recipe_in(bytes, name)),
        work(recipe),
        part{spec, recipe, file, {}, make_region_field(recipe, file, {}, host_goes_on, like(before)), 0} {}
  MeshedBody(const MeshedBody&) = delete;
  MeshedBody& operator=(const MeshedBody&) = delete;

  const std::string text;
  const std::filesystem::path file;
  const Recipe recipe;
  const FieldWork work;
  const MeshSpec spec;
  const MeshPart part;  // refers to the others

 private:
  const ImplicitField* like(const MeshedBody* before) const {
    return before != nullptr && before->file == file && before->work == work ? &before->part.field : nullptr;
  }
};

// What the calls have made so far.
struct PageState {
  std::string message, figures, written, sha256;
  std::unique_ptr<const MeshedBody> body;
  TriangleMesh mesh;
  MeshFileInfo info;
  std::vector<float> positions, normals;
  SurfaceValues values;
  DrawnBody drawn;
  MeasuredBody ground;  // of the drawn body
};

PageState& state() {
  static PageState made;
  return made;
}

// Does the work, and turns what it throws into a status and a message.
template <class Work>
int run_guarded(const Work& work) {
  state().message.clear();
  try {
    work();
    return 0;
  } catch (const InputError& error) {
    state().message = error.what();
    return 2;
  } catch (const std::bad_alloc&) {
    state().message = "the mesh needs more memory than a page may have; lower the resolution";
  } catch (const std::exception& error) {
    state().message = error.what();
  }
  return 1;
}

MeshFileInfo mesh_file_info(const Recipe& recipe) {
  MeshFileInfo info{recipe.length_unit, recipe.frame, "made by synth " + kCodeVersion.text()};
  if (!(recipe.origin == Vec3d{})) info.origin = recipe.origin;
  info.whole_body = true;
  return info;
}

nlohmann::ordered_json body_figures(const BodyMeshReport& made, const Recipe& recipe,
                                    const TriangleMesh& mesh) {
  const ManifoldReport& report = made.manifold;
  return {{"length_unit", recipe.length_unit},
          {"vertices", report.vertices},
          {"triangles", report.triangles},
          {"closed", report.closed()},
          {"genus", report.genus},
          {"components", report.components},
          {"evaluations", made.statistics.evaluations},
          {"cell", made.statistics.step},
          {"extent", to_json(mesh.bounds().extent())}};
}

std::vector<float> as_floats(const std::vector<Vec3d>& places) {
  std::vector<float> floats;
  floats.reserve(3 * places.size());
  for (const Vec3d& p : places) {
    for (const double x : {p.x, p.y, p.z}) floats.push_back(static_cast<float>(x));
  }
  return floats;
}

void make(std::string_view text, const std::string& name, int resolution) {
  PageState& to = state();
  to.mesh = {};
  if (to.body == nullptr || to.body->text != text || to.body->file != name) {
    to.body = std::make_unique<MeshedBody>(text, name, to.body.get());
  }
  const Recipe& recipe = to.body->recipe;
  MeshPart part = to.body->part;
  part.resolution = resolution;
  MeshCollector collector;
  const BodyMeshReport made =
      make_body_mesh(part, collector, [](const std::string&) { return host_goes_on; });
  TriangleMesh& mesh = collector.mesh;
  if (recipe.erosion) erode_body(*recipe.erosion, mesh, host_goes_on);
  if (has_colors(recipe)) mesh.colors = SurfaceColors(recipe, name, part.field).evaluate_colors({}, mesh);
  to.figures = body_figures(made, recipe, mesh).dump();
  to.info = mesh_file_info(recipe);
  to.positions = as_floats(mesh.vertices);
  to.normals = as_floats(mesh.normals);
  to.mesh = std::move(mesh);
}

void find_values(const std::string& what) {
  PageState& to = state();
  if (to.body == nullptr || to.mesh.vertices.empty()) throw InputError("values: there is no mesh; make one");
  to.values =
      find_surface_values(what, to.body->recipe, to.body->file.string(), to.body->part.field, to.mesh);
  to.figures = nlohmann::ordered_json{{"unit", to.values.unit}, {"legend", to.values.legend}}.dump();
}

void keep_written(std::string bytes) {
  state().sha256 = sha256(bytes);
  state().written = std::move(bytes);
}

// The host has a file system in memory.
std::string taken_file(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  std::filesystem::remove(file);
  return bytes;
}

void write_made_mesh(const std::string& format) {
  const std::filesystem::path file = "/tmp/body." + format;
  write_mesh(state().mesh, file, state().info);
  keep_written(taken_file(file));
}

void write_recipe_anew(std::string_view text, const std::string& name, const std::string& format) {
  const Recipe recipe = recipe_in(text, name);
  keep_written(format == "astro" ? recipe_to_compact(recipe) : recipe_to_json(recipe));
}

void give_image(const std::string& name, std::string_view bytes, int width, int height,
                const std::uint16_t* values, const std::uint16_t* rgb) {
  if (std::min(width, height) < kLeastExemplarSide || std::max(width, height) > kMostExemplarSide)
    throw InputError(name + ": is " + std::to_string(width) + " x " + std::to_string(height) +
                     " pixels; cut out or scale it to sides of " + std::to_string(kLeastExemplarSide) +
                     " to " + std::to_string(kMostExemplarSide));
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  auto image = std::make_shared<ExemplarImage>();
  image->width = width;
  image->height = height;
  image->values.assign(values, values + pixels);
  if (rgb != nullptr) image->rgb.assign(rgb, rgb + 3 * pixels);
  given_images()[name] = {sha256(bytes), image};
}

void forget_images() {
  given_images().clear();
  state().body.reset();
}

void draw(std::string_view text, const std::string& name) {
  PageState& to = state();
  const Recipe recipe = recipe_in(text, name);
  if (!recipe.population) throw InputError(name + ": population: absent; fit_population writes one");
  to.drawn = draw_body(recipe);
  const MeasuredBody* const ground = ground_donor(to.drawn, *recipe.population);
  to.ground = ground == nullptr ? MeasuredBody() : *ground;
  to.figures = nlohmann::ordered_json{{"diameter", to.drawn.diameter},
                                      {"class", std::string(class_word(to.drawn.kind))},
                                      {"ground", to.ground.recipe}}
                   .dump();
  keep_written(recipe_to_json(to.drawn.recipe));
}

void lay_ground_on(std::string_view text, const std::string& name) {
  const PageState& from = state();
  keep_written(recipe_to_json(lay_ground(from.drawn, from.ground, recipe_in(text, name), name)));
}

}  // namespace
}  // namespace astrolith

using astrolith::state;

int astrolith_make(const char* recipe, std::size_t bytes, const char* name, int resolution) {
  return astrolith::run_guarded([&] { astrolith::make({recipe, bytes}, name, resolution); });
}
const char* astrolith_message() { return state().message.c_str(); }
const char* astrolith_figures() { return state().figures.c_str(); }
const float* astrolith_positions() { return state().positions.data(); }
const float* astrolith_normals() { return state().normals.data(); }
const std::uint8_t* astrolith_colors() {
  return state().mesh.colors.empty() ? nullptr : state().mesh.colors.front().data();
}
const std::uint32_t* astrolith_triangles() {
  return state().mesh.triangles.empty() ? nullptr : state().mesh.triangles.front().data();
}
std::size_t astrolith_vertex_count() { return state().mesh.vertices.size(); }
std::size_t astrolith_triangle_count() { return state().mesh.triangles.size(); }

int astrolith_find_values(const char* what) {
  return astrolith::run_guarded([&] { astrolith::find_values(what); });
}
const float* astrolith_values() { return state().values.values.data(); }

int astrolith_write_mesh(const char* format) {
  return astrolith::run_guarded([&] { astrolith::write_made_mesh(format); });
}
int astrolith_write_recipe(const char* recipe, std::size_t bytes, const char* name, const char* format) {
  return astrolith::run_guarded([&] { astrolith::write_recipe_anew({recipe, bytes}, name, format); });
}
void astrolith_forget_images() { astrolith::forget_images(); }
int astrolith_give_image(const char* name, const char* bytes, std::size_t count, int width, int height,
                         const std::uint16_t* values, const std::uint16_t* rgb) {
  return astrolith::run_guarded([&] {
    astrolith::give_image(name, {bytes, count}, width, height, values, rgb);
  });
}
int astrolith_draw(const char* recipe, std::size_t bytes, const char* name) {
  return astrolith::run_guarded([&] { astrolith::draw({recipe, bytes}, name); });
}
int astrolith_lay_ground(const char* recipe, std::size_t bytes, const char* name) {
  return astrolith::run_guarded([&] { astrolith::lay_ground_on({recipe, bytes}, name); });
}
const char* astrolith_bytes() { return state().written.data(); }
std::size_t astrolith_byte_count() { return state().written.size(); }
const char* astrolith_sha256() { return state().sha256.c_str(); }

const char* astrolith_version() {
  static const std::string text = astrolith::kCodeVersion.text();
  return text.c_str();
}
