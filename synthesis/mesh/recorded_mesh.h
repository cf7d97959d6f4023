// A mesh that is kept as it was streamed, so that it can be changed and passed on in the same batches.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "geometry/mesh_sink.h"

namespace astrolith {

class RecordedMesh : public MeshSink {
 public:
  void add_vertices(std::span<const MeshVertex> batch) override {
    vertices.insert(vertices.end(), batch.begin(), batch.end());
    batches_.push_back({vertices.size(), triangles.size()});
  }
  void add_triangles(std::span<const Triangle> batch) override {
    triangles.insert(triangles.end(), batch.begin(), batch.end());
    if (!batches_.empty()) batches_.back().triangles = triangles.size();
  }

  // Passes the mesh on: each batch of vertices with the triangles that followed it.
  void replay(MeshSink& sink) const {
    Batch before;
    for (const Batch& end : batches_) {
      sink.add_batch(std::span(vertices).subspan(before.vertices, end.vertices - before.vertices),
                     std::span(triangles).subspan(before.triangles, end.triangles - before.triangles));
      before = end;
    }
  }

  std::vector<MeshVertex> vertices;
  std::vector<Triangle> triangles;

 private:
  // The numbers of vertices and triangles at the end of a batch.
  struct Batch {
    std::size_t vertices = 0, triangles = 0;
  };
  std::vector<Batch> batches_;
};

}  // namespace astrolith
