#include "estimation/shape/details/moved_mesh.h"

#include "descriptor/histogram_distance.h"
#include "descriptor/surflet_histogram.h"
#include "geometry/surface/sample_curvature.h"
#include "tests/support/meshes.h"

namespace astrolith {
namespace {

ShapeHistogram described(const TriangleMesh& mesh, const SurfaceSamples& samples, double radius) {
  return ahd_histogram(samples.points, samples.normals, sample_curvature(mesh, samples, radius).gaussian);
}

std::vector<MeshPlace> places_of(const TriangleMesh& mesh, const SurfaceSamples& samples) {
  const SurfaceTree tree(mesh);
  std::vector<MeshPlace> places;
  for (const Vec3d& p : samples.points) places.push_back(nearest_place(mesh, tree, p));
  return places;
}

TEST(MovedMesh, UnmovedHasTheDescriptorOfItsMesh) {
  const TriangleMesh mesh = testing::torus(1.0, 0.4);
  const SurfaceSamples samples = sample_surface(mesh, 600, 1);
  const MovedMesh moved(mesh, places_of(mesh, samples), 0.2);
  EXPECT_GT(similarity(moved.histogram(mesh.vertices), described(mesh, samples, 0.2)), 0.99);
}

TEST(MovedMesh, SamplesFollowTheirTriangles) {
  const TriangleMesh mesh = testing::icosphere(4);
  const SurfaceSamples samples = sample_surface(mesh, 600, 1);
  const MovedMesh moved(mesh, places_of(mesh, samples), 0.3);
  TriangleMesh egg = mesh;
  for (Vec3d& p : egg.vertices) p.x *= 1.6;
  SurfaceSamples on_egg = samples;
  for (std::size_t i = 0; i < samples.points.size(); ++i) {
    on_egg.points[i].x *= 1.6;
    const Triangle& t = egg.triangles[samples.triangles[i]];
    on_egg.normals[i] =
        normalized(cross(egg.vertices[t[1]] - egg.vertices[t[0]], egg.vertices[t[2]] - egg.vertices[t[0]]));
  }
  const ShapeHistogram of_egg = moved.histogram(egg.vertices);
  EXPECT_GT(similarity(of_egg, described(egg, on_egg, 0.3)), 0.97);
  EXPECT_LT(similarity(of_egg, moved.histogram(mesh.vertices)), 0.8);
}

}  // namespace
}  // namespace astrolith
