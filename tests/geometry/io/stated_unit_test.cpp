
#include <gtest/gtest.h>

#include <fstream>

#include "geometry/io/mesh_io.h"
#include "tests/support/meshes.h"
#include "tests/support/scratch_folder.h"

namespace astrolith {
namespace {

using namespace testing;

TEST(StatedUnit, ComesBackFromWhatWritersState) {
  const ScratchFolder folder;
  for (const char* unit : {"m", "km", "cm", "mm", "px"}) {
    for (const char* name : {"a.ply", "a.ply.zst", "a.obj", "a.stl"}) {
      write_mesh(tetrahedron(), folder / name, {unit, "body-fixed", "a comment", {}});
      EXPECT_EQ(stated_length_unit(folder / name), unit) << name;
      EXPECT_TRUE(written_mesh_format(name).tells_unit) << name;
    }
  }
  write_mesh(tetrahedron(), folder / "none.ply", {"", "length unit", "", {}});
  EXPECT_EQ(stated_length_unit(folder / "none.ply"), "");
  write_mesh(tetrahedron(), folder / "plates.tab", {"km", "", "", {}});
  EXPECT_EQ(stated_length_unit(folder / "plates.tab"), "");
  EXPECT_TRUE(written_mesh_format("a.glb").tells_unit);
  for (const char* name : {"a.tab", "a.icq"}) EXPECT_FALSE(written_mesh_format(name).tells_unit) << name;
}

TEST(StatedUnit, OfOtherFilesIsEmpty) {
  const ScratchFolder folder;
  const auto unit_in = [&](const std::string& text) {
    std::ofstream(folder / "a.obj", std::ios::binary) << text;
    return stated_length_unit(folder / "a.obj");
  };
  EXPECT_EQ(stated_length_unit(folder / "absent.ply"), "");
  EXPECT_EQ(stated_length_unit(folder / "."), "");
  EXPECT_EQ(unit_in(""), "");
  EXPECT_EQ(unit_in("# length unit: "), "");
  EXPECT_EQ(unit_in("length unit: km\n"), "");
  EXPECT_EQ(unit_in("# the length unit: km\n"), "");
  EXPECT_EQ(unit_in("# length unit: parsecmillionths\n"), "");
  EXPECT_EQ(unit_in("# length unit: m\xff\n"), "m");
  EXPECT_EQ(unit_in("# length unit: km"), "km");
  EXPECT_EQ(unit_in("v 0 0 0\r\n# length unit: m\r\n"), "m");
  EXPECT_EQ(unit_in(std::string(4096, '\n') + "# length unit: m\n"), "");
  EXPECT_EQ(unit_in(std::string("\x28\xb5\x2f\xfd", 4) + "# length unit: m\n"), "");
}

}  // namespace
}  // namespace astrolith
