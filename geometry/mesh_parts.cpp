#include "geometry/mesh_parts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "geometry/mesh_measure.h"
#include "geometry/winding_number.h"
#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

// The faces whose boxes touch this box.
std::vector<Triangle> faces_in(const Box& box, const TriangleMesh& mesh) {
  std::vector<Triangle> near;
  for (const Triangle& t : mesh.triangles) {
    Box own;
    for (const std::uint32_t v : t) own.extend(mesh.vertices[v]);
    if (boxes_touch(box, own)) near.push_back(t);
  }
  return near;
}

// The centre of a face, or also its corners and the middles of its sides: large faces pass through another
// part that holds none of their corners.
std::vector<Vec3d> places_of(const TriangleMesh& mesh, const Triangle& t, bool coarse) {
  const Vec3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
  const Vec3d center = (a + b + c) * (1.0 / 3.0);
  if (!coarse) return {center};
  return {center, a, b, c, 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)};
}

}  // namespace

std::vector<MeshPart> parts_of(const TriangleMesh& mesh, const std::vector<std::uint32_t>& number) {
  std::vector<MeshPart> parts(1 + *std::max_element(number.begin(), number.end()));
  // Parts may share a vertex: it is numbered anew by each part that comes upon it.
  std::vector<std::uint32_t> owner(mesh.vertices.size(), 0xffffffff), place(mesh.vertices.size(), 0);
  std::vector<std::vector<std::uint32_t>> faces(parts.size());
  for (std::uint32_t f = 0; f < number.size(); ++f) faces[number[f]].push_back(f);
  for (std::uint32_t p = 0; p < parts.size(); ++p) {
    MeshPart& part = parts[p];
    for (const std::uint32_t f : faces[p]) {
      Triangle triangle = mesh.triangles[f];
      for (std::uint32_t& v : triangle) {
        if (owner[v] != p) {
          owner[v] = p;
          place[v] = static_cast<std::uint32_t>(part.mesh.vertices.size());
          part.mesh.vertices.push_back(mesh.vertices[v]);
          part.box.extend(mesh.vertices[v]);
        }
        v = place[v];
      }
      part.mesh.triangles.push_back(triangle);
    }
    part.volume = volume(part.mesh);
  }
  return parts;
}

bool box_holds(const Box& outer, const Box& inner) {
  const Box common = common_part(outer, inner);
  return common.min == inner.min && common.max == inner.max;
}

double PartNesting::share_inside(const MeshPart& a, const MeshPart& b) {
  constexpr std::size_t kMostFaces = 64;
  const std::vector<Triangle> near = faces_in(common_part(a.box, b.box), a.mesh);
  const bool coarse = a.mesh.triangles.size() < 1000;
  std::vector<Vec3d> places;
  for (std::size_t i = 0; i < near.size(); i += near.size() / kMostFaces + 1) {
    for (const Vec3d& p : places_of(a.mesh, near[i], coarse)) places.push_back(p);
  }
  angles_left_ -= static_cast<double>(places.size()) * static_cast<double>(b.mesh.triangles.size());
  if (spent()) return 0.0;
  std::vector<double> windings(places.size());
  parallel_for(0, static_cast<std::int64_t>(places.size()), [&](std::int64_t i) {
    const auto k = static_cast<std::size_t>(i);
    windings[k] = std::abs(winding_number(b.mesh, places[k]));
  });
  const auto inside = std::count_if(windings.begin(), windings.end(), [](double w) { return w > 0.75; });
  const auto outside = std::count_if(windings.begin(), windings.end(), [](double w) { return w < 0.25; });
  return inside > 0 ? static_cast<double>(inside) / static_cast<double>(inside + outside) : 0.0;
}

bool PartNesting::lies_inside(const MeshPart& a, const MeshPart& b) {
  constexpr double kBoxTest = 16.0;  // about the time of so many angles
  angles_left_ -= kBoxTest;
  return box_holds(b.box, a.box) && !spent() && share_inside(a, b) == 1.0;
}

}  // namespace astrolith
