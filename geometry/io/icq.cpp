// Gaskell's implicitly connected quadrilaterals. A file states Q and then, for each of the six faces of a
// cube, (Q+1)^2 vertices row by row. Faces repeat the vertices of the edges they share, so that 6 Q^2 + 2
// vertices remain.
//
// Shared edges are found by the coordinates of whole edges, not of single vertices: neighbouring vertices
// that rounding in a printed file has made equal stay two vertices.
//
// A body that is seen whole from its centre of mass is written by directions to the points of the cube; other
// bodies have several surfaces along a direction and are refused.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "geometry/io/format_internal.h"
#include "geometry/io/text_scanner_internal.h"
#include "geometry/mesh_edges.h"
#include "geometry/mesh_measure.h"
#include "geometry/mesh_topology.h"
#include "geometry/wound_surface.h"
#include "numerics/portable_angles.h"

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

// One face of the cube: the direction of place (u, v) in [-1, 1]^2 is out + u right + v down. Faces follow
// each other as in Gaskell's files: +z, +x, -y, -x, +y, -z.
struct CubeFace {
  Vec3d right, down, out;
};
constexpr std::array<CubeFace, 6> kCubeFaces{{{{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},
                                              {{0, 1, 0}, {0, 0, -1}, {1, 0, 0}},
                                              {{1, 0, 0}, {0, 0, -1}, {0, -1, 0}},
                                              {{0, -1, 0}, {0, 0, -1}, {-1, 0, 0}},
                                              {{-1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
                                              {{0, 1, 0}, {-1, 0, 0}, {0, 0, -1}}}};

// Q such that 12 Q^2 triangles are about as many as the mesh has.
int fitting_q(std::size_t triangles) {
  const double q = std::sqrt(static_cast<double>(triangles) / 12.0) + 0.5;
  return static_cast<int>(std::clamp(q, 1.0, static_cast<double>(kLargestQ)));
}

// Q + 1 places from -1 to 1 at equal angles, symmetric to the last bit.
std::vector<double> grid_places(int q) {
  std::vector<double> places(static_cast<std::size_t>(q) + 1);
  for (int k = 0; 2 * k <= q; ++k) {
    const double angle = std::numbers::pi / 4 * (1.0 - 2.0 * k / q);
    const double place = k == 0 ? 1.0 : 2 * k == q ? 0.0 : portable::tan(angle);
    places[static_cast<std::size_t>(k)] = -place;
    places[static_cast<std::size_t>(q - k)] = place;
  }
  return places;
}

using Corners = std::array<Vec3d, 3>;

// True when the whole triangle lies beside the face, whose cone has four sides.
bool beside(const CubeFace& face, const Corners& corners) {
  for (const Vec3d& side :
       {face.out - face.right, face.out + face.right, face.out - face.down, face.out + face.down}) {
    // A little slack keeps triangles that touch the cone.
    const auto out = [&](const Vec3d& p) { return dot(p, side) < -1e-9 * norm(p); };
    if (out(corners[0]) && out(corners[1]) && out(corners[2])) return true;
  }
  return false;
}

// How far out the surface lies along each direction of one face, and how well within its triangle the
// direction runs. The best triangle counts, so that directions along edges find one too.
class FaceSampler {
 public:
  FaceSampler(const CubeFace& face, const std::vector<double>& places)
      : face_(face),
        places_(places),
        distances_(places.size() * places.size()),
        margins_(distances_.size(), -1.0) {}

  void add(const Corners& corners) {
    if (beside(face_, corners)) return;
    const auto [left, right] = covered_span(corners, face_.right);
    const auto [top, bottom] = covered_span(corners, face_.down);
    for (std::size_t j = top; j < bottom; ++j) {
      for (std::size_t i = left; i < right; ++i) sample(corners, i, j);
    }
  }

  Vec3d direction(std::size_t i, std::size_t j) const {
    return face_.out + places_[i] * face_.right + places_[j] * face_.down;
  }
  bool found(std::size_t i, std::size_t j) const { return margins_[j * places_.size() + i] > -1e-9; }
  Vec3d point(std::size_t i, std::size_t j) const {
    return distances_[j * places_.size() + i] * direction(i, j);
  }

 private:
  // The grid places that a triangle may cover, along one axis.
  std::array<std::size_t, 2> covered_span(const Corners& corners, const Vec3d& axis) const {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const Vec3d& p : corners) {
      const double ahead = dot(p, face_.out);
      if (!(ahead > 1e-9 * norm(p)))
        return {0, places_.size()};  // behind the cube's centre: could be anywhere
      low = std::fmin(low, dot(p, axis) / ahead);
      high = std::fmax(high, dot(p, axis) / ahead);
    }
    constexpr double kSlack = 1e-9;
    const auto begin = std::lower_bound(places_.begin(), places_.end(), low - kSlack),
               end = std::upper_bound(places_.begin(), places_.end(), high + kSlack);
    return {static_cast<std::size_t>(begin - places_.begin()),
            static_cast<std::size_t>(end - places_.begin())};
  }

  void sample(const Corners& c, std::size_t i, std::size_t j) {
    const Vec3d d = direction(i, j);
    const double a = dot(d, cross(c[1], c[2])), b = dot(d, cross(c[2], c[0])), e = dot(d, cross(c[0], c[1]));
    const double sum = a + b + e, margin = std::fmin(a, std::fmin(b, e)) / sum;
    double& best = margins_[j * places_.size() + i];
    if (!(sum > 0.0) || !(margin > best)) return;
    best = margin;
    distances_[j * places_.size() + i] = dot(c[0], cross(c[1], c[2])) / sum;
  }

  const CubeFace& face_;
  const std::vector<double>& places_;
  std::vector<double> distances_, margins_;
};

[[noreturn]] void refuse(const std::filesystem::path& file) {
  throw InputError(file.string() +
                   ": an ICQ has one surface along each direction from the centre of mass, and this body has "
                   "several; write .ply or .tab, or leave out boulders and overhangs");
}

void require_star_shape(const TriangleMesh& mesh, const Vec3d& center, const std::filesystem::path& file) {
  const MeshTopology topology = analyze_topology(mesh);
  if (!topology.closed || !topology.oriented || topology.components != 1 || topology.genus != 0) refuse(file);
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3d &p = mesh.vertices[a], &q = mesh.vertices[b], &r = mesh.vertices[c];
    const Vec3d normal = cross(q - p, r - p);
    if (dot(p - center, normal) < 0.0) refuse(file);
  }
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

MeshCounts icq_counts(const MeshCounts& mesh) {
  const std::int64_t q = fitting_q(static_cast<std::size_t>(mesh.triangles));
  return {6 * q * q + 2, 12 * q * q};
}

void write_icq(const TriangleMesh& mesh, const std::filesystem::path& file, const MeshFileInfo&) {
  const Vec3d center = volume_centroid(mesh);
  require_star_shape(mesh, center, file);
  const int q = fitting_q(mesh.triangles.size());
  const std::vector<double> places = grid_places(q);
  OutputFile out(file);
  BufferedOutput buffer(out);
  buffer.append(std::to_string(q) + "\n");
  for (const CubeFace& face : kCubeFaces) {
    FaceSampler sampler(face, places);
    for (const auto& [a, b, c] : mesh.triangles)
      sampler.add({mesh.vertices[a] - center, mesh.vertices[b] - center, mesh.vertices[c] - center});
    for (std::size_t j = 0; j < places.size(); ++j) {
      for (std::size_t i = 0; i < places.size(); ++i) {
        if (!sampler.found(i, j)) refuse(file);
        buffer.append(point_text(center + sampler.point(i, j)) + "\n");
      }
    }
  }
  buffer.flush();
  out.commit();
}

}  // namespace astrolith
