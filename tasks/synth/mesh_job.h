// The part of synth that makes a mesh and what becomes of it: files, arrays, pictures, maps and tables.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "geometry/io/mesh_format.h"
#include "geometry/io/mesh_io.h"
#include "geometry/io/ply_stream_writer.h"
#include "geometry/io/ply_values.h"
#include "recipe/recipe.h"
#include "tasks/job/device_option.h"
#include "tasks/job/job.h"
#include "tasks/synth/body_mesh.h"
#include "tasks/synth/maps_sheet.h"
#include "tasks/synth/preview.h"

namespace astrolith {

// A mesh that is kept in memory.
struct KeptMesh {
  std::uint64_t member = 0;  // its number among members
  TriangleMesh mesh;         // with colours where a layer paints
  std::vector<VertexLabel> labels;
  std::vector<VertexValues> values;  // of gravity
  MeshFileInfo info;
  std::optional<GroundPlane> plane;  // of a patch
  nlohmann::ordered_json figures;    // the summary
};

// What becomes of a mesh. Empty names stand for nothing.
struct MeshSinks {
  std::filesystem::path file = {};
  int levels = 1;                              // of detail, in files
  int bake = 0;                                // side of the baked maps beside the file, texels; 0 = none
  std::shared_ptr<MapsSheet> sheet = nullptr;  // receives pictures of the baked maps
  PreviewRequest preview = {};
  std::filesystem::path height_map = {};        // GeoTIFF of a patch
  std::filesystem::path hazard_map = {};        // GeoTIFF of what is dangerous to a lander on a patch
  double footprint = 0.0;                       // side of the square of ground that the lander stands on
  std::filesystem::path landforms = {};         // list of craters and boulders
  std::filesystem::path recipe = {};            // what the mesh is made of
  std::function<void(KeptMesh&&)> arrays = {};  // where a caller takes the mesh itself
  std::uint64_t member = 0;                     // the number of the body among members

  // Whether anything asks for a mesh.
  bool wanted() const { return !file.empty() || arrays != nullptr; }
  // Whether anything but a streamed file receives the mesh.
  bool need_whole() const {
    return !preview.file.empty() || has_ground_maps() || levels > 1 || arrays != nullptr;
  }
  bool has_ground_maps() const { return !height_map.empty() || !hazard_map.empty(); }
  // The format of the file; of a mesh without one, that of a .ply.
  const MeshFormat& format() const { return written_mesh_format(file.empty() ? "mesh.ply" : file); }
};

// The files of a body with the names of their options, but the frame of a height map, in the order of the
// manifest's lines.
struct NamedFile {
  const char* option;
  std::filesystem::path* name;
};
std::vector<NamedFile> list_files(MeshSinks& sinks);
// What may be written for a mesh of this file name: its levels and its baked maps.
std::vector<std::filesystem::path> mesh_files(const MeshSinks& sinks, const std::filesystem::path& file);

// One request for a mesh: what it is, what becomes of it, and how it is made.
struct MeshJob {
  MeshSpec spec = {};
  MeshSinks sinks = {};
  DeviceOption device = {};
  double max_memory_gb = 0.0;  // 0 = three quarters of the machine's
  bool only_predict = false;
};

void declare_mesh_options(Job& job, MeshJob& mesh);

// Throws InputError for options that contradict each other or the recipe, which was read from `file`.
void check_mesh(const MeshJob& mesh, const Recipe& recipe, const std::filesystem::path& file);

// Throws InputError for a file name that the mesh cannot have.
void check_mesh_name(const MeshJob& mesh, const std::filesystem::path& file);

// Throws InputError for an output that cannot be written.
void check_mesh_outputs(const Job& job, const MeshJob& mesh);

// What the spec and the sinks take beyond the mesher; bytes for each triangle.
struct MeshCost {
  double file_bytes = 0.0;
  double held_bytes = 0.0;   // of the whole mesh in memory and what is made of it; 0: it is streamed
  double table_bytes = 0.0;  // beside the mesh, before it is passed on
  double map_bytes = 0.0;    // of baked maps, all together
  double times = 1.0;        // how often the mesh is made
  double shares = 0.0;       // of the seconds of the mesh that its vertices take
};
inline constexpr double kErosionTables = 90.0;  // bytes: verticals, areas, heights and edges
MeshCost estimate_cost(const MeshJob& mesh, const Recipe& recipe);

// Makes the mesh of a recipe with a body, which was read from `file`, and its summary, or only predicts it.
// Throws InputError where the request makes no sense, WorkError for a mesh that does not keep its promise.
void make_mesh(Job& job, const MeshJob& mesh, const Recipe& recipe, const std::filesystem::path& file);

// The peak of memory and the hash of the output.
void summarize_output(Job& job, const std::filesystem::path& output);

}  // namespace astrolith
