// What synth says of a mesh, in words and in the summary.
#pragma once

#include <string>

#include "synthesis/finish/erosion.h"
#include "tasks/job/job.h"
#include "tasks/synth/body_mesh.h"
#include "tasks/synth/mesh_job.h"

namespace astrolith {

// What the field leaves out of the recipe's layers, in the summary as "layers_left_out".
void report_layers_left_out(Job& job, const MeshPart& part);

// What was asked of the mesher beyond the mesh: the pieces that were left out, and more even triangles.
void report_making(Job& job, const MeshPart& part, const BodyMeshReport& made);

// What erosion did to a mesh of so many vertices.
void report_erosion(Job& job, const Erosion& erosion, const ErosionStatistics& done, std::size_t vertices);

// The counts of the finished mesh, and what of it or of its format should be known.
void report_mesh(Job& job, const MeshJob& mesh, const MeshPart& part, const BodyMeshReport& made);

// "21768 triangles, closed, manifold, genus 0, 1 component".
std::string describe(const MeshSpec& spec, const ManifoldReport& report);

}  // namespace astrolith
