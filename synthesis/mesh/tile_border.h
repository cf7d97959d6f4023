// The border of a tile: the loops of open edges in the two planes where the tile is cut.
//
// The loops of a seam run along the open edges of the tile below it. The tile above it has the same edges the
// other way round, and its loops are reversed. Two tiles therefore fit exactly if the loops of their seam are
// equal: each vertex of the one then lies on a vertex of the other, and each open edge gets its second
// triangle.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "geometry/mesh_sink.h"

namespace astrolith {

// One side of a tile.
struct TileSide {
  float z = 0.0f;             // height of the plane, length units
  std::int64_t vertices = 0;  // vertices on the loops, and edges, too
  std::int64_t loops = 0;
  // SHA-256 of z and of the loops, each a count (uint64) and x, y (float32) of its vertices, little endian.
  // Each loop begins where that makes it the least in the order of these bits, and the least loop comes
  // first.
  std::string sha256;

  bool operator==(const TileSide&) const = default;
};

struct TileFigures {
  std::int64_t vertices = 0;
  std::int64_t triangles = 0;
  double volume = 0.0;  // sum of the signed tetrahedra from the origin to each triangle, length units^3
  // Absent where the tile is not cut.
  std::optional<TileSide> lower, upper;

  std::int64_t border_vertices() const {
    return (lower ? lower->vertices : 0) + (upper ? upper->vertices : 0);
  }
  // V - E + F, where 2 E = 3 F + the open edges. The figures of tiles that fit add up to that of the whole,
  // because loops have as many edges as vertices.
  std::int64_t euler_characteristic() const {
    return vertices - (3 * triangles + border_vertices()) / 2 + triangles;
  }
  bool operator==(const TileFigures&) const = default;
};

// The open edges in one plane, while a mesh is streamed.
class PlaneEdges {
 public:
  // Edges of a lower side are reversed.
  PlaneEdges(float z, bool is_lower) : z_(z), is_lower_(is_lower) {}

  void add_vertices(std::uint32_t first, std::span<const MeshVertex> vertices);
  void add_triangle(const Triangle& triangle);

  // The side, or nothing where the open edges do not form loops that pass each vertex once. Call it at the
  // end.
  std::optional<TileSide> side();

 private:
  struct PlaneVertex {
    std::uint32_t number;
    float x, y;
  };
  using Edge = std::array<std::uint32_t, 2>;
  using Loop = std::vector<std::uint64_t>;  // the bits of x and y of each vertex

  bool holds(std::uint32_t vertex) const;
  bool keep_open_edges();
  std::vector<Loop> loops() const;
  std::uint64_t plane_place(std::uint32_t vertex) const;

  float z_;
  bool is_lower_;
  std::vector<PlaneVertex> vertices_;  // by ascending numbers
  std::vector<Edge> edges_;
};

// Measures a tile while it is streamed. Expects a stream as mesh_field makes it: triangles that follow a call
// of add_vertices name vertices of that call and of the call before.
class TileBorder : public MeshSink {
 public:
  // The planes where the tile is cut, if it is.
  TileBorder(std::optional<float> lower, std::optional<float> upper);

  void add_vertices(std::span<const MeshVertex> vertices) override;
  void add_triangles(std::span<const Triangle> triangles) override;

  // The figures, or nothing where the border is no set of loops. Call it once, at the end.
  std::optional<TileFigures> figures();

 private:
  std::optional<PlaneEdges> lower_, upper_;
  TileFigures figures_;
  bool late_ = false;                // a triangle named an earlier vertex
  std::vector<Vec3f> before_, now_;  // positions of the call before and of the last call
  std::uint32_t first_ = 0;          // number of the first vertex of before_
};

}  // namespace astrolith
