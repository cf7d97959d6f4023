#include "estimation/shape/target/surface_components.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "geometry/mesh_topology.h"

namespace astrolith {
namespace {

// Vertices of a piece that are asked which part is nearest.
constexpr std::size_t kVotes = 100;

// Triangles that hang together.
struct Piece {
  double volume = 0.0;  // negative of a cavity
  Box box;
  std::vector<std::uint32_t> vertices;  // as often as triangles name them
};

double cone_volume(const TriangleMesh& mesh, const Triangle& t) {
  return dot(mesh.vertices[t[0]], cross(mesh.vertices[t[1]], mesh.vertices[t[2]])) / 6.0;
}

std::vector<Piece> pieces_of(const TriangleMesh& mesh) {
  const std::vector<std::uint32_t> component = triangle_components(mesh);
  std::vector<Piece> pieces;
  for (std::size_t t = 0; t < component.size(); ++t) {
    if (component[t] >= pieces.size()) pieces.resize(component[t] + std::size_t{1});
    Piece& piece = pieces[component[t]];
    piece.volume += cone_volume(mesh, mesh.triangles[t]);
    for (const std::uint32_t v : mesh.triangles[t]) {
      piece.box.extend(mesh.vertices[v]);
      piece.vertices.push_back(v);
    }
  }
  return pieces;
}

// (#parts of the target) negative of a cavity's wall.
std::vector<double> part_volumes(const TargetBody& target) {
  std::vector<double> volumes(static_cast<std::size_t>(target.components), 0.0);
  for (std::size_t t = 0; t < target.mesh.triangles.size(); ++t) {
    volumes[target.component_of_triangle[t]] += cone_volume(target.mesh, target.mesh.triangles[t]);
  }
  return volumes;
}

std::size_t nearest_part(const TargetBody& target, const TriangleMesh& fit, const Piece& piece) {
  std::vector<int> votes(static_cast<std::size_t>(target.components), 0);
  if (votes.size() == 1) return 0;
  const std::size_t stride = std::max<std::size_t>(1, piece.vertices.size() / kVotes);
  for (std::size_t k = 0; k < piece.vertices.size(); k += stride) {
    const ClosestPoint closest = target.tree.closest(fit.vertices[piece.vertices[k]]);
    ++votes[target.component_of_triangle[closest.triangle]];
  }
  return static_cast<std::size_t>(std::max_element(votes.begin(), votes.end()) - votes.begin());
}

StrayPart stray_of(const TriangleMesh& fit, const Piece& piece) {
  StrayPart stray{piece.volume < 0.0, piece.box.center(), 0.0};
  for (const std::uint32_t v : piece.vertices) {
    stray.radius = std::max(stray.radius, norm(fit.vertices[v] - stray.center));
  }
  return stray;
}

}  // namespace

PartsComparison compare_parts(const TargetBody& target, const TriangleMesh& fit) {
  const std::vector<double> wanted = part_volumes(target);
  std::vector<Piece> pieces = pieces_of(fit);
  std::stable_sort(pieces.begin(), pieces.end(),
                   [](const Piece& a, const Piece& b) { return std::abs(a.volume) > std::abs(b.volume); });
  std::vector<bool> found(wanted.size(), false);
  PartsComparison comparison;
  for (const Piece& piece : pieces) {
    const std::size_t part = nearest_part(target, fit, piece);
    const bool alike = (piece.volume < 0.0) == (wanted[part] < 0.0);
    if (!alike || found[part]) {
      comparison.strays.push_back(stray_of(fit, piece));
    } else {
      found[part] = true;
    }
  }
  comparison.missing = std::count(found.begin(), found.end(), false);
  return comparison;
}

}  // namespace astrolith
