#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/mesh_measure.h"
#include "geometry/surface/decimated_mesh.h"
#include "geometry/surface/height_map.h"
#include "geometry/surface/mesh_sampling.h"
#include "geometry/surface/surface_tree.h"
#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "tests/support/meshes.h"

namespace astrolith {
namespace {

using namespace testing;

double smallest_gap(const std::vector<Vec3d>& points) {
  double gap2 = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) gap2 = std::min(gap2, squared_norm(points[i] - points[j]));
  }
  return std::sqrt(gap2);
}

TEST(MeshSampling, PointsLieInTheirTriangles) {
  const TriangleMesh mesh = torus(1, 0.4, 12, 8);
  const SurfaceSamples s = sample_surface(mesh, 1000, 5);
  for (std::size_t i = 0; i < s.points.size(); ++i) {
    const auto [a, b, c] = mesh.triangles[s.triangles[i]];
    const auto found = closest_on_triangle(s.points[i], mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
    ASSERT_LT(found.squared_distance, 1e-28);
    ASSERT_NEAR(norm(s.normals[i]), 1, 1e-12);
    ASSERT_NEAR(dot(s.normals[i], mesh.vertices[b] - mesh.vertices[a]), 0, 1e-12);
  }
}

// The mesh has large and small triangles. Counts follow the area: chi-square with #F - 1 degrees of freedom.
TEST(MeshSampling, CountsFollowArea) {
  const TriangleMesh mesh = torus(1, 0.8, 10, 10);
  const int n = 400000;
  const SurfaceSamples s = sample_surface(mesh, n, 11);
  std::vector<double> counts(mesh.triangles.size(), 0.0);
  for (const std::uint32_t t : s.triangles) ++counts[t];
  double chi2 = 0;
  const double total = surface_area(mesh);
  for (std::size_t t = 0; t < counts.size(); ++t) {
    const double expected = n * triangle_area(mesh, mesh.triangles[t]) / total;
    chi2 += (counts[t] - expected) * (counts[t] - expected) / expected;
  }
  EXPECT_NEAR(chi2, 199, 5 * std::sqrt(2 * 199.0));
}

// Within one triangle the mean is the centroid, and the second moments are those of a uniform density.
TEST(MeshSampling, UniformInsideATriangle) {
  const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, {}};
  const int n = 200000;
  double x = 0, xx = 0, xy = 0;
  for (const Vec3d& p : sample_surface(mesh, n, 2).points) {
    x += p.x / n;
    xx += p.x * p.x / n;
    xy += p.x * p.y / n;
  }
  EXPECT_NEAR(x, 1.0 / 3, 5 * 0.24 / std::sqrt(n));
  EXPECT_NEAR(xx, 1.0 / 6, 5 * 0.2 / std::sqrt(n));
  EXPECT_NEAR(xy, 1.0 / 12, 5 * 0.1 / std::sqrt(n));
}

TEST(MeshSampling, FewerSamplesAreAPrefix) {
  const TriangleMesh mesh = icosphere(2);
  const auto many = sample_surface(mesh, 500, 9), few = sample_surface(mesh, 100, 9);
  EXPECT_TRUE(std::equal(few.points.begin(), few.points.end(), many.points.begin()));
  EXPECT_FALSE(sample_surface(mesh, 1, 10).points[0] == few.points[0]);
}

TEST(MeshSampling, InterpolatedNormalsOfASphere) {
  const auto s = sample_surface(icosphere(3), 1000, 1, SampleNormals::interpolated);
  for (std::size_t i = 0; i < s.points.size(); ++i) {
    ASSERT_NEAR(norm(s.normals[i] - normalized(s.points[i])), 0, 5e-3);
  }
}

