// The adaptive hybrid descriptor of a mesh whose vertices move while its triangles and the samples on them
// stay. The descriptor is that of descriptor/shape_description.h. Everything that does not change is computed
// once.
#pragma once

#include <cstdint>
#include <vector>

#include "descriptor/surflet_histogram.h"
#include "estimation/shape/details/probe_layout.h"
#include "geometry/triangle_mesh.h"

namespace astrolith {

class MovedMesh {
 public:
  // `mesh` is the closed manifold mesh before any vertex moves. The curvature of a sample is the weighted
  // mean over the vertices within `radius`, in the mesh's unit, as in geometry/surface/sample_curvature.h.
  // These vertices and their weights stay the same when vertices move.
  MovedMesh(const TriangleMesh& mesh, const std::vector<MeshPlace>& samples, double radius);

  // The features of the samples for vertices at these places, from which pairs are counted.  (#V in)
  PairInput pair_input(const std::vector<Vec3d>& vertices) const;
  // The histogram of these pairs.  (#V in)
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
