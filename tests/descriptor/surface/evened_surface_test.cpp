#include "descriptor/surface/evened_surface.h"

#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "tests/descriptor/surface/rough_spheres.h"

namespace astrolith {
namespace {

using testing::icosphere;
using testing::sheet;

TEST(EvenedSurface, StaysOnASphere) {
  const EvenedSurface even = even_surface(icosphere(5), 4000, 1);
  ASSERT_EQ(even.points.size(), 4000u);
  EXPECT_NEAR(even.edge, std::sqrt(2 * 4 * std::numbers::pi / (std::sqrt(3.0) * 4000)), 1e-3 * even.edge);
  for (std::size_t i = 0; i < even.points.size(); ++i) {
    // A smoothed sphere shrinks by about rho^2 / 20, with rho the reach of the weights.
    EXPECT_NEAR(norm(even.points[i]), 1, 2 * even.edge * even.edge);
    EXPECT_GT(dot(even.normals[i], normalized(even.points[i])), 0.999);
  }
}

// The weights (1 - d^2 / rho^2)^3 over a plane let through 384 J4(x) / x^4 of a wave's height, x = k rho
// (Sonine's first integral).
TEST(EvenedSurface, LetsThroughAsMuchOfAWaveAsItsWeightsDo) {
  const double wave = 10, k = 2 * std::numbers::pi / wave;
  const TriangleMesh mesh = sheet(80, [&](double x, double) { return 0.1 * std::cos(k * x); });
  const EvenedSurface even = even_surface(mesh, 6400, 1);
  const double x = k * 3.5 * even.edge, expected = 384 * std::cyl_bessel_j(4, x) / (x * x * x * x),
               between = std::sin(k / 2) / (k / 2);  // straight lines between vertices take their share, too
  double along = 0, all = 0;
  for (const Vec3d& p : even.points) {
    if (std::min({p.x, p.y, 80 - p.x, 80 - p.y}) < 5) continue;
    along += p.z * std::cos(k * p.x);
    all += std::cos(k * p.x) * std::cos(k * p.x);
  }
  EXPECT_NEAR(along / all / 0.1, expected * between * between, 0.02 * expected);
}

TEST(EvenedSurface, OtherSideOfAThinPlateDoesNotCount) {
  TriangleMesh plate = sheet(40, [](double, double) { return 0.1; });
  plate = testing::joined(plate, testing::reversed(sheet(40, [](double, double) { return -0.1; })));
  for (const Vec3d& p : even_surface(plate, 3000, 1).points) ASSERT_NEAR(std::fabs(p.z), 0.1, 1e-12);
}

// The area of a mesh whose vertices were exchanged is hundreds of times that of its box.
TEST(EvenedSurface, AGarbledMeshIsNoSurface) {
  TriangleMesh mesh = icosphere(6);
  CounterRandom random(5);
  for (Triangle& t : mesh.triangles) {
    for (std::uint32_t& v : t) {
      v = static_cast<std::uint32_t>(random.uniform() * static_cast<double>(mesh.vertices.size()));
    }
  }
  EXPECT_THROW(even_surface(mesh, 20000, 1), InputError);
}

TEST(EvenedSurface, StopsWhenAsked) {
  EXPECT_THROW(even_surface(icosphere(4), 2000, 1, [](double, std::string_view) { return false; }),
               WorkError);
}

}  // namespace
}  // namespace astrolith
