// Mesh sinks that pass a part of a mesh on, or measure it.
#pragma once

#include "geometry/mesh_sink.h"

namespace astrolith {

// Passes vertices on, not triangles.
class PointsOnly : public MeshSink {
 public:
  explicit PointsOnly(MeshSink& sink) : sink_(sink) {}
  void add_vertices(std::span<const MeshVertex> vertices) override { sink_.add_vertices(vertices); }
  void add_triangles(std::span<const Triangle>) override {}

 private:
  MeshSink& sink_;
};

// Measures the box of all vertices.
class ExtentOfMesh : public MeshSink {
 public:
  void add_vertices(std::span<const MeshVertex> vertices) override {
    for (const MeshVertex& v : vertices) box.extend({v.position.x, v.position.y, v.position.z});
  }
  void add_triangles(std::span<const Triangle>) override {}
  // Measures a finished mesh instead of what was added.
  void measure(const TriangleMesh& mesh) {
    box = {};
    for (const Vec3d& v : mesh.vertices) box.extend(v);
  }

  Box box;
};

}  // namespace astrolith
