// Counts and seconds of the mesh of a region before it is made, from a coarse mesh and probes along its
// surface.
#pragma once

#include "geometry/triangle_mesh.h"
#include "synthesis/field/implicit_field.h"
#include "synthesis/mesh/surface_probes.h"
#include "tasks/synth/body_mesh.h"

namespace astrolith {

struct MeshEstimate {
  int resolution = 0;
  double step = 0.0;  // edge of a cell, length units
  double area = 0.0;  // of the coarse mesh, square length units
  double triangles = 0.0, blocks = 0.0;
  double layer_blocks = 0.0;     // the most
  double seconds = 0.0;          // of one processor, without the bricks of Gabor impulses
  double list_bytes = 0.0;       // memory of the field narrowed to a block
  double own_evaluations = 0.0;  // of the field, for these figures
  int probes = 0;                // 0: the mesh was made
};

// Estimates meshes of one part of a body. The number of places it looks at depends on the resolution alone.
// All members throw what mesh_part() throws.
class MeshEstimator {
 public:
  // Meshes that are made to be counted are made by the part's device, where it can.
  explicit MeshEstimator(const MeshPart& part);

  MeshEstimate at(int resolution);

  // The resolution at which the whole mesh, or the patch, has about so many triangles; the same on every
  // machine. Throws InputError where the finest mesh has fewer, and WorkError where the surface is too small
  // to tell its size.
  int resolution_for(double triangles);

  // The coarse or counted mesh of the last estimate, which stands for the surface where a cost is sampled.
  // Where layers have impulses it is the mesh of the body without its layers.
  const TriangleMesh& coarse() const { return coarse_; }

 private:
  MeshEstimate made_at(int resolution);
  // The resolution near this one whose mesh has about so many triangles, by making meshes. `before` is known
  // of a mesh of other cells.
  int counted_resolution(MeshEstimate before, int resolution, double triangles);
  void make_coarse(int cells);
  ProbeFigures probe(const ProbedSurface& surface, int resolution, int count);
  ProbeFigures probe_or_known(const ProbedSurface& surface, int resolution, int count);

  SampleGrid sample_grid(int resolution) const;
  // The part of space in which the mesh lies: the cube of a patch, the slab of a tile.
  Box mesh_space(int resolution) const;

  const MeshPart part_;
  const ImplicitField& field_ = part_.field;
  const Region& region_ = part_.region;
  ImplicitField base_;  // whose coarse mesh is made
  TriangleMesh coarse_;
  int coarse_cells_ = 0;
  double coarse_step_ = 0.0;
  MeshEstimate counted_;  // the last mesh that was made to count its triangles; 0 triangles: none
  double evaluations_ = 0.0;
  int most_probes_ = 0;
  // The last probes, which stand for those of nearly the same cells.
  struct Probed {
    double step = 0.0;
    int count = 0;
    ProbeFigures figures;
  } last_;
};

}  // namespace astrolith
