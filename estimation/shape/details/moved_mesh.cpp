#include "estimation/shape/details/moved_mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "descriptor/surflet_histogram.h"
#include "geometry/mesh_normals.h"

namespace astrolith {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

Vec3d facet(const std::vector<Vec3d>& vertices, const Triangle& t) {
  return cross(vertices[t[1]] - vertices[t[0]], vertices[t[2]] - vertices[t[0]]);
}

double angle_between(const Vec3d& a, const Vec3d& b) { return std::atan2(norm(cross(a, b)), dot(a, b)); }

// The integral of the curvature around every vertex, 2 pi minus the sum of its angles, and the area around
// it, a third of its triangles. Meyer et al. divide the area among the vertices a little differently (mixed
// areas). A mean over many vertices does not show the difference.
struct VertexIntegrals {
  std::vector<double> curvature, area;
};

VertexIntegrals vertex_integrals(const std::vector<Vec3d>& vertices, const std::vector<Triangle>& triangles) {
  VertexIntegrals result{std::vector<double>(vertices.size(), kTwoPi),
                         std::vector<double>(vertices.size(), 0.0)};
  for (const Triangle& t : triangles) {
    const double third = norm(facet(vertices, t)) / 6.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d& here = vertices[t[k]];
      const Vec3d next = vertices[t[(k + 1) % 3]] - here, previous = vertices[t[(k + 2) % 3]] - here;
      result.curvature[t[k]] -= angle_between(next, previous);
      result.area[t[k]] += third;
    }
  }
  return result;
}

}  // namespace

MovedMesh::MovedMesh(const TriangleMesh& mesh, const std::vector<MeshPlace>& samples, double radius)
    : triangles_(mesh.triangles), samples_(samples) {
  const std::vector<Vec3d> normals = vertex_normals(mesh);
  for (const MeshPlace& sample : samples_) add_neighbours(mesh, normals, sample, radius);
}

void MovedMesh::add_neighbours(const TriangleMesh& mesh, const std::vector<Vec3d>& normals,
                               const MeshPlace& sample, double radius) {
  const Triangle& t = triangles_[sample.triangle];
  const Vec3d point = sample.interpolate(triangles_, mesh.vertices), normal = facet(mesh.vertices, t);
  double reach = radius;
  for (const std::uint32_t v : t) reach = std::max(reach, norm(mesh.vertices[v] - point));
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    const double closeness = 1.0 - squared_norm(mesh.vertices[v] - point) / (reach * reach);
    if (closeness <= 0.0 || dot(normals[v], normal) <= 0.0) continue;
    neighbours_.push_back({v, static_cast<float>(closeness * closeness)});
  }
  first_neighbour_.push_back(neighbours_.size());
}

PairInput MovedMesh::pair_input(const std::vector<Vec3d>& vertices) const {
  const VertexIntegrals integrals = vertex_integrals(vertices, triangles_);
  std::vector<Vec3d> points, normals;
  std::vector<double> curvatures;
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    points.push_back(samples_[i].interpolate(triangles_, vertices));
    normals.push_back(facet(vertices, triangles_[samples_[i].triangle]));
    double curvature = 0.0, area = 0.0;
    for (std::size_t k = first_neighbour_[i]; k < first_neighbour_[i + 1]; ++k) {
      const double weight = double{neighbours_[k].weight};
      curvature += weight * integrals.curvature[neighbours_[k].vertex];
      area += weight * integrals.area[neighbours_[k].vertex];
    }
    curvatures.push_back(area > 0.0 ? curvature / area : 0.0);
  }
  return ahd_input(points, normals, curvatures);
}

ShapeHistogram MovedMesh::histogram(const std::vector<Vec3d>& vertices) const {
  const PairInput input = pair_input(vertices);
  return ahd_histogram(
      input, count_pairs(input.points, input.normals, input.local, input.num_local, input.bins, {}));
}

}  // namespace astrolith
