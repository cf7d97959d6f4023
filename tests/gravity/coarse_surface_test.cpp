#include "gravity/coarse_surface.h"

#include <gtest/gtest.h>

#include <map>

#include "geometry/mesh_measure.h"
#include "tests/support/meshes.h"

namespace astrolith {
namespace {

// Every directed edge is met as often as the opposite one: the facets enclose a volume.
bool is_closed(const TriangleMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> surplus;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      ++surplus[{t[k], t[(k + 1) % 3]}];
      --surplus[{t[(k + 1) % 3], t[k]}];
    }
  }
  return std::all_of(surplus.begin(), surplus.end(), [](const auto& edge) { return edge.second == 0; });
}

TEST(CoarseSurface, IsClosedAndKeepsTheVolume) {
  const TriangleMesh ball = testing::icosphere(6);
  for (const auto& [cells, error] : {std::pair{12, 0.05}, std::pair{48, 0.004}}) {
    const CoarseSurface coarse = coarse_surface(ball, cells);
    EXPECT_TRUE(is_closed(coarse.mesh));
    EXPECT_NEAR(volume(coarse.mesh) / volume(ball), 1.0, error);
    EXPECT_LT(coarse.mesh.triangles.size(), 10.0 * cells * cells);
  }
}

TEST(CoarseSurface, EachVertexLiesNearTheMeanOfItsCell) {
  const TriangleMesh ball = testing::icosphere(5);
  const CoarseSurface coarse = coarse_surface(ball, 20);
  ASSERT_EQ(coarse.cell.size(), ball.vertices.size());
  for (std::size_t i = 0; i < ball.vertices.size(); ++i) {
    EXPECT_LE(norm(ball.vertices[i] - coarse.mesh.vertices[coarse.cell[i]]),
              std::sqrt(3.0) * 2.0 / 20 + 1e-9);
  }
}

TEST(CoarseSurface, OneCellHoldsAll) {
  const CoarseSurface coarse = coarse_surface(testing::icosphere(1), 1);
  EXPECT_TRUE(coarse.mesh.triangles.empty());
  EXPECT_LE(coarse.mesh.vertices.size(), 8u);  // those on the far sides of the box have cells of their own
}

}  // namespace
}  // namespace astrolith
