// The isosurface of samples that are at hand, instead of a field that can be asked anywhere.
//
//   const VolumeMeshSize size = mesh_volume(grid, values, sink);
//
// Signs are bits: the edges of 64 samples are compared at once, and where a vertex stands in the mesh is
// counted from those bits wherever a triangle needs it, so that no numbers are stored. Vertices, but for
// their normals, and triangles are those that mesh_field makes of a field with these values.
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

// Meshes F = 0 of values  (cells[2] + 1 x cells[1] + 1 x cells[0] + 1), x fastest; a sample is inside when F
// > 0 strictly. The mesh is closed and 2-manifold; normals come from central differences. Throws InputError
// when there are not as many values, fewer than two cells along an axis, or a sample on the border is inside;
// WorkError when there are more than 2^32 vertices or progress asks to stop.
VolumeMeshSize mesh_volume(const SampleGrid& grid, std::span<const float> values, MeshSink& sink,
                           const Progress& progress = {});

}  // namespace astrolith
