// Mesh sinks that pass a mesh on to other sinks.
#pragma once

#include <vector>

#include "geometry/mesh_sink.h"

namespace astrolith {

// Passes vertices and triangles on to several sinks.
class SinkList : public MeshSink {
 public:
  void add(MeshSink& sink) { sinks_.push_back(&sink); }
  void add_vertices(std::span<const MeshVertex> vertices) override {
    for (MeshSink* sink : sinks_) sink->add_vertices(vertices);
  }
  void add_triangles(std::span<const Triangle> triangles) override {
    for (MeshSink* sink : sinks_) sink->add_triangles(triangles);
  }

 private:
  std::vector<MeshSink*> sinks_;
};

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
