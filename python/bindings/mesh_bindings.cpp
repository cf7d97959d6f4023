#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "geometry/io/mesh_format.h"
#include "geometry/io/mesh_io.h"
#include "geometry/io/ply_stream_writer.h"
#include "geometry/io/ply_values.h"
#include "geometry/mesh_measure.h"
#include "geometry/mesh_topology.h"
#include "geometry/wound_surface.h"
#include "numerics/errors.h"
#include "numerics/version/code_version.h"
#include "python/bindings/arrays.h"
#include "python/bindings/job.h"
#include "python/bindings/recipe_text.h"
#include "python/bindings/synthesis_bindings.h"
#include "synthesis/field/surface_colors.h"
#include "synthesis/field/surface_labels.h"
#include "tasks/synth/body_mesh.h"
#include "tasks/synth/erode_body.h"
#include "tasks/synth/mesh_prediction.h"
#include "tasks/synth/patch_ground.h"

namespace astrolith::python {
namespace {

using Fields = nb::typed<nb::dict, nb::str, nb::any>;

// Receives a mesh as arrays, with labels where a labeller is given.
class ArraySink : public MeshSink {
 public:
  explicit ArraySink(VertexLabeller labeller) : labeller_(std::move(labeller)) {}

  void add_vertices(std::span<const MeshVertex> batch) override {
    for (const MeshVertex& v : batch) {
      vertices.push_back(v.position);
      normals.push_back(v.normal);
    }
    if (!labeller_) return;
    std::vector<VertexLabel> made(batch.size());
    labeller_(batch, made);
    for (const VertexLabel& label : made) {
      labels.push_back(label.label);
      elevations.push_back(label.elevation);
    }
  }
  void add_triangles(std::span<const Triangle> batch) override {
    triangles.insert(triangles.end(), batch.begin(), batch.end());
  }

  std::vector<Vec3f> vertices, normals;
  std::vector<Triangle> triangles;
  std::vector<std::int32_t> labels;
  std::vector<float> elevations;

 private:
  VertexLabeller labeller_;
};

struct MeshArguments {
  std::string json;
  std::filesystem::path name;
  int resolution = 0;      // used where `triangles` is 0
  double triangles = 0.0;  // 0: as the resolution gives
  std::optional<std::array<double, 4>> patch;
  bool aligned = false;  // the cube of the patch stands on its ground
  std::optional<std::array<int, 2>> tile;
  double min_component = 0.0;
  bool labels = false;
  bool even = false;

