#include "synthesis/mesh/marching_cubes_table.h"

#include <map>
#include <set>
#include <utility>
#include <vector>

#include "numerics/vec3.h"

namespace astrolith {
namespace {

using DirectedEdge = std::pair<int, int>;

Vec3d corner_position(int corner) {
  return {double(corner & 1), double((corner >> 1) & 1), double((corner >> 2) & 1)};
}

Vec3d midpoint(int edge) {
  const CellEdge e = cell_edge(edge);
  return 0.5 * (corner_position(e.lower) + corner_position(e.upper));
}

double component(const Vec3d& p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

// The faces on which both vertices lie, as a mask.
int common_faces(int edge_a, int edge_b) {
  int faces = 0;
  for (int face = 0; face < 6; ++face) {
    const auto on = [face](int edge) { return component(midpoint(edge), face / 2) == face % 2; };
    if (on(edge_a) && on(edge_b)) faces |= 1 << face;
  }
  return faces;
}

std::multiset<DirectedEdge> directed_edges(int signs) {
  const CellTriangles& cell = marching_cubes_table()[static_cast<unsigned>(signs)];
  std::multiset<DirectedEdge> edges;
  for (unsigned t = 0; t < cell.count; ++t) {
    for (unsigned k = 0; k < 3; ++k) {
      edges.emplace(cell.edges[3 * t + k], cell.edges[3 * t + (k + 1) % 3]);
    }
  }
  return edges;
}

// The border of the triangles of a cell: mesh edges that only one of the triangles uses.
std::vector<DirectedEdge> border(int signs) {
  std::vector<DirectedEdge> edges;
  const std::multiset<DirectedEdge> all = directed_edges(signs);
  for (const DirectedEdge& e : all) {
    if (!all.contains({e.second, e.first})) edges.push_back(e);
  }
  return edges;
}

TEST(MarchingCubesTable, UsesExactlyTheEdgesWithASignChange) {
  for (int signs = 0; signs < 256; ++signs) {
    std::set<int> crossed, used;
    for (int edge = 0; edge < 12; ++edge) {
      const CellEdge e = cell_edge(edge);
      if (((signs >> e.lower) & 1) != ((signs >> e.upper) & 1)) crossed.insert(edge);
    }
    for (const DirectedEdge& e : directed_edges(signs)) used.insert(e.first);
    EXPECT_EQ(used, crossed) << signs;
  }
}

TEST(MarchingCubesTable, NoMeshEdgeRepeatsAndNoDiagonalLiesInAFace) {
  for (int signs = 0; signs < 256; ++signs) {
    const std::multiset<DirectedEdge> all = directed_edges(signs);
    for (const DirectedEdge& e : all) {
      EXPECT_EQ(all.count(e), 1u) << signs;
      const bool is_diagonal = all.contains({e.second, e.first});
      EXPECT_EQ(common_faces(e.first, e.second) != 0, !is_diagonal) << signs;
    }
  }
}

TEST(MarchingCubesTable, BorderIsLoopsThroughEachVertexOnce) {
  for (int signs = 0; signs < 256; ++signs) {
    std::map<int, int> leaving, entering;
    for (const DirectedEdge& e : border(signs)) {
      ++leaving[e.first];
      ++entering[e.second];
    }
    EXPECT_EQ(leaving, entering) << signs;
    for (const auto& [edge, count] : leaving) EXPECT_EQ(count, 1) << signs << " edge " << edge;
  }
}

// The segments on one face, moved to the low face of the same axis, so that both sides can be compared.
std::set<DirectedEdge> face_segments(int signs, int face) {
  const int axis = face / 2;
  const auto on_low_face = [axis](int edge) {
    for (int other = 0; other < 12; ++other) {
      Vec3d p = midpoint(edge);
      (axis == 0 ? p.x : axis == 1 ? p.y : p.z) = 0.0;
      if (midpoint(other) == p) return other;
    }
    return -1;
  };
  std::set<DirectedEdge> segments;
  for (const DirectedEdge& e : border(signs)) {
    if ((common_faces(e.first, e.second) >> face & 1) != 0) {
      segments.emplace(on_low_face(e.first), on_low_face(e.second));
    }
  }
  return segments;
}

TEST(MarchingCubesTable, NeighboursAgreeOnEveryFace) {
  for (int axis = 0; axis < 3; ++axis) {
    // Indexed by the four signs on the shared face: the segments of the cell below, and those of the cell
    // above.
    std::map<int, std::set<DirectedEdge>> seen_below, seen_above;
    for (int signs = 0; signs < 256; ++signs) {
      int low_signs = 0, high_signs = 0;
      for (int corner = 0; corner < 8; ++corner) {
        const bool inside = ((signs >> corner) & 1) != 0;
        const bool high = ((corner >> axis) & 1) != 0;
        if (inside) (high ? high_signs : low_signs) |= 1 << (corner & ~(1 << axis));
      }
      const auto below = seen_below.emplace(high_signs, face_segments(signs, 2 * axis + 1)).first;
      EXPECT_EQ(below->second, face_segments(signs, 2 * axis + 1)) << "depends on more than the face";
      const auto above = seen_above.emplace(low_signs, face_segments(signs, 2 * axis)).first;
      EXPECT_EQ(above->second, face_segments(signs, 2 * axis)) << "depends on more than the face";
    }
    ASSERT_EQ(seen_below.size(), 16u);
    for (const auto& [face_signs, segments] : seen_below) {
      std::set<DirectedEdge> reversed;
      for (const DirectedEdge& e : seen_above.at(face_signs)) reversed.emplace(e.second, e.first);
      EXPECT_EQ(segments, reversed) << "axis " << axis << " signs " << face_signs;
    }
  }
}

TEST(MarchingCubesTable, TrianglesFaceAwayFromALoneInsideCorner) {
  for (int corner = 0; corner < 8; ++corner) {
    for (const bool inverted : {false, true}) {
      const unsigned signs = inverted ? 255u ^ (1u << corner) : 1u << corner;
      const CellTriangles& cell = marching_cubes_table()[signs];
      ASSERT_EQ(cell.count, 1);
      const Vec3d a = midpoint(cell.edges[0]), b = midpoint(cell.edges[1]), c = midpoint(cell.edges[2]);
      const double away = dot(cross(b - a, c - a), a - corner_position(corner));
      EXPECT_GT(inverted ? -away : away, 0.0) << corner;
    }
  }
}

TEST(MarchingCubesTable, SeparatesInsideCornersOnAmbiguousFaces) {
  EXPECT_EQ(marching_cubes_table()[0b01101001].count, 4);  // alternating corners: four lone caps
  EXPECT_EQ(marching_cubes_table()[0b00001001].count, 2);  // two corners across a face: two caps
}

}  // namespace
}  // namespace astrolith
