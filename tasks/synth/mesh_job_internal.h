// The steps of synth's mesh: its size, and what is said about it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "recipe/recipe.h"
#include "synthesis/field/implicit_field.h"
#include "synthesis/finish/erosion.h"
#include "synthesis/mesh/even_mesh.h"
#include "tasks/job/job.h"
#include "tasks/synth/mesh_job.h"
#include "tasks/synth/mesh_prediction.h"
#include "tasks/synth/mesh_region.h"

namespace astrolith {

void declare_size_options(Job& job, MeshSizeRequest& request);

// Returns the cells along the longest side. Large meshes are announced with triangles, bytes and seconds,
// and stand as "predicted" in the summary. Throws InputError when the mesh needs more memory than allowed.
int choose_resolution(Job& job, const MeshSizeRequest& request, const PlannedMesh& mesh);

// Throws the InputError of a mesh that took more memory than predicted, and more than allowed.
[[noreturn]] void fail_memory(const Job& job, const MeshSizeRequest& request,
                              const std::filesystem::path& output);

// Reports what the field leaves out of the recipe's layers, in the summary as "layers_left_out". `file` is
// the recipe's file; `is_patch` tells whether the field is meshed in a patch.
void report_layers_left_out(Job& job, const ImplicitField& field, const Recipe& recipe,
                            const std::filesystem::path& file, bool is_patch);

// Reports what erosion did to a mesh of so many vertices.
void report_erosion(Job& job, const Erosion& erosion, const ErosionStatistics& done, std::size_t vertices);

// Reports what evening did to the triangles. `unit` is the recipe's length unit.
void report_even(Job& job, const EvenStatistics& done, const std::string& unit);

}  // namespace astrolith
