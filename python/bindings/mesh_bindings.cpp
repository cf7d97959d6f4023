#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
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
#include "python/bindings/synthesis_bindings.h"

namespace astrolith::python {
namespace {

using Fields = nb::typed<nb::dict, nb::str, nb::any>;

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

using NamedValues =
    std::pair<std::string, nb::ndarray<const double, nb::shape<-1>, nb::c_contig, nb::device::cpu>>;
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
    vertices[i] = {to_float(mesh.vertices[i]), to_float(mesh.normals[i])};
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
           const std::vector<std::string>& notes, bool uv, const std::vector<NamedValues>& values) {
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
  std::vector<VertexValues> quantities;
  for (const auto& [name, column] : values)
    quantities.push_back({name, std::vector<double>(column.data(), column.data() + column.shape(0))});
  run_job(nb::none(), 0, [=, mesh = std::move(mesh)](JobState&) {
    if (!quantities.empty()) {
      write_ply_values(mesh, quantities, file, info);
    } else if (of_vertices.empty()) {
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
             nb::arg("uv"), nb::arg("values"));
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
