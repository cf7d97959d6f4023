#include "geometry/mesh_measure.h"

namespace astrolith {
namespace {

// Six times the signed volume of the tetrahedron with corners a, b, c and 0. Callers move the origin near the
// mesh, so that meshes far from zero lose no digits.
double six_volumes(const Vec3d& a, const Vec3d& b, const Vec3d& c) { return dot(a, cross(b, c)); }

}  // namespace

double triangle_area(const TriangleMesh& mesh, const Triangle& t) {
  const Vec3d& a = mesh.vertices[t[0]];
  return 0.5 * norm(cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a));
}

double surface_area(const TriangleMesh& mesh) {
  double area = 0;
  for (const Triangle& t : mesh.triangles) area += triangle_area(mesh, t);
  return area;
}

double mean_edge(const TriangleMesh& mesh) {
  return std::sqrt(4.0 / std::sqrt(3.0) * surface_area(mesh) / static_cast<double>(mesh.triangles.size()));
}

double volume(const TriangleMesh& mesh) {
  const Vec3d origin = mesh.bounds().center();
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    sum += six_volumes(mesh.vertices[a] - origin, mesh.vertices[b] - origin, mesh.vertices[c] - origin);
  }
  return sum / 6;
}

Vec3d volume_centroid(const TriangleMesh& mesh) {
  const Vec3d origin = mesh.bounds().center();
  double total = 0;
  Vec3d moment;
  for (const auto& [i, j, k] : mesh.triangles) {
    const Vec3d a = mesh.vertices[i] - origin, b = mesh.vertices[j] - origin, c = mesh.vertices[k] - origin;
    const double v = six_volumes(a, b, c);
    total += v;
    moment += 0.25 * v * (a + b + c);
  }
  return total != 0 ? origin + (1 / total) * moment : origin;
}

Vec3d surface_centroid(const TriangleMesh& mesh) {
  const Vec3d origin = mesh.bounds().center();
  double total = 0;
  Vec3d moment;
  for (const Triangle& t : mesh.triangles) {
    const double area = triangle_area(mesh, t);
    total += area;
    moment += area / 3 * (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]] - 3.0 * origin);
  }
  return total > 0 ? origin + (1 / total) * moment : origin;
}

}  // namespace astrolith
