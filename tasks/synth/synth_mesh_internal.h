// The steps of synth's mesh: its size, gravity, height map, and what is said about it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "geometry/io/ply_values.h"
#include "geometry/triangle_mesh.h"
#include "recipe/recipe.h"
#include "synthesis/field/implicit_field.h"
#include "synthesis/finish/erosion.h"
#include "synthesis/mesh/even_mesh.h"
#include "tasks/job/job.h"
#include "tasks/prediction/mesh_prediction.h"
#include "tasks/synth/synth_mesh.h"
#include "tasks/synthesis/mesh_region.h"

namespace astrolith {

void declare_size_options(Job& job, MeshSizeRequest& request);

// Returns the cells along the longest side. Large meshes are announced with triangles, bytes and seconds,
// and stand as "predicted" in the summary. Throws InputError when the mesh needs more memory than allowed.
int choose_resolution(Job& job, const MeshSizeRequest& request, const PlannedMesh& mesh);

// Throws the InputError of a mesh that took more memory than predicted, and more than allowed.
[[noreturn]] void fail_memory(const Job& job, const MeshSizeRequest& request,
                              const std::filesystem::path& output);

// Throws InputError for a density that is not above 0, a period below 0, and a recipe without a length unit.
void check_gravity(const GravityRequest& request, const Recipe& recipe);

// Potentials, accelerations, slopes and elevations at the vertices of a whole mesh, to 1e-6 of the
// acceleration. The summary states their ranges and the error of a random sample.
std::vector<VertexValues> vertex_gravity(Job& job, const GravityRequest& request, const Recipe& recipe,
                                         const TriangleMesh& mesh);

// The height maps of these names, each with its frame.
std::vector<std::filesystem::path> height_map_files(const std::vector<std::string>& names);

// Throws InputError when the region is no patch, the recipe has no length unit or a file cannot be written.
void check_height_map(const std::filesystem::path& file, const Region& region, const Recipe& recipe,
                      int resolution);

// Writes the patch as a GeoTIFF of metres over its mean plane, and its frame as JSON beside it ("patch.tif"
// and "patch.json"). The mesh is relative to the patch's centre. The map has `resolution` pixels along a
// side.
void write_height_map(Job& job, const std::filesystem::path& file, const TriangleMesh& mesh,
                      const Region& region, const Recipe& recipe, int resolution);

// Reports what the field leaves out of the recipe's layers, in the summary as "layers_left_out". `file` is
// the recipe's file; `is_patch` tells whether the field is meshed in a patch.
void report_layers_left_out(Job& job, const ImplicitField& field, const Recipe& recipe,
                            const std::filesystem::path& file, bool is_patch);

// Reports what erosion did to a mesh of so many vertices.
void report_erosion(Job& job, const Erosion& erosion, const ErosionStatistics& done, std::size_t vertices);

// Reports what evening did to the triangles. `unit` is the recipe's length unit.
void report_even(Job& job, const EvenStatistics& done, const std::string& unit);

}  // namespace astrolith
