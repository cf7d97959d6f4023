// The module astrolith._synthesis: recipes, fields, meshes, textures, pictures, descriptions, gravity. It
// links no library of the fits.
#include <nanobind/nanobind.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "python/bindings/arrays.h"
#include "python/bindings/job.h"
#include "python/bindings/recipe_text.h"
#include "python/bindings/synthesis_bindings.h"
#include "recipe/recipe_json.h"
#include "synthesis/finish/known_population.h"
#include "synthesis/finish/lay_on_base.h"
#include "synthesis/picture/preview.h"
#include "tasks/description/comparison.h"
#include "tasks/description/describe_file.h"
#include "tasks/description/feature_report.h"
#include "tasks/description/surface_report.h"
#include "tasks/description/variation_reference.h"
#include "tasks/job/body_library.h"
#include "tasks/synth/texture.h"

namespace astrolith::python {
namespace {

namespace fs = std::filesystem;
using OptionalRows = std::optional<Rows<double>>;

void bind_recipes(nb::module_& module) {
  const auto unlocked = nb::call_guard<nb::gil_scoped_release>();
  module.def(
      "check_recipe",
      [](const std::string& json, const fs::path& name) {
        return recipe_to_json(parse_recipe(json, name.string()));
      },
      nb::arg("json"), nb::arg("name"), unlocked);
  module.def(
      "read_recipe", [](const fs::path& file) { return recipe_to_json(read_recipe(find_body(file))); },
      nb::arg("file"), unlocked);
  module.def("find_body", &find_body, nb::arg("name"));
  module.def("library_bodies", &library_bodies);
  module.def(
      "write_recipe",
      [](const std::string& json, const std::string& name, const fs::path& file) {
        write_recipe(parse_recipe(json, name), file);
      },
      nb::arg("json"), nb::arg("name"), nb::arg("file"), unlocked);
  module.def(
      "lay_on_base",
      [](const std::string& details, const std::string& details_name, const std::string& base,
         const fs::path& base_name, const std::string& lengths) {
        return recipe_to_json(lay_on_base(parse_recipe(details, details_name), details_name,
                                          parse_recipe(base, base_name.string()), base_name.string(),
                                          parse_base_lengths(lengths)));
      },
      nb::arg("details"), nb::arg("details_name"), nb::arg("base"), nb::arg("base_name"), nb::arg("lengths"),
      unlocked);
  module.def(
      "finish_recipe",
      [](const std::string& json, const std::string& name, const std::string& body, double to,
         std::optional<double> from) {
        return recipe_to_json(finish_recipe(parse_recipe(json, name), name, {body, from, to}).recipe);
      },
      nb::arg("json"), nb::arg("name"), nb::arg("body"), nb::arg("to"), nb::arg("start").none(), unlocked);
}

DescriptionOptions description_options(const std::string& features, int bins, std::int64_t points,
                                       std::uint64_t seed) {
  DescriptionOptions options;
  options.features = features == "wahl" ? PairFeatures::wahl : PairFeatures::ahd;
  options.bins = bins;
  options.points = points;
  options.seed = seed;
  return options;
}

nb::typed<nb::dict, nb::str, nb::any> describe(const fs::path& name, const Rows<double>& vertices,
                                               const Rows<std::uint32_t>& faces, const OptionalRows& normals,
                                               const std::string& features, int bins, std::int64_t points,
                                               std::uint64_t seed, int threads, nb::object progress) {
  const DescriptionOptions options = description_options(features, bins, points, seed);
  const ShapeDescription shape = run_job(
      std::move(progress), threads,
      [name, options, mesh = mesh_of(vertices, faces, normals)](JobState& state) {
        const Progress p = state.progress("describe");
        return mesh.triangles.empty() ? describe_file(name.string(), mesh.vertices, mesh.normals, options, p)
                                      : describe_file(name.string(), mesh, options, p);
      });
  std::vector<double> frequencies = shape.histogram.frequencies();
  const std::size_t count = frequencies.size();
  nb::typed<nb::dict, nb::str, nb::any> result;
  result["frequencies"] = array_of<double>(std::move(frequencies), {count});
  result["axes"] = dimensions(options.features);
  result["points"] = shape.points;
  result["pairs"] = shape.histogram.pairs;
  result["max_distance"] = shape.histogram.max_distance;
  result["vertices_left_out"] = shape.vertices_left_out;
  result["undefined_curvatures"] = shape.undefined_curvatures;
  result["remarks"] = shape.remarks;
  return result;
}

SurfaceStatisticsOptions surface_options(std::int64_t points, std::int64_t places, double period,
                                         double density, std::uint64_t seed) {
  SurfaceStatisticsOptions options;
  options.points = points;
  options.places = places;
  options.rotation_hours = period;
  options.density = density;
  options.seed = seed;
  return options;
}

nb::typed<nb::dict, nb::str, nb::any> surface(const fs::path& name, const Rows<double>& vertices,
                                              const Rows<std::uint32_t>& faces, std::int64_t points,
                                              std::int64_t places, double period, double density,
                                              std::uint64_t seed, int threads, nb::object progress) {
  const SurfaceStatisticsOptions options = surface_options(points, places, period, density, seed);
  SurfaceStatistics made = run_job(
      std::move(progress), threads, [name, options, mesh = mesh_of(vertices, faces, {})](JobState& state) {
        return describe_surface({name.string(), mesh}, options, state.progress("surface"));
      });
  nb::typed<nb::dict, nb::str, nb::any> result;
  result["figures"] = surface_json(made).dump();
  result["remarks"] = made.remarks;
  const std::size_t count = made.places.size();
  nb::dict values;
  for (LocalStatistic& statistic : made.local) {
    const std::string column = column_name(statistic);
    values[nb::str(column.c_str())] = array_of<double>(std::move(statistic.values), {count});
  }
  result["values"] = values;
  result["regions"] = array_of<std::uint8_t>(std::move(made.regions.region_index), {count});
  result["places"] = array_of<double>(std::move(made.places), {count, 3});
  return result;
}

nb::typed<nb::dict, nb::str, nb::any> craters(const fs::path& name, const Rows<double>& vertices,
                                              const Rows<std::uint32_t>& faces, bool boulders,
                                              std::int64_t points, std::uint64_t seed, int threads,
                                              nb::object progress) {
  FeatureOptions options;
  options.boulders = boulders;
  options.points = points;
  options.seed = seed;
  const FoundFeatures found = run_job(
      std::move(progress), threads, [name, options, mesh = mesh_of(vertices, faces, {})](JobState& state) {
        return find_features({name.string(), mesh}, options, state.progress("craters"));
      });
  const std::size_t count = found.features.size();
  nb::dict columns;
  for (std::size_t k = 0; k < feature_columns({}).size(); ++k) {
    std::vector<double> values;
    for (const FoundFeature& f : found.features) values.push_back(feature_columns(f)[k].second);
    columns[nb::str(feature_columns({})[k].first)] = array_of<double>(std::move(values), {count});
  }
  std::vector<double> is_boulder;
  for (const FoundFeature& f : found.features) is_boulder.push_back(f.sign == BlobSign::bump ? 1.0 : 0.0);
  columns["boulder"] = array_of<double>(std::move(is_boulder), {count});
  nlohmann::ordered_json figures = found_json(found);
  if (boulders) figures["boulders"] = found_json(found, BlobSign::bump);
  nb::typed<nb::dict, nb::str, nb::any> result;
  result["figures"] = figures.dump();
  result["columns"] = columns;
  return result;
}

std::string realism(const fs::path& a_name, const Rows<double>& a_vertices,
                    const Rows<std::uint32_t>& a_faces, const fs::path& b_name,
                    const Rows<double>& b_vertices, const Rows<std::uint32_t>& b_faces, std::int64_t points,
                    std::int64_t places, double period, double density, bool floor, const std::string& unit,
                    std::uint64_t seed, int threads, nb::object progress) {
  const SurfaceStatisticsOptions options = surface_options(points, places, period, density, seed);
  return run_job(
      std::move(progress), threads,
      [=, a = mesh_of(a_vertices, a_faces, {}), b = mesh_of(b_vertices, b_faces, {})](JobState& state) {
        return judge_surfaces({a_name.string(), a}, {b_name.string(), b}, options, floor, unit,
                              [&](const std::string& stage) { return state.progress(stage); })
            .figures.dump();
      });
}

std::string compare(const fs::path& a_name, const Rows<double>& a_vertices,
                    const Rows<std::uint32_t>& a_faces, const fs::path& b_name,
                    const Rows<double>& b_vertices, const Rows<std::uint32_t>& b_faces,
                    const std::string& features, int bins, std::int64_t points, std::int64_t samples,
                    bool align, std::uint64_t seed, int threads, nb::object progress) {
  const ComparisonOptions options{description_options(features, bins, points, seed), samples, align};
  return run_job(
      std::move(progress), threads,
      [=, a = mesh_of(a_vertices, a_faces, {}), b = mesh_of(b_vertices, b_faces, {})](JobState& state) {
        return compare_meshes({a_name.string(), a}, {b_name.string(), b}, options,
                              [&](const std::string& stage) { return state.progress(stage); })
            .figures.dump();
      });
}

struct VariedRecipe {
  std::string json, figures;
};

VariedRecipe vary(const std::string& json, const fs::path& name, double delta, std::uint64_t seed,
                  const std::optional<TriangleMesh>& target, const Progress& progress) {
  const Recipe recipe = loaded_recipe(json, name);
  const TriangleMesh like = target ? *target : mesh_for_comparison(recipe);
  const SimilarityMeasure similarity = like.triangles.empty() ? SimilarityMeasure() : similarity_with(like);
  const Variation variation = find_variation(recipe, similarity, delta, seed, progress);
  return {recipe_to_json(variation.recipe), to_json(variation).dump()};
}

std::pair<std::string, std::string> vary_in_job(const std::string& json, const fs::path& name, double delta,
                                                std::uint64_t seed, const OptionalRows& vertices,
                                                const std::optional<Rows<std::uint32_t>>& faces, int threads,
                                                nb::object progress) {
  std::optional<TriangleMesh> target;
  if (vertices && faces) target = mesh_of(*vertices, *faces, {});
  const VariedRecipe varied =
      run_job(std::move(progress), threads, [=, target = std::move(target)](JobState& state) {
        return vary(json, name, delta, seed, target, state.progress("vary"));
      });
  return {varied.json, varied.figures};
}

NumpyArray<std::uint8_t> render(const Rows<double>& vertices, const Rows<std::uint32_t>& faces,
                                const OptionalRows& normals, const OptionalRows& colors,
                                const std::vector<std::array<double, 3>>& views,
                                const std::vector<std::string>& cameras, const std::string& map,
                                const std::array<double, 3>& sun, bool sun_in_body,
                                const std::string& reflectance, double ambient, bool transparent, int width,
                                int height, std::uint64_t seed, int threads, nb::object progress) {
  PreviewOptions options;
  options.width = width;
  options.height = height;
  options.seed = seed;
  options.sun = {{sun[0], sun[1], sun[2]}, sun_in_body};
  options.reflectance = parse_reflectance("reflectance", reflectance);
  options.ambient = ambient;
  options.transparent = transparent;
  options.views.clear();
  for (const std::string& camera : cameras) options.views.push_back(parse_camera("cameras", camera));
  for (const auto& view : views) options.views.push_back(view_from({view[0], view[1], view[2]}));
  if (!map.empty())
    options.views =
        map_views(map == "hemispheres" ? MapProjection::kHemisphere : MapProjection::kEquirectangular);
  if (colors) {
    for (const Vec3d& c : points_of(*colors)) {
      options.vertex_colors.push_back(
          {static_cast<float>(c.x), static_cast<float>(c.y), static_cast<float>(c.z)});
    }
  }
  const RgbaImage16 image =
      run_job(std::move(progress), threads,
              [options, mesh = mesh_of(vertices, faces, normals)](JobState& state) mutable {
                if (options.views.empty()) options.views = usual_views(mesh);
                return render_picture(mesh, options, state.progress("preview")).marked();
              });
  return array_of<std::uint8_t>(
      transparent ? rgba_bytes(image) : opaque_bytes(image).pixels,
      {static_cast<std::size_t>(image.height), static_cast<std::size_t>(image.width), transparent ? 4u : 3u});
}

std::tuple<NumpyArray<float>, double, bool> texture(const std::string& json, const fs::path& name, int width,
                                                    int height, const std::string& content, bool tileable,
                                                    int threads, nb::object progress) {
  PlaneTexture drawn = run_job(std::move(progress), threads, [=](JobState& state) {
    return draw_texture(loaded_recipe(json, name), name.string(), {width, height, content, tileable},
                        state.progress("texture"));
  });
  const auto rows = static_cast<std::size_t>(height), columns = static_cast<std::size_t>(width);
  return std::make_tuple(drawn.channels == 3 ? array_of<float>(std::move(drawn.values), {rows, columns, 3})
                                             : array_of<float>(std::move(drawn.values), {rows, columns}),
                         drawn.height_rms, drawn.has_height);
}

void bind_shapes(nb::module_& module) {
  module.def("describe", &describe, nb::arg("name"), nb::arg("vertices").noconvert(),
             nb::arg("faces").noconvert(), nb::arg("normals").noconvert().none(), nb::arg("features"),
             nb::arg("bins"), nb::arg("points"), nb::arg("seed"), nb::arg("threads"),
             nb::arg("progress").none());
  module.def("surface", &surface, nb::arg("name"), nb::arg("vertices").noconvert(),
             nb::arg("faces").noconvert(), nb::arg("points"), nb::arg("places"), nb::arg("period"),
             nb::arg("density"), nb::arg("seed"), nb::arg("threads"), nb::arg("progress").none());
  module.def("craters", &craters, nb::arg("name"), nb::arg("vertices").noconvert(),
             nb::arg("faces").noconvert(), nb::arg("boulders"), nb::arg("points"), nb::arg("seed"),
             nb::arg("threads"), nb::arg("progress").none());
  module.def("realism", &realism, nb::arg("a_name"), nb::arg("a_vertices").noconvert(),
             nb::arg("a_faces").noconvert(), nb::arg("b_name"), nb::arg("b_vertices").noconvert(),
             nb::arg("b_faces").noconvert(), nb::arg("points"), nb::arg("places"), nb::arg("period"),
             nb::arg("density"), nb::arg("floor"), nb::arg("unit"), nb::arg("seed"), nb::arg("threads"),
             nb::arg("progress").none());
  module.def("compare", &compare, nb::arg("a_name"), nb::arg("a_vertices").noconvert(),
             nb::arg("a_faces").noconvert(), nb::arg("b_name"), nb::arg("b_vertices").noconvert(),
             nb::arg("b_faces").noconvert(), nb::arg("features"), nb::arg("bins"), nb::arg("points"),
             nb::arg("samples"), nb::arg("align"), nb::arg("seed"), nb::arg("threads"),
             nb::arg("progress").none());
}

void bind_products(nb::module_& module) {
  module.def("vary", &vary_in_job, nb::arg("json"), nb::arg("name"), nb::arg("delta"), nb::arg("seed"),
             nb::arg("vertices").noconvert().none(), nb::arg("faces").noconvert().none(), nb::arg("threads"),
             nb::arg("progress").none());
  module.def("render", &render, nb::arg("vertices").noconvert(), nb::arg("faces").noconvert(),
             nb::arg("normals").noconvert().none(), nb::arg("colors").noconvert().none(), nb::arg("views"),
             nb::arg("cameras"), nb::arg("map"), nb::arg("sun"), nb::arg("sun_in_body"),
             nb::arg("reflectance"), nb::arg("ambient"), nb::arg("transparent"), nb::arg("width"),
             nb::arg("height"), nb::arg("seed"), nb::arg("threads"), nb::arg("progress").none());
  module.def("texture", &texture, nb::arg("json"), nb::arg("name"), nb::arg("width"), nb::arg("height"),
             nb::arg("content"), nb::arg("tileable"), nb::arg("threads"), nb::arg("progress").none());
}

}  // namespace
}  // namespace astrolith::python

NB_MODULE(_synthesis, module) {
  using namespace astrolith::python;
  declare_common(module);
  declare_programs(module);
  bind_recipes(module);
  bind_field(module);
  bind_meshes(module);
  bind_shapes(module);
  bind_products(module);
  bind_gravity(module);
  bind_height_maps(module);
  bind_scene(module);
  bind_synth(module);
}