TEST(PoissonDisk, ExactlyAsManyAndEvenlySpread) {
  const TriangleMesh mesh = icosphere(4);
  for (const int n : {1, 2, 10, 1000}) {
    const auto s = sample_poisson_disk(mesh, n, 3);
    ASSERT_EQ(static_cast<int>(s.points.size()), n);
    ASSERT_EQ(s.normals.size(), s.points.size());
  }
  const int n = 1000;
  const double r_max = poisson_disk_radius(surface_area(mesh), n);
  // Yuksel reports relative radii of 0.7 and more; independent points reach about 0.02.
  EXPECT_GT(smallest_gap(sample_poisson_disk(mesh, n, 3).points), 0.65 * 2 * r_max);
  EXPECT_LT(smallest_gap(sample_surface(mesh, n, 3).points), 0.1 * 2 * r_max);
}

TEST(PoissonDisk, NoHolesEither) {
  const TriangleMesh mesh = torus(1, 0.4);
  const int n = 800;
  const auto disks = sample_poisson_disk(mesh, n, 4);
  const double r_max = poisson_disk_radius(surface_area(mesh), n);
  double largest = 0;
  for (const Vec3d& p : sample_surface(mesh, 3000, 5).points) {
    double nearest = 1e300;
    for (const Vec3d& q : disks.points) nearest = std::min(nearest, squared_norm(p - q));
    largest = std::max(largest, std::sqrt(nearest));
  }
  EXPECT_LT(largest, 2 * r_max);
}

TEST(PoissonDisk, SameForAnyThreadCount) {
  const TriangleMesh mesh = torus(1, 0.4);
  std::vector<Vec3d> one;
  {
    const ThreadLimit limit(1);
    one = sample_poisson_disk(mesh, 500, 6).points;
  }
  const ThreadLimit limit(4);
  EXPECT_EQ(sample_poisson_disk(mesh, 500, 6).points, one);
}

// A stop acts in each part: while candidates are drawn, while their crowding is summed, and while they go.
TEST(PoissonDisk, StopsWhenAsked) {
  int reports = 0;
  const auto count = [&](double, std::string_view) { return ++reports > 0; };
  sample_poisson_disk(cube(), 20000, 1, SampleNormals::triangle, count);
  ASSERT_GT(reports, 20);
  for (const int last : {1, 20}) {
    int asked = 0;
    const auto stop_at_last = [&](double, std::string_view) { return ++asked < last; };
    EXPECT_THROW(sample_poisson_disk(cube(), 20000, 1, SampleNormals::triangle, stop_at_last), WorkError);
    EXPECT_EQ(asked, last);
  }
}

TEST(MeshSampling, NothingToSample) {
  EXPECT_THROW(sample_surface({}, 10, 1), InputError);
  EXPECT_THROW(sample_surface({{{0, 0, 0}, {1, 0, 0}}, {{0, 1, 1}}, {}}, 10, 1), InputError);
  EXPECT_THROW(sample_surface(cube(), -1, 1), InputError);
  EXPECT_TRUE(sample_surface(cube(), 0, 1).points.empty());
}

TEST(DecimatedMesh, KeepsTheSphereWithATenthOfItsVertices) {
  const TriangleMesh sphere = testing::icosphere(5);
  const TriangleMesh fewer = decimated(sphere, 1000);
  EXPECT_LE(fewer.vertices.size(), 1000u);
  EXPECT_EQ(fewer.triangles.size(), 2 * fewer.vertices.size() - 4) << "still a closed sphere";
  for (const Vec3d& p : fewer.vertices) EXPECT_NEAR(norm(p), 1.0, 5e-3);
}

TEST(DecimatedMesh, LeavesASmallMeshAlone) {
  const TriangleMesh sphere = testing::icosphere(2);
  EXPECT_EQ(decimated(sphere, 1000).triangles.size(), sphere.triangles.size());
}

