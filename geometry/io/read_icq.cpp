// Gaskell's implicitly connected quadrilaterals. A file states Q and then, for each of the six faces of a
// cube, (Q+1)^2 vertices row by row. Faces repeat the vertices of the edges they share, so that 6 Q^2 + 2
// vertices remain.
//
// Shared edges are found by the coordinates of whole edges, not of single vertices: neighbouring vertices
// that rounding in a printed file has made equal stay two vertices.
#include <algorithm>
#include <cmath>

#include "geometry/io/mesh_file_internal.h"
#include "geometry/io/text_scanner_internal.h"
#include "geometry/mesh_edges.h"
#include "geometry/orient_faces.h"

namespace astrolith {
namespace {

constexpr std::uint32_t kFaces = 6;
constexpr std::int64_t kLargestQ = 16384;  // 2^31 quadrilaterals

class CubeGrid {
 public:
  explicit CubeGrid(std::uint32_t q) : q_(q) {}

  std::uint32_t q() const { return q_; }
  std::size_t num_stored() const { return std::size_t{kFaces} * (q_ + 1) * (q_ + 1); }
  std::size_t num_unique() const { return std::size_t{kFaces} * q_ * q_ + 2; }
  std::uint32_t index(std::uint32_t face, std::uint32_t i, std::uint32_t j) const {
    return (face * (q_ + 1) + j) * (q_ + 1) + i;
  }
  // Vertex k, 0 .. Q, on edge 4 face + side.
  std::uint32_t on_edge(std::uint32_t edge, std::uint32_t k) const {
    const std::uint32_t face = edge / 4;
    switch (edge % 4) {
      case 0:
        return index(face, k, 0);
      case 1:
        return index(face, q_, k);
      case 2:
        return index(face, k, q_);
      default:
        return index(face, 0, k);
    }
  }

 private:
  std::uint32_t q_;
};

constexpr std::uint32_t kEdges = 4 * kFaces;

struct EdgeMatch {
  std::uint32_t edge = 0;
  bool reversed = false;
  double distance = HUGE_VAL;  // the largest distance between two partner vertices
};

double edge_distance(const CubeGrid& grid, const std::vector<Vec3d>& points, std::uint32_t a,
                     const EdgeMatch& b) {
  double largest = 0.0;
  for (std::uint32_t k = 0; k <= grid.q(); ++k) {
    const std::uint32_t partner = grid.on_edge(b.edge, b.reversed ? grid.q() - k : k);
    largest = std::max(largest, norm(points[grid.on_edge(a, k)] - points[partner]));
  }
  return largest;
}

// The edge of another face whose points lie nearest to the points of this edge.
EdgeMatch match_edge(const CubeGrid& grid, const std::vector<Vec3d>& points, std::uint32_t edge) {
  EdgeMatch best;
  for (std::uint32_t other = 0; other < kEdges; ++other) {
    if (other / 4 == edge / 4) continue;
    for (const bool reversed : {false, true}) {
      EdgeMatch match{other, reversed, 0.0};
      match.distance = edge_distance(grid, points, edge, match);
      if (match.distance < best.distance) best = match;
    }
  }
  return best;
}

DisjointSets join_edges(const MeshFile& file, const CubeGrid& grid, const TriangleMesh& stored) {
  // Files print at least five digits, and partners differ by their rounding at most.
  const double tolerance = 1e-4 * stored.bounds().diagonal();
  DisjointSets classes(stored.vertices.size());
  for (std::uint32_t edge = 0; edge < kEdges; ++edge) {
    const EdgeMatch match = match_edge(grid, stored.vertices, edge);
    if (!(match.distance <= tolerance)) {
      file.fail("face " + std::to_string(edge / 4 + 1), "one of its edges meets no other face",
                "an ICQ's six faces must close; fetch it again");
    }
    for (std::uint32_t k = 0; k <= grid.q(); ++k) {
      classes.unite(grid.on_edge(edge, k), grid.on_edge(match.edge, match.reversed ? grid.q() - k : k));
    }
  }
  return classes;
}

// Splits a quadrilateral into two triangles along its shorter diagonal.
void append_quad(const std::vector<Vec3d>& points, const std::array<std::uint32_t, 4>& q,
                 std::vector<Triangle>& out) {
  if (squared_norm(points[q[2]] - points[q[0]]) <= squared_norm(points[q[3]] - points[q[1]])) {
    out.push_back({q[0], q[1], q[2]});
    out.push_back({q[0], q[2], q[3]});
  } else {
    out.push_back({q[0], q[1], q[3]});
    out.push_back({q[1], q[2], q[3]});
  }
}

void append_quads(const CubeGrid& grid, TriangleMesh& mesh) {
  mesh.triangles.reserve(2 * std::size_t{kFaces} * grid.q() * grid.q());
  for (std::uint32_t face = 0; face < kFaces; ++face) {
    for (std::uint32_t j = 0; j < grid.q(); ++j) {
      for (std::uint32_t i = 0; i < grid.q(); ++i) {
        append_quad(mesh.vertices,
                    {grid.index(face, i, j), grid.index(face, i + 1, j), grid.index(face, i + 1, j + 1),
                     grid.index(face, i, j + 1)},
                    mesh.triangles);
      }
    }
  }
}

TriangleMesh merged(const TriangleMesh& stored, DisjointSets& classes) {
  TriangleMesh mesh;
  std::vector<std::uint32_t> new_from_stored(stored.vertices.size());
  for (std::uint32_t i = 0; i < stored.vertices.size(); ++i) {
    const std::uint32_t root = classes.find(i);
    if (root == i) {
      new_from_stored[i] = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.push_back(stored.vertices[i]);
    } else {
      new_from_stored[i] = new_from_stored[root];  // a root has the lowest number of its class
    }
  }
  mesh.triangles = stored.triangles;
  for (Triangle& t : mesh.triangles) {
    for (std::uint32_t& index : t) index = new_from_stored[index];
  }
  return mesh;
}

CubeGrid read_grid(TextScanner& scan) {
  if (!scan.next_filled_line()) scan.fail_truncated("Q");
  const std::int64_t q = scan.integer("Q");
  if (q < 1 || q > kLargestQ) scan.fail("Q is " + std::to_string(q), "an ICQ's Q lies between 1 and 16384");
  const CubeGrid grid(static_cast<std::uint32_t>(q));
  constexpr std::size_t kLeastRowBytes = 6;  // "0 0 0\n"
  if (grid.num_stored() > (scan.bytes_left() + 1) / kLeastRowBytes) {
    scan.fail("Q is " + std::to_string(q) + ", more than the file can hold",
              "it may be truncated: fetch it again");
  }
  return grid;
}

}  // namespace

TriangleMesh read_icq(const MeshFile& file) {
  TextScanner scan(file);
  const CubeGrid grid = read_grid(scan);
  TriangleMesh stored;
  stored.vertices.reserve(grid.num_stored());
  for (std::size_t i = 0; i < grid.num_stored(); ++i) {
    if (!scan.next_filled_line()) scan.fail_truncated("vertex " + std::to_string(i + 1));
    stored.vertices.push_back(scan.point());
  }
  append_quads(grid, stored);
  DisjointSets classes = join_edges(file, grid, stored);
  TriangleMesh mesh = merged(stored, classes);
  if (mesh.vertices.size() != grid.num_unique()) {
    file.fail("",
              std::to_string(mesh.vertices.size()) +
                  " vertices remain where 6 Q^2 + 2 = " + std::to_string(grid.num_unique()) + " are due",
              "an ICQ's six faces must form a cube");
  }
  return orient_faces(std::move(mesh));
}

}  // namespace astrolith
