// Meshes a field that is given as samples on a grid, such as a tomogram or the output of another program:
// isosurface_benchmark compares it with other packages that do so. No program of Astrolith needs it, since a
// field that can be evaluated anywhere is meshed by mesh_field (synthesis/mesh/mesher.h).
//
// Signs of samples are bits, so that the edges of 64 samples are compared at once. The number of a vertex is
// counted from these bits wherever a triangle needs it and is not stored. Triangles and positions of vertices
// are those that mesh_field makes of a field with these values; normals differ.
#pragma once

#include <cstdint>
#include <span>

#include "geometry/mesh_sink.h"
#include "numerics/progress.h"
#include "synthesis/mesh/sample_grid.h"

namespace astrolith {

struct VolumeMeshSize {
  std::int64_t vertices = 0, triangles = 0;
};

// Meshes F = 0. values (cells[2] + 1 x cells[1] + 1 x cells[0] + 1) holds F at the samples of the grid, x
// fastest. A sample is inside when F > 0. The mesh is closed and 2-manifold; normals come from central
// differences. Throws InputError when there is another number of values, when an axis has fewer than two
// cells, or when a sample on the border is inside. Throws WorkError when there are more than 2^32 vertices or
// progress asks to stop.
VolumeMeshSize mesh_volume(const SampleGrid& grid, std::span<const float> values, MeshSink& sink,
                           const Progress& progress = {});

}  // namespace astrolith