TEST(ClusteredMesh, HasAboutTheVerticesThatAreAskedFor) {
  const TriangleMesh sphere = testing::icosphere(6);
  const TriangleMesh fewer = clustered(sphere, 2000);
  EXPECT_NEAR(static_cast<double>(fewer.vertices.size()), 2000.0, 700.0);
  EXPECT_NEAR(static_cast<double>(fewer.triangles.size()), 4000.0, 1400.0);
  for (const Vec3d& p : fewer.vertices) EXPECT_NEAR(norm(p), 1.0, 5e-3);
  EXPECT_EQ(clustered(fewer, 5000).triangles, fewer.triangles);
}

// A grid of n x n quadrilaterals over [-1, 1]^2 with heights f, seen along `up`.
template <typename Height>
TriangleMesh terrain(int n, const Vec3d& right, const Vec3d& ahead, const Vec3d& center, const Height& f) {
  TriangleMesh mesh;
  const Vec3d up = cross(right, ahead);
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      const double x = 2.0 * i / n - 1, y = 2.0 * j / n - 1;
      mesh.vertices.push_back(center + x * right + y * ahead + f(x, y) * up);
    }
  }
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const auto at = [&](int a, int b) { return static_cast<std::uint32_t>((j + b) * (n + 1) + i + a); };
      mesh.triangles.push_back({at(0, 0), at(1, 0), at(1, 1)});
      mesh.triangles.push_back({at(0, 0), at(1, 1), at(0, 1)});
    }
  }
  return mesh;
}

// The formula of the header gives back points of the surface.
TEST(HeightMap, PixelsLieOnTheSurface) {
  const Vec3d up = normalized(Vec3d{2, 1, 1}), right = normalized(cross(Vec3d{0, 0, 1}, up)),
              ahead = cross(up, right);
  const auto f = [](double x, double y) { return 0.1 * std::sin(3 * x) * std::cos(2 * y); };
  const Vec3d center{5, -7, 11};
  const TriangleMesh wavy = terrain(200, right, ahead, center, f);
  const HeightMap map = height_map(wavy, *mean_plane(wavy), 1.6, 64, 1000.0);
  ASSERT_EQ(map.heights.size(), 64u * 64);
  EXPECT_LT(norm(map.up - up), 1e-2);
  EXPECT_NEAR(dot(cross(map.right, map.ahead), map.up), 1.0, 1e-12);
  for (int j = 0; j < 64; ++j) {
    for (int i = 0; i < 64; ++i) {
      const double height = map.heights[static_cast<std::size_t>(64 * j + i)] / 1000.0;
      ASSERT_TRUE(std::isfinite(height));
      const Vec3d p = map.origin + (i + 0.5 - 32) * map.pixel * map.right +
                      (32 - (j + 0.5)) * map.pixel * map.ahead + height * map.up - center;
      EXPECT_NEAR(dot(p, up), f(dot(p, right), dot(p, ahead)), 2e-4);
    }
  }
}

TEST(HeightMap, NoDataOutsideAndTheHighestOfSeveral) {
  const auto flat = [](double, double) { return 0.0; };
  const TriangleMesh low = terrain(4, {1, 0, 0}, {0, 1, 0}, {}, flat);
  const HeightMap wide = height_map(low, *mean_plane(low), 4.0, 8, 1.0);
  EXPECT_TRUE(std::isnan(wide.heights.front()));
  EXPECT_EQ(wide.heights[8 * 4 + 4], 0.0f);
  TriangleMesh high = terrain(4, {0.25, 0, 0}, {0, 0.25, 0}, {}, flat);
  for (Vec3d& p : high.vertices) p.z = 0.5;
  const TriangleMesh two = testing::joined(low, high);
  const HeightMap both = height_map(two, *mean_plane(two), 1.0, 8, 1.0);
  EXPECT_NEAR(both.heights[8 * 4 + 4] - both.heights[0], 0.5, 1e-6);
}

