// The receiver of a mesh that is passed on in pieces while it is made, so that no mesh need be held whole.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "numerics/parallel_for.h"

namespace astrolith {

struct MeshVertex {
  Vec3f position;
  Vec3f normal;  // unit length, pointing out of the body
};

class MeshSink {
 public:
  virtual ~MeshSink() = default;
  // Vertices are numbered from 0 in the order of the calls. Triangles may name only vertices already given.
  virtual void add_vertices(std::span<const MeshVertex> vertices) = 0;
  virtual void add_triangles(std::span<const Triangle> triangles) = 0;
  // Both: what a mesher has made at a time.
  virtual void add_batch(std::span<const MeshVertex> vertices, std::span<const Triangle> triangles) {
    add_vertices(vertices);
    add_triangles(triangles);
  }
};

// Keeps nothing: for callers who only want the counts of a mesher.
class MeshDiscard : public MeshSink {
 public:
  void add_vertices(std::span<const MeshVertex>) override {}
  void add_triangles(std::span<const Triangle>) override {}
};

// Passes vertices and triangles on to several sinks, which work side by side: they share nothing.
class SinkList : public MeshSink {
 public:
  void add(MeshSink& sink) { sinks_.push_back(&sink); }
  void add_vertices(std::span<const MeshVertex> vertices) override {
    for_each([&](MeshSink& sink) { sink.add_vertices(vertices); });
  }
  void add_triangles(std::span<const Triangle> triangles) override {
    for_each([&](MeshSink& sink) { sink.add_triangles(triangles); });
  }
  void add_batch(std::span<const MeshVertex> vertices, std::span<const Triangle> triangles) override {
    for_each([&](MeshSink& sink) { sink.add_batch(vertices, triangles); });
  }

 private:
  template <typename Give>
  void for_each(const Give& give) {
    parallel_for(0, static_cast<std::int64_t>(sinks_.size()),
                 [&](std::int64_t i) { give(*sinks_[static_cast<std::size_t>(i)]); });
  }

  std::vector<MeshSink*> sinks_;
};

// Collects everything in memory.
class MeshCollector : public MeshSink {
 public:
  void add_vertices(std::span<const MeshVertex> vertices) override {
    for (const MeshVertex& v : vertices) {
      mesh.vertices.push_back({v.position.x, v.position.y, v.position.z});
      mesh.normals.push_back({v.normal.x, v.normal.y, v.normal.z});
    }
  }
  void add_triangles(std::span<const Triangle> triangles) override {
    mesh.triangles.insert(mesh.triangles.end(), triangles.begin(), triangles.end());
  }

  TriangleMesh mesh;
};

}  // namespace astrolith
