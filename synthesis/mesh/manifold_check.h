// Verifies that a mesh is a closed oriented 2-manifold while the mesh is streamed: the triangles around every
// vertex must form one directed cycle, or one path where the mesh is open. Memory holds a window of two
// batches, however large the mesh is.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/mesh_sink.h"
#include "numerics/unset_vector.h"

namespace astrolith {

struct ManifoldReport {
  std::int64_t vertices = 0;
  std::int64_t triangles = 0;
  std::int64_t open_vertices = 0;          // vertices on a boundary or where orientations disagree
  std::int64_t non_manifold_vertices = 0;  // several cycles or paths, an edge of three triangles, no triangle
  std::int64_t late_triangles = 0;         // not verified: they name a vertex that had left the window
  std::int64_t components = 0;             // connected through shared vertices
  std::int64_t genus = -1;                 // sum over components; -1 unless closed and manifold

  bool closed() const { return triangles > 0 && open_vertices == 0 && late_triangles == 0; }
  bool manifold() const { return triangles > 0 && non_manifold_vertices == 0 && late_triangles == 0; }
};

// Checks a stream as mesh_field makes it: triangles that follow a call of add_vertices name vertices of that
// call and of the call before. Any mesh passed in one call of each is such a stream.
class ManifoldCheck : public MeshSink {
 public:
  void add_vertices(std::span<const MeshVertex> vertices) override;
  void add_triangles(std::span<const Triangle> triangles) override;

  // Checks the vertices that are still in the window. Must be called once, at the end.
  ManifoldReport finish();

  // A triangle seen from one of its vertices: the directed edge opposite to it.
  struct OppositeEdge {
    std::uint32_t from, to;
  };

 private:
  // The link of a vertex: the edges opposite to it in its triangles. Few vertices have more than eight; the
  // edges of these beyond the eighth are in `others_`.
  struct alignas(64) Link {
    std::array<OppositeEdge, 8> edges;
  };
  // The links of a batch of vertices, first .. first + counts.size() - 1.
  struct Batch {
    std::uint32_t first = 0;
    UnsetVector<Link> links;
    std::vector<std::uint32_t> counts;  // of the edges of each link
  };
  struct OtherEdge {
    std::uint32_t vertex;
    OppositeEdge edge;
  };
  // Vertices whose links one thread extends.
  struct Range {
    std::uint32_t first, end;
    std::vector<OtherEdge> others;
  };
  // Some triangles that follow one another, and the least and the greatest vertex that they name.
  struct Chunk {
    std::span<const Triangle> triangles;
    std::uint32_t least, greatest;
  };

  bool is_late(const Triangle& t) const { return std::min({t[0], t[1], t[2]}) < before_.first; }
  std::vector<Chunk> split_into_chunks(std::span<const Triangle> triangles) const;
  void extend_links(const std::vector<Chunk>& chunks);
  void extend_range_links(Range& range, const std::vector<Chunk>& chunks);
  void add_to_link(std::uint32_t vertex, OppositeEdge edge, std::vector<OtherEdge>& others);
  void unite_corners(const std::vector<Chunk>& chunks);
  void settle_before();
  std::uint32_t root(std::uint32_t vertex);
  void unite(std::uint32_t a, std::uint32_t b);
  void forget_components_below(std::uint32_t first);

  Batch before_, last_;                // the window
  std::uint32_t end_ = 0;              // number of vertices so far
  std::vector<OtherEdge> others_;      // of the window
  std::vector<std::uint32_t> parent_;  // union-find over the window
  ManifoldReport report_;
};

}  // namespace astrolith
