// A mesh sink that passes a part of a mesh on.
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

}  // namespace astrolith
