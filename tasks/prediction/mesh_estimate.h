// What the mesh of a region takes, estimated before it is made.
#pragma once

#include "geometry/triangle_mesh.h"
#include "synthesis/field/implicit_field.h"
#include "synthesis/mesh/mesh_sample.h"
#include "tasks/synthesis/mesh_region.h"

namespace astrolith {

// What an estimate may take: a share of the seconds that are predicted for the mesh, or this many seconds of
// one processor if these are more. The first sample is taken at any cost. Where few blocks would tell little,
// `most_share` of the seconds may go into the first probes.
struct EstimateBudget {
  double share;
  double free_seconds;
  int first_squares, first_blocks;  // of the first sample
  int first_probes;
  double most_share;
};

// The estimate of the mesh of a region from samples of its blocks, a coarse mesh, and probes along the
// surface of that. Throws what mesh_region throws.
MeshEstimate estimate_region(const ImplicitField& field, const Recipe& recipe, const Region& region,
                             int resolution, const EstimateBudget& budget);

// A coarse mesh of a region, of at most `cells` cells, which stands for the surface where a cost is sampled.
// Where layers have impulses it is the mesh of the body without its layers. Throws what mesh_region throws.
TriangleMesh coarse_region(const ImplicitField& field, const Recipe& recipe, const Region& region, int cells);

// The resolution at which the whole mesh, or the patch, has about so many triangles. The estimates look at a
// fixed number of places, so that the resolution is the same on every machine. Throws InputError where the
// finest mesh has fewer, and WorkError where the surface is too small to tell its size.
int resolution_for_triangles(const ImplicitField& field, const Recipe& recipe, const Region& region,
                             double triangles);

}  // namespace astrolith
