// Writes Gaskell's implicitly connected quadrilaterals: Q, then (Q+1)^2 vertices of each of the six faces of
// a cube. A body that is seen whole from its centre of mass is sampled along directions to the points of the
// cube; other bodies have several surfaces along a direction and are refused.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

#include "geometry/io/mesh_writers_internal.h"
#include "geometry/mesh_measure.h"
#include "geometry/mesh_topology.h"
#include "numerics/errors.h"
#include "numerics/portable_angles.h"

namespace astrolith {
namespace {

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
  const int q = static_cast<int>(std::sqrt(static_cast<double>(triangles) / 12.0) + 0.5);
  return q < 1 ? 1 : q > 16384 ? 16384 : q;
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
    const auto [left, right] = span_of(corners, face_.right);
    const auto [top, bottom] = span_of(corners, face_.down);
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
  std::array<std::size_t, 2> span_of(const Corners& corners, const Vec3d& axis) const {
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

void append_point(std::string& line, const Vec3d& p) {
  for (const double coordinate : {p.x, p.y, p.z}) {
    char digits[32];
    line += line.empty() ? "" : " ";
    line.append(digits, std::to_chars(digits, digits + sizeof digits, coordinate).ptr);
  }
  line += '\n';
}

}  // namespace

MeshCounts icq_counts(std::int64_t triangles) {
  const std::int64_t q = fitting_q(static_cast<std::size_t>(triangles));
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
        std::string line;
        append_point(line, center + sampler.point(i, j));
        buffer.append(line);
      }
    }
  }
  buffer.flush();
  out.commit();
}

}  // namespace astrolith