  // `origin` is the recipe's.
  Region region(const Vec3d& origin) const {
    if (patch) {
      Region region = patch_region(Vec3d{(*patch)[0], (*patch)[1], (*patch)[2]} - origin, (*patch)[3]);
      region.aligned = aligned;
      return region;
    }
    return tile ? tile_region((*tile)[0], (*tile)[1]) : Region{};
  }
};

struct MadeMesh {
  ArraySink arrays;
  BodyMeshReport report;
  std::optional<ErosionStatistics> erosion;
  int resolution = 0;
  Region region;
  Vec3d origin;  // of the vertices, in the frame
  std::vector<std::string> legend;
  std::vector<LayerLeftOut> left_out;
  std::vector<VertexColor> colors;  // empty where no layer paints
};

Vec3f narrowed(const Vec3d& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

ErosionStatistics erode_arrays(const Erosion& erosion, ArraySink& arrays, const Progress& progress) {
  TriangleMesh mesh;
  mesh.triangles = std::move(arrays.triangles);
  for (const Vec3f& v : arrays.vertices) mesh.vertices.push_back({v.x, v.y, v.z});
  for (const Vec3f& v : arrays.normals) mesh.normals.push_back({v.x, v.y, v.z});
  const ErosionStatistics done = erode_body(erosion, mesh, progress);
  arrays.triangles = std::move(mesh.triangles);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    arrays.vertices[i] = narrowed(mesh.vertices[i]);
    arrays.normals[i] = narrowed(mesh.normals[i]);
  }
  return done;
}

std::vector<VertexColor> colors_of(const ArraySink& arrays, const SurfaceColors& colors,
                                   const Vec3d& origin) {
  std::vector<MeshVertex> vertices;
  for (const Vec3f& position : arrays.vertices) vertices.push_back({position, {}});
  std::vector<VertexColor> painted(vertices.size());
  colors.paint(origin, vertices, painted);
  return painted;
}

MadeMesh make_mesh(const MeshArguments& arguments, JobState& state) {
  const Recipe recipe = loaded_recipe(arguments.json, arguments.name);
  Region region = arguments.region(recipe.origin);
  const ImplicitField field = field_of_region(recipe, arguments.name, region);
  place_patch(recipe, arguments.name, field, region);
  std::optional<SurfaceLabels> labels;
  VertexLabeller labeller;
  if (arguments.labels) {
    labels.emplace(recipe, field, region.cube());
    labeller = [&](auto vertices, auto out) { labels->label(region.center, vertices, out); };
  }
  MadeMesh made{ArraySink(std::move(labeller)), {}, {}, 0, region, recipe.origin + region.center, {}, {}, {}};
  made.resolution = arguments.triangles > 0.0
                        ? MeshEstimator(field, recipe, region).resolution_for(arguments.triangles)
                        : arguments.resolution;
  const auto stage = [&](const std::string& name) { return state.progress(name); };
  made.report = make_body_mesh({recipe, field, arguments.name, region, made.resolution,
                                arguments.min_component, MeshingDevice::kCpu, false, arguments.even},
                               made.arrays, stage);
  if (recipe.erosion) made.erosion = erode_arrays(*recipe.erosion, made.arrays, state.progress("erosion"));
  if (has_colors(recipe)) {
    made.colors = colors_of(made.arrays, SurfaceColors(recipe, arguments.name, field), region.center);
  }
  if (labels) made.legend = labels->legend();
  made.left_out.assign(field.left_out().begin(), field.left_out().end());
  return made;
}

MeshPrediction predict_of(const MeshArguments& arguments, const std::string& format, int threads) {
  const auto start = std::chrono::steady_clock::now();
  const std::clock_t processor_start = std::clock();
  const Recipe recipe = loaded_recipe(arguments.json, arguments.name);
  Region region = arguments.region(recipe.origin);
  const ImplicitField field = field_of_region(recipe, arguments.name, region);
  place_patch(recipe, arguments.name, field, region);
  MeshUse use;
  use.erosion = recipe.erosion.has_value();
  use.twice = arguments.min_component > 0.0;
  use.labels = arguments.labels;
  use.even = arguments.even;
  const PlannedRun run{threads,
                       std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
                       static_cast<double>(std::clock() - processor_start) / CLOCKS_PER_SEC};
  return predict_mesh({field, recipe, region, "mesh" + format, use}, arguments.resolution,
                      arguments.triangles, run);
}

nb::dict quality_figures(const QualityFigures& quality) {
  nb::dict figures;
  figures["first_percentile"] = quality.first_percentile;
  figures["mean"] = quality.mean;
  return figures;
}

nb::dict even_figures(const EvenStatistics& done) {
  nb::dict even;
  even["quality_before"] = quality_figures(done.before);
  even["quality_after"] = quality_figures(done.after);
  even["mean_move"] = done.mean_move;
  even["largest_move"] = done.largest_move;
  even["largest_value"] = done.largest_value;
  even["moved_vertices"] = done.moved;
  even["kept_vertices"] = done.kept;
  return even;
}

nb::tuple tuple_of(const Vec3d& v) { return nb::make_tuple(v.x, v.y, v.z); }

nb::dict axes_figures(const GroundAxes& axes) {
  nb::dict figures;
  figures["right"] = tuple_of(axes.right);
  figures["ahead"] = tuple_of(axes.ahead);
  figures["up"] = tuple_of(axes.up);
  return figures;
}

nb::dict figures(const MadeMesh& made) {
  const BodyMeshReport& report = made.report;
  nb::dict figures;
  figures["resolution"] = made.resolution;
  figures["vertices"] = report.manifold.vertices;
  figures["triangles"] = report.manifold.triangles;
  figures["closed"] = report.manifold.closed();
  figures["manifold"] = report.manifold.manifold();
  figures["genus"] = report.manifold.genus;
  figures["components"] = report.manifold.components;
  figures["dropped_components"] = report.dropped_components;
  figures["evaluations"] = report.statistics.evaluations;
  figures["cell"] = report.statistics.step;
  if (made.region.is_patch || !(made.origin == Vec3d{})) figures["origin"] = tuple_of(made.origin);
  if (const std::optional<GroundAxes>& axes = made.region.axes) figures["patch_axes"] = axes_figures(*axes);
  if (const std::optional<GroundPlane>& plane = made.region.plane) {
    nb::dict of_map = axes_figures(plane->axes);
    of_map["origin"] = tuple_of(plane->origin);
    figures["map_plane"] = of_map;
  }
  if (report.even) figures["even"] = even_figures(*report.even);
  if (made.erosion) {
    nb::dict erosion;
    erosion["settled"] = made.erosion->settled;
    erosion["sweeps"] = made.erosion->sweeps;
    erosion["steepest_before"] = made.erosion->steepest_before;
    erosion["steepest_after"] = made.erosion->steepest_after;
    erosion["moved_vertices"] = made.erosion->moved_vertices;
    erosion["rock_vertices"] = made.erosion->rock_vertices;
    erosion["volume_moved"] = made.erosion->volume_moved;
    figures["erosion"] = erosion;
  }
  nb::list left_out;
  for (const LayerLeftOut& left : made.left_out) {
    left_out.append(nb::make_tuple(left.layer, left.variance_share, left.finest));
  }
  figures["layers_left_out"] = left_out;
  return figures;
}

Fields mesh(const std::string& json, const std::filesystem::path& name, int resolution, double triangles,
            std::optional<std::array<double, 4>> patch, bool aligned, std::optional<std::array<int, 2>> tile,
            double min_component, bool labels, bool even, int threads, nb::object progress) {
  const MeshArguments arguments{json,    name, resolution,    triangles, patch,
                                aligned, tile, min_component, labels,    even};
  MadeMesh made =
      run_job(std::move(progress), threads, [=](JobState& state) { return make_mesh(arguments, state); });
  ArraySink& arrays = made.arrays;
  const std::size_t n = arrays.vertices.size(), m = arrays.triangles.size();
  Fields result;
  result["figures"] = figures(made);
  result["vertices"] = array_of<float>(std::move(arrays.vertices), {n, 3});
  result["faces"] = array_of<std::uint32_t>(std::move(arrays.triangles), {m, 3});
  result["normals"] = array_of<float>(std::move(arrays.normals), {n, 3});
  if (labels) {
    result["labels"] = array_of<std::int32_t>(std::move(arrays.labels), {n});
    result["elevations"] = array_of<float>(std::move(arrays.elevations), {n});
    result["legend"] = made.legend;
  }
  if (!made.colors.empty()) result["colors"] = array_of<std::uint8_t>(std::move(made.colors), {n, 3});
  return result;
}

Fields predict(const std::string& json, const std::filesystem::path& name, int resolution, double triangles,
               std::optional<std::array<double, 4>> patch, bool aligned,
               std::optional<std::array<int, 2>> tile, double min_component, bool labels, bool even,
               const std::string& format, int threads) {
  const MeshArguments arguments{json,    name, resolution,    triangles, patch,
                                aligned, tile, min_component, labels,    even};
  const MeshPrediction predicted =
      run_job(nb::none(), threads, [=](JobState&) { return predict_of(arguments, format, threads); });
  Fields figures;
  figures["resolution"] = predicted.resolution;
  figures["triangles"] = predicted.triangles;
  figures["file_bytes"] = predicted.file_bytes;
  figures["peak_bytes"] = predicted.peak_bytes;
  figures["seconds"] = predicted.seconds;
  figures["processor_seconds"] = predicted.processor_seconds;
  return figures;
}

// The labels and the elevations that `synth --labels` gave the vertices of a PLY.
struct FileLabels {
  std::vector<std::int32_t> labels;
  std::vector<float> elevations;
};
FileLabels labels_in(const std::filesystem::path& file) {
  FileLabels found;
  if (mesh_extension(file) != ".ply") return found;
  const std::vector<std::string> names = ply_value_names(file);
  const auto has = [&](const char* name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  if (!has("label") || !has("elevation")) return found;
  const std::vector<double> labels = read_ply_values(file, "label").values,
                            elevations = read_ply_values(file, "elevation").values;
  // Properties of these names that another program wrote may hold anything.
  const auto is_label = [](double v) { return std::fabs(v) < 0x1p31 && v == std::floor(v); };
  const auto is_float = [](double v) { return std::fabs(v) <= double{std::numeric_limits<float>::max()}; };
  if (!std::all_of(labels.begin(), labels.end(), is_label) ||
      !std::all_of(elevations.begin(), elevations.end(), is_float)) {
    return found;
  }
  for (const double label : labels) found.labels.push_back(static_cast<std::int32_t>(label));
  for (const double elevation : elevations) found.elevations.push_back(static_cast<float>(elevation));
  return found;
}

Fields read(const std::filesystem::path& file, bool points_allowed) {
  TriangleMesh mesh = run_job(
      nb::none(), 0, [=](JobState&) { return points_allowed ? read_mesh_or_points(file) : read_mesh(file); });
  const std::size_t n = mesh.vertices.size(), m = mesh.triangles.size();
  const bool with_normals = !mesh.normals.empty();
  Fields result;
  result["vertices"] = array_of<double>(std::move(mesh.vertices), {n, 3});
  result["faces"] = array_of<std::uint32_t>(std::move(mesh.triangles), {m, 3});
  if (with_normals) result["normals"] = array_of<double>(std::move(mesh.normals), {n, 3});
  FileLabels found = run_job(nb::none(), 0, [=](JobState&) { return labels_in(file); });
  if (!found.labels.empty()) {
    result["labels"] = array_of<std::int32_t>(std::move(found.labels), {n});
    result["elevations"] = array_of<float>(std::move(found.elevations), {n});
  }
  return result;
}

using Labels = nb::ndarray<const std::int32_t, nb::shape<-1>, nb::c_contig, nb::device::cpu>;
using Elevations = nb::ndarray<const float, nb::shape<-1>, nb::c_contig, nb::device::cpu>;

using Colors = nb::ndarray<const std::uint8_t, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;

// Writes a PLY file whose vertices have labels, and colours where the mesh has them.
void write_labelled(const TriangleMesh& mesh, const std::vector<VertexLabel>& labels,
                    const std::filesystem::path& file, const MeshFileInfo& info) {
  VertexPainter painter;
  if (!mesh.colors.empty()) {
    painter = [&](auto, auto out) { std::copy(mesh.colors.begin(), mesh.colors.end(), out.begin()); };
  }
  PlyStreamWriter writer(
      file, info, [&](auto, auto out) { std::copy(labels.begin(), labels.end(), out.begin()); }, painter);
  std::vector<MeshVertex> vertices(mesh.vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    vertices[i] = {narrowed(mesh.vertices[i]), narrowed(mesh.normals[i])};
  }
  writer.add_vertices(vertices);
  writer.add_triangles(mesh.triangles);
  writer.finish();
}

void write(const std::filesystem::path& file, const Rows<double>& vertices, const Rows<std::uint32_t>& faces,
           const std::optional<Rows<double>>& normals, const std::optional<Labels>& labels,
           const std::optional<Elevations>& elevations, const std::optional<Colors>& colors,
           const std::string& length_unit, const std::string& frame, const std::string& comment,
           const std::optional<std::array<double, 3>>& origin, bool whole_body,
           const std::vector<std::string>& notes, bool uv) {
  MeshFileInfo info{length_unit, frame, comment, {}, whole_body, notes, uv};
  if (origin) info.origin = Vec3d{(*origin)[0], (*origin)[1], (*origin)[2]};
  std::vector<VertexLabel> of_vertices;
  if (labels && elevations) {
    for (std::size_t i = 0; i < labels->shape(0); ++i) {
      of_vertices.push_back({labels->data()[i], elevations->data()[i]});
    }
  }
  TriangleMesh mesh = mesh_of(vertices, faces, normals);
  for (std::size_t i = 0; colors && i < colors->shape(0); ++i) {
    const std::uint8_t* c = colors->data() + 3 * i;
    mesh.colors.push_back({c[0], c[1], c[2]});
  }
  run_job(nb::none(), 0, [=, mesh = std::move(mesh)](JobState&) {
    if (of_vertices.empty()) {
      write_mesh(mesh, file, info);
    } else {
      write_labelled(mesh, of_vertices, file, info);
    }
    return true;
  });
}

Fields fields_of(const MeshFormat& format) {
  Fields row;
  row["name"] = format.name;
  row["extension"] = std::string(format.extensions[0]);
  row["read"] = format.reader != nullptr;
  row["written"] = format.writer != nullptr;
  row["unit"] = format.tells_unit;
  row["colors"] = format.has_colors;
  row["values"] = format.has_values;
  row["texture_coordinates"] = format.has_texture_coordinates;
  return row;
}

std::vector<Fields> formats() {
  std::vector<Fields> rows;
  for (const MeshFormat& format : mesh_formats()) rows.push_back(fields_of(format));
  return rows;
}

Fields written_format(const std::filesystem::path& file) { return fields_of(written_mesh_format(file)); }

// None where nothing is to be done.
std::optional<std::tuple<NumpyArray<double>, NumpyArray<std::uint32_t>, std::string>> wound(
    const Rows<double>& vertices, const Rows<std::uint32_t>& faces) {
  WoundSurface surface = wound_surface(mesh_of(vertices, faces, {}));
  if (!surface.changed()) return std::nullopt;
  const std::size_t n = surface.mesh.vertices.size(), m = surface.mesh.triangles.size();
  return std::tuple(array_of<double>(std::move(surface.mesh.vertices), {n, 3}),
                    array_of<std::uint32_t>(std::move(surface.mesh.triangles), {m, 3}), surface.words());
}

double closed_volume(const Rows<double>& vertices, const Rows<std::uint32_t>& faces) {
  const TriangleMesh mesh = mesh_of(vertices, faces, {});
  const MeshTopology topology = analyze_topology(mesh);
  if (!topology.closed || !topology.oriented) {
    throw InputError("mesh: is open or wound both ways, so has no inside; astrolith.repair_mesh closes it");
  }
  return volume(mesh);
}

}  // namespace

void bind_meshes(nb::module_& module) {
  module.def("mesh", &mesh, nb::arg("json"), nb::arg("name"), nb::arg("resolution"), nb::arg("triangles"),
             nb::arg("patch").none(), nb::arg("aligned"), nb::arg("tile").none(), nb::arg("min_component"),
             nb::arg("labels"), nb::arg("even"), nb::arg("threads"), nb::arg("progress").none());
  module.def("predict", &predict, nb::arg("json"), nb::arg("name"), nb::arg("resolution"),
             nb::arg("triangles"), nb::arg("patch").none(), nb::arg("aligned"), nb::arg("tile").none(),
             nb::arg("min_component"), nb::arg("labels"), nb::arg("even"), nb::arg("format"),
             nb::arg("threads"));
  module.def("wound_surface", &wound, nb::arg("vertices").noconvert(), nb::arg("faces").noconvert());
  module.def("read_mesh", &read, nb::arg("file"), nb::arg("points_allowed"));
  module.def(
      "stated_length_unit", [](const std::filesystem::path& file) { return stated_length_unit(file); },
      nb::arg("file"));
  module.def("mesh_formats", &formats);
  module.def("written_mesh_format", &written_format, nb::arg("file"));
  module.def("write_mesh", &write, nb::arg("file"), nb::arg("vertices").noconvert(),
             nb::arg("faces").noconvert(), nb::arg("normals").noconvert().none(),
             nb::arg("labels").noconvert().none(), nb::arg("elevations").noconvert().none(),
             nb::arg("colors").noconvert().none(), nb::arg("length_unit"), nb::arg("frame"),
             nb::arg("comment"), nb::arg("origin").none(), nb::arg("whole_body"), nb::arg("notes"),
             nb::arg("uv"));
  module.def(
      "surface_area",
      [](const Rows<double>& vertices, const Rows<std::uint32_t>& faces) {
        return surface_area(mesh_of(vertices, faces, {}));
      },
      nb::arg("vertices").noconvert(), nb::arg("faces").noconvert());
  module.def("volume", &closed_volume, nb::arg("vertices").noconvert(), nb::arg("faces").noconvert());
  module.def("version", [] { return kCodeVersion.text(); });
}

}  // namespace astrolith::python
