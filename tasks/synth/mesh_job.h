// The part of synth that makes meshes: whole, a tile or a patch of one, to a file and a picture.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "recipe/recipe.h"
#include "tasks/job/device_option.h"
#include "tasks/job/job.h"
#include "tasks/synth/preview.h"

namespace astrolith {

struct MeshSizeRequest {
  int resolution = 256;
  double triangles = 0.0;      // 0 = as the resolution gives
  double max_memory_gb = 0.0;  // 0 = three quarters of the machine's
  bool only_predict = false;
};

struct GravityRequest {
  std::vector<double> density_and_period;  // kg/m3 and hours, 0 hours = at rest; empty = no gravity

  bool wanted() const { return !density_and_period.empty(); }
};

// A map of what is dangerous to a lander (tasks/synth/ground_maps.h).
struct HazardRequest {
  std::filesystem::path file;  // GeoTIFF of a patch; empty = none
  double footprint = 0.0;      // side of the square of ground that a lander stands on, length units
};

struct MeshRequest {
  MeshSizeRequest size;
  PreviewRequest preview;
  GravityRequest gravity;
  std::filesystem::path height_map;  // GeoTIFF of a patch; empty = none
  HazardRequest hazard;
  std::filesystem::path landforms;  // list of craters and boulders; empty = none
  std::string tile;                 // "3/16"; empty = the whole
  std::vector<double> patch;        // centre and side; empty = the whole
  bool aligned = false;             // the cube of the patch stands on its ground
  double least_component = 0.0;     // share of the largest one's volume; 0 = all stay
  bool points = false;
  bool labels = false;
  std::string uv;     // texture coordinates: "longitude" or "charts"; empty = none
  int bake = 0;       // side of the maps, texels; 0 = none
  bool even = false;  // triangles are made more even
  int levels = 1;     // of detail
  DeviceOption device;

  bool has_charts() const { return uv == "charts"; }
  bool has_maps() const { return !height_map.empty() || !hazard.file.empty(); }
};

void declare_mesh_options(Job& job, MeshRequest& request);

// Throws InputError for options that contradict each other or the recipe, which was read from `file`.
void check_mesh_request(const MeshRequest& request, const Recipe& recipe, const std::filesystem::path& file);

// Throws InputError for a name that no mesh of the request can have.
void check_mesh_name(const MeshRequest& request, const std::filesystem::path& output);

// Throws InputError for an output of the request that cannot be written. An output without a name is left
// out.
void check_mesh_outputs(const Job& job, const MeshRequest& request, const std::filesystem::path& output);

// Writes the mesh of a recipe with a body, which was read from `file`, and its summary. Throws InputError
// where the request makes no sense, WorkError for a mesh that does not keep its promise.
void make_mesh(Job& job, const MeshRequest& request, const Recipe& recipe, const std::filesystem::path& file,
               const std::filesystem::path& output);

// The peak of memory and the hash of the output.
void summarize_output(Job& job, const std::filesystem::path& output);

}  // namespace astrolith
