// What a mesh costs: seconds and memory, counted from the estimate of its blocks.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "recipe/recipe.h"
#include "synthesis/field/implicit_field.h"
#include "synthesis/gabor/gabor_bricks.h"
#include "synthesis/mesh/mesh_sample.h"
#include "tasks/synthesis/mesh_region.h"

namespace astrolith {

// The uses of a mesh that cost more than the mesh.
struct MeshUse {
  bool preview = false;
  bool erosion = false;
  bool twice = false;  // small pieces are left out, for which the mesh is made twice
  bool gravity = false;
  bool labels = false;
  bool texture_coordinates = false;
  bool even = false;
};

// What a format takes for each triangle and its half vertex, bytes.
struct OutputCost {
  double file;
  double memory;
};
OutputCost output_cost(const std::filesystem::path& output, const MeshUse& use, double triangles);

// The bricks of Gabor impulses that a mesh draws.
struct GaborCost {
  std::vector<double> bytes;  // of each list of impulses, if all bricks were kept
  double seconds = 0.0;       // of one processor
};
GaborCost gabor_cost(const ImplicitField& field, const MeshEstimate& mesh);

// The memory of the caches of Gabor bricks at the end, beyond what they hold at the time of `before`. A list
// whose bricks take more than a cache is drawn again and again, which leaves gaps in the heaps of threads.
double more_cache_bytes(std::span<const GaborCacheUse> before, std::span<const double> bytes, int threads);

// Memory of the mesher and of the check of its mesh, bytes, without its output and without caches.
double meshing_bytes(const MeshEstimate& mesh);

// Seconds of one processor in which the system gives the mesher the memory of its blocks. They come on top of
// the seconds of the blocks, which samples find in memory that is used again and again.
double fresh_memory_seconds(const MeshEstimate& mesh);

// What an erosion adds to a mesh.
struct ErosionCost {
  double parallel_seconds = 0.0;  // of one processor
  double serial_seconds = 0.0;
  double bytes = 0.0;  // of the gravity that it slides against, beyond OutputCost::memory
};
// A mesh of a sixth of the cells is made and eroded.
ErosionCost erosion_cost(const ImplicitField& field, const Recipe& recipe, const MeshEstimate& mesh);

// What evening the triangles adds to a mesh.
struct EvenCost {
  double seconds = 0.0;         // of one processor
  double recorded_bytes = 0.0;  // of the mesh, until it has been passed on
  double table_bytes = 0.0;     // beside it, once the mesher is done
};
EvenCost even_cost(const MeshEstimate& mesh);

// Seconds of one processor for the label and the elevation of each vertex. Labels some vertices of a coarse
// mesh, in runs that are as wide as those of the mesh.
double label_seconds(const ImplicitField& field, const Recipe& recipe, const Region& region,
                     const MeshEstimate& mesh);

// Seconds of one processor for the gravity at all vertices: that of a coarse mesh, scaled by the vertices and
// by the depth of the tree.
double gravity_seconds(const ImplicitField& field, const Recipe& recipe, const MeshEstimate& mesh);

// Seconds for a triangle and its half vertex to be checked, written and hashed. Found by doing so with a
// small mesh, in some milliseconds.
double output_seconds_per_triangle();

}  // namespace astrolith
