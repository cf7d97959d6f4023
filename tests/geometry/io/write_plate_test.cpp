#include <gtest/gtest.h>

#include <fstream>

#include "geometry/io/mesh_io.h"
#include "tests/support/meshes.h"
#include "tests/support/scratch_folder.h"

namespace astrolith {
namespace {

using namespace testing;

TEST(WritePlate, RoundTripIsExact) {
  const ScratchFolder folder;
  const TriangleMesh mesh = icosphere(3, 1.0 / 3, {1e-7, 1e5, 0});
  write_mesh(mesh, folder / "a.tab", {"km", "", "", {}});
  const TriangleMesh back = read_mesh(folder / "a.tab");
  EXPECT_TRUE(back.vertices == mesh.vertices);
  EXPECT_TRUE(back.triangles == mesh.triangles);
}

// A reader after the description of the format.
TEST(WritePlate, RowsAreNumberedFromOne) {
  const ScratchFolder folder;
  const TriangleMesh mesh = tetrahedron();
  write_mesh(mesh, folder / "a.tab", {"km", "", "", {}});
  std::ifstream file(folder / "a.tab");
  std::size_t count = 0, number = 0;
  ASSERT_TRUE(file >> count);
  ASSERT_EQ(count, 4u);
  for (std::size_t i = 1; i <= count; ++i) {
    Vec3d p;
    ASSERT_TRUE(file >> number >> p.x >> p.y >> p.z);
    EXPECT_EQ(number, i);
    EXPECT_TRUE(p == mesh.vertices[i - 1]);
  }
  ASSERT_TRUE(file >> count);
  ASSERT_EQ(count, 4u);
  for (std::size_t i = 1; i <= count; ++i) {
    std::uint32_t a = 0, b = 0, c = 0;
    ASSERT_TRUE(file >> number >> a >> b >> c);
    EXPECT_EQ(number, i);
    EXPECT_TRUE((mesh.triangles[i - 1] == Triangle{a - 1, b - 1, c - 1}));
  }
}

}  // namespace
}  // namespace astrolith
