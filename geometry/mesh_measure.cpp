#include "geometry/mesh_measure.h"

#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include "numerics/parallel_for.h"
#include "numerics/portable_angles.h"
#include "numerics/sample_statistics.h"

namespace astrolith {
namespace {

// The angle between two vectors in [0, pi]. It is accurate near 0 and pi, unlike the arc cosine.
double angle_between(const Vec3d& a, const Vec3d& b) { return portable::atan2(norm(cross(a, b)), dot(a, b)); }

// Six times the signed volume of the tetrahedron with corners a, b, c and 0. Callers move the origin near the
// mesh, so that meshes far from zero lose no digits.
double six_volumes(const Vec3d& a, const Vec3d& b, const Vec3d& c) { return dot(a, cross(b, c)); }

}  // namespace

Vec3d triangle_normal(const TriangleMesh& mesh, const Triangle& t) {
  const Vec3d& a = mesh.vertices[t[0]];
  return normalized(cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a));
}

std::vector<Vec3d> triangle_normals(const TriangleMesh& mesh) {
  std::vector<Vec3d> normals;
  normals.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) normals.push_back(triangle_normal(mesh, t));
  return normals;
}

std::vector<Vec3d> vertex_normals(const TriangleMesh& mesh) {
  std::vector<Vec3d> sums(mesh.vertices.size());
  for (const Triangle& t : mesh.triangles) {
    const Vec3d n = triangle_normal(mesh, t);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d& p = mesh.vertices[t[k]];
      sums[t[k]] += angle_between(mesh.vertices[t[(k + 1) % 3]] - p, mesh.vertices[t[(k + 2) % 3]] - p) * n;
    }
  }
  for (Vec3d& n : sums) n = normalized(n);
  return sums;
}

float triangle_quality(const Vec3f& a, const Vec3f& b, const Vec3f& c) {
  constexpr float kTwoSqrtThree = 3.46410162f;
  const Vec3f ab = b - a, ac = c - a;
  const float edges = squared_norm(ab) + squared_norm(ac) + squared_norm(c - b);
  return edges > 0.0f ? kTwoSqrtThree * norm(cross(ab, ac)) / edges : 0.0f;
}

QualityFigures mesh_quality(std::span<const MeshVertex> vertices, std::span<const Triangle> triangles) {
  constexpr std::int64_t kGrain = 4096;
  constexpr std::size_t kPercent = 100;
  if (triangles.empty()) return {};
  std::vector<float> quality(triangles.size());
  parallel_for(
      0, static_cast<std::int64_t>(quality.size()),
      [&](std::int64_t i) {
        const Triangle& t = triangles[static_cast<std::size_t>(i)];
        quality[static_cast<std::size_t>(i)] =
            triangle_quality(vertices[t[0]].position, vertices[t[1]].position, vertices[t[2]].position);
      },
      kGrain);
  const double mean = std::accumulate(quality.begin(), quality.end(), 0.0) / double(quality.size());
  const std::size_t first = quality.size() / kPercent;
  return {double{ranked_value(std::move(quality), first)}, mean};
}

double winding_number(const TriangleMesh& mesh, const Vec3d& p) {
  double half_angles = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3d a = mesh.vertices[t[0]] - p, b = mesh.vertices[t[1]] - p, c = mesh.vertices[t[2]] - p;
    const double la = norm(a), lb = norm(b), lc = norm(c);
    const double away = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
    half_angles += portable::atan2(dot(a, cross(b, c)), away);
  }
  return half_angles / (2.0 * std::numbers::pi);
}

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