// A slope with one pixel that stands out by h: the rms about the plane of n x n pixels is about h / n.
TEST(FootprintPlanes, HaveTheSlopeOfAPlaneAndSeeAPixelThatStandsOut) {
  HeightMap map{9, 0.5, {}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {}};
  for (int j = 0; j < 9; ++j) {
    for (int i = 0; i < 9; ++i) map.heights.push_back(static_cast<float>(0.25 * i * 0.5 - 0.75 * j * 0.5));
  }
  const std::vector<FootprintPlane> even = footprint_planes(map, 2);
  for (const std::size_t at : {2u * 9 + 2, 4u * 9 + 4, 6u * 9 + 6}) {
    EXPECT_NEAR(even[at].along_right, 0.25, 1e-6);
    EXPECT_NEAR(even[at].along_ahead, 0.75, 1e-6);
    EXPECT_NEAR(even[at].rms, 0.0, 1e-6);
  }
  EXPECT_TRUE(std::isnan(even[1 * 9 + 4].rms)) << "the square leaves the map";
  map.heights[4 * 9 + 4] += 1.0f;
  EXPECT_NEAR(footprint_planes(map, 2)[4 * 9 + 4].rms, std::sqrt(1.0 / 25 - 1.0 / 625), 1e-6);
  map.heights[4 * 9 + 4] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(std::isnan(footprint_planes(map, 2)[5 * 9 + 5].rms));
  EXPECT_TRUE(std::isnan(footprint_planes(map, 5)[4 * 9 + 4].rms));
}

// The squares of many bands, against sums over each square by itself; some pixels have no height.
TEST(FootprintPlanes, AreThoseOfEachSquareByItself) {
  constexpr int kSide = 150, kHalf = 7;
  HeightMap map{kSide, 0.5, {}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {}};
  for (int at = 0; at < kSide * kSide; ++at) {
    const double i = at % kSide, j = at / kSide;
    map.heights.push_back(
        static_cast<float>(1000.0 + 3.0 * std::sin(0.1 * i) * std::cos(0.07 * j) + 0.02 * i));
  }
  map.heights[60 * kSide + 70] = std::numeric_limits<float>::quiet_NaN();
  const std::vector<FootprintPlane> planes = footprint_planes(map, kHalf);
  int known = 0;
  for (int j = kHalf; j < kSide - kHalf; ++j) {
    for (int i = kHalf; i < kSide - kHalf; ++i) {
      double mean = 0.0, right = 0.0, ahead = 0.0, squares = 0.0, spread = 0.0;
      const auto each = [&](const auto& take) {
        for (int y = -kHalf; y <= kHalf; ++y) {
          for (int x = -kHalf; x <= kHalf; ++x)
            take(double{map.heights[static_cast<std::size_t>((j + y) * kSide + i + x)]}, x, y);
        }
      };
      const double count = (2 * kHalf + 1) * (2 * kHalf + 1);
      each([&](double z, int, int) { mean += z / count; });
      each(
          [&](double z, int x, int y) { right += (z - mean) * x, ahead -= (z - mean) * y, spread += x * x; });
      right /= spread, ahead /= spread;
      each([&](double z, int x, int y) {
        const double off = z - mean - right * x + ahead * y;
        squares += off * off / count;
      });
      const FootprintPlane& plane = planes[static_cast<std::size_t>(j * kSide + i)];
      if (std::isnan(mean)) {
        ASSERT_TRUE(std::isnan(plane.rms));
        continue;
      }
      ++known;
      ASSERT_NEAR(plane.along_right, right / map.pixel, 1e-7);
      ASSERT_NEAR(plane.along_ahead, ahead / map.pixel, 1e-7);
      ASSERT_NEAR(plane.rms, std::sqrt(squares), 1e-7);
    }
  }
  EXPECT_EQ(known, (kSide - 2 * kHalf) * (kSide - 2 * kHalf) - 15 * 15);
}

TEST(HeightMap, ABodyFacesNoDirection) {
  EXPECT_FALSE(mean_plane(testing::octahedron()));
  EXPECT_FALSE(mean_plane({}));
}

}  // namespace
}  // namespace astrolith
