// The adaptive hybrid descriptor of a mesh whose vertices move while its triangles, and the samples on them,
// stay: what descriptor/shape_description.h computes for a mesh, with all that does not change done once.
#pragma once

#include <cstdint>
#include <vector>

#include "descriptor/surflet_histogram.h"
#include "estimation/shape/details/probe_layout.h"
#include "geometry/triangle_mesh.h"

namespace astrolith {

class MovedMesh {
 public:
  // `mesh` is closed and manifold, as it is before anything moves. kappa is the mean of the vertices'
  // curvature within `radius`, weighted as in geometry/surface/sample_curvature.h; which vertices those are,
  // and their weights, stay as they are now.
  MovedMesh(const TriangleMesh& mesh, const std::vector<MeshPlace>& samples, double radius);

  // Of the samples once the vertices are here, and what its pairs are counted of.  (#V)
  PairInput pair_input(const std::vector<Vec3d>& vertices) const;
  ShapeHistogram histogram(const std::vector<Vec3d>& vertices) const;

 private:
  struct Neighbour {
    std::uint32_t vertex;
    float weight;
  };
  void add_neighbours(const TriangleMesh& mesh, const std::vector<Vec3d>& normals, const MeshPlace& sample,
                      double radius);

  std::vector<Triangle> triangles_;
  std::vector<MeshPlace> samples_;
  std::vector<Neighbour> neighbours_;
  std::vector<std::size_t> first_neighbour_{0};  // (#samples + 1)
};

}  // namespace astrolith
