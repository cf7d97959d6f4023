#include <fstream>

#include "geometry/io/mesh_io.h"
#include "geometry/mesh_measure.h"
#include "geometry/mesh_topology.h"
#include "numerics/errors.h"
#include "tests/support/data.h"
#include "tests/support/meshes.h"
#include "tests/support/scratch_folder.h"

namespace astrolith {
namespace {

using namespace testing;

const MeshFileInfo kInfo{"km", "body-fixed, +z spin pole", "a test\nof two lines"};

// The coordinates are multiples of 2^-18 below 32. They have 23 bits, and float32 holds them exactly. Round
// trips can therefore be exact.
double on_float_grid(double x) { return std::round(x * 262144) / 262144; }

TriangleMesh float_body(bool with_normals) {
  TriangleMesh mesh = icosphere(3, 1.7, {0.25, -3, 12});
  if (with_normals) mesh.normals = vertex_normals(mesh);
  for (Vec3d& v : mesh.vertices) v = {on_float_grid(v.x), on_float_grid(v.y), on_float_grid(v.z)};
  for (Vec3d& v : mesh.normals) v = {on_float_grid(v.x), on_float_grid(v.y), on_float_grid(v.z)};
  return mesh;
}

TEST(MeshIo, PlyRoundTripIsExact) {
  const ScratchFolder folder;
  for (const bool with_normals : {false, true}) {
    const TriangleMesh mesh = float_body(with_normals);
    write_mesh(mesh, folder / "a.ply", kInfo);
    const TriangleMesh back = read_mesh(folder / "a.ply");
    EXPECT_TRUE(back.vertices == mesh.vertices);
    EXPECT_TRUE(back.triangles == mesh.triangles);
    EXPECT_TRUE(back.normals == mesh.normals);
  }
}

TEST(MeshIo, ObjRoundTripIsExactInDouble) {
  const ScratchFolder folder;
  TriangleMesh mesh = icosphere(2, 1.0 / 3, {1e-7, 1e5, 0});
  write_mesh(mesh, folder / "a.obj", kInfo);
  EXPECT_TRUE(read_mesh(folder / "a.obj").vertices == mesh.vertices);
  mesh.normals = vertex_normals(mesh);
  write_mesh(mesh, folder / "b.OBJ", kInfo);
  const TriangleMesh back = read_mesh(folder / "b.OBJ");
  EXPECT_TRUE(back.vertices == mesh.vertices);
  EXPECT_TRUE(back.triangles == mesh.triangles);
}

// STL keeps no vertex numbers. The shape must come back, welded and closed.
TEST(MeshIo, StlRoundTripKeepsTheShape) {
  const ScratchFolder folder;
  const TriangleMesh mesh = float_body(false);
  write_mesh(mesh, folder / "a.stl", kInfo);
  const TriangleMesh back = read_mesh(folder / "a.stl");
  EXPECT_EQ(back.vertices.size(), mesh.vertices.size());
  EXPECT_EQ(back.triangles.size(), mesh.triangles.size());
  EXPECT_TRUE(analyze_topology(back).closed);
  EXPECT_NEAR(volume(back), volume(mesh), 1e-9);
}

TEST(MeshIo, FilesStateUnitAndFrame) {
  const ScratchFolder folder;
  for (const char* name : {"a.ply", "a.obj", "a.stl", "a.glb"}) {
    write_mesh(icosphere(1, 1), folder / name, kInfo);
    const std::string content = read_text(folder / name);
    const bool in_metres = std::string(name) == "a.glb";
    EXPECT_NE(content.find(in_metres ? R"("length_unit":"m")" : "km"), content.npos) << name;
    EXPECT_NE(content.find("+z spin pole"), content.npos) << name;
  }
}

TEST(MeshIo, SameMeshSameBytes) {
  const ScratchFolder folder;
  for (const char* extension : {".ply", ".obj", ".stl", ".glb"}) {
    const std::string a = std::string("a") + extension, b = std::string("b") + extension;
    write_mesh(float_body(true), folder / a, kInfo);
    write_mesh(float_body(true), folder / b, kInfo);
    EXPECT_TRUE(read_text(folder / a) == read_text(folder / b));
  }
}

TEST(MeshIo, WhatCannotBeWrittenLeavesNothing) {
  const ScratchFolder folder;
  const TriangleMesh mesh = icosphere(1, 1);
  EXPECT_THROW(write_mesh(mesh, folder / "a.xyz", {}), InputError);
  EXPECT_THROW(written_mesh_format("a.off"), InputError);
  EXPECT_NO_THROW(written_mesh_format("A.GLB"));
  EXPECT_THROW(write_mesh(mesh, folder.path() / "none" / "a.ply", {}), InputError);
  EXPECT_THROW(write_mesh({}, folder / "a.ply", {}), WorkError);
  TriangleMesh broken = mesh;
  broken.triangles[3][1] = 1000;
  EXPECT_THROW(write_mesh(broken, folder / "a.obj", {}), WorkError);
  broken = mesh;
  broken.vertices[2].y = std::nan("");
  EXPECT_THROW(write_mesh(broken, folder / "a.glb", {}), WorkError);
  broken = mesh;
  broken.normals.resize(3);
  EXPECT_THROW(write_mesh(broken, folder / "a.stl", {}), WorkError);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(MeshIo, BodiesOfOpenUniverseAreClosed) {
  ASTROLITH_SKIP_WITHOUT(package_file("vesta.bmf"));
  int bodies = 0;
  for (const auto& item : std::filesystem::directory_iterator(package_file(""))) {
    if (item.path().extension() != ".bmf") continue;
    const TriangleMesh mesh = read_mesh(item.path());
    const MeshTopology topology = analyze_topology(mesh);
    EXPECT_TRUE(topology.closed && topology.manifold && topology.oriented) << item.path();
    EXPECT_EQ(topology.components, 1) << item.path();
    EXPECT_EQ(topology.genus, 0) << item.path();
    EXPECT_GT(volume(mesh), 0) << item.path();
    ++bodies;
  }
  EXPECT_EQ(bodies, 16);
  // The mean radius of Vesta is 262 km (Russell et al. 2012). The file is therefore in kilometres and of
  // about the right size.
  EXPECT_NEAR(std::cbrt(volume(read_mesh(package_file("vesta.bmf"))) * 3 / (4 * std::numbers::pi)), 262, 10);
}

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
  EXPECT_EQ(unit_in("# the subunit: km\n"), "");
  EXPECT_EQ(unit_in("# Density units: parsecs\n"), "");
  EXPECT_EQ(unit_in("# Units: unknown\n"), "");
  EXPECT_EQ(unit_in("# Units: degrees\n"), "");
  EXPECT_EQ(unit_in("# 642 vertices in mesh\n"), "");
  EXPECT_EQ(unit_in("# length unit: parsecmillionths\n"), "");
  EXPECT_EQ(unit_in("# length unit: m\xff\n"), "m");
  EXPECT_EQ(unit_in("# length unit: km"), "km");
  EXPECT_EQ(unit_in("v 0 0 0\r\n# length unit: m\r\n"), "m");
  EXPECT_EQ(unit_in(std::string(4096, '\n') + "# length unit: m\n"), "");
  EXPECT_EQ(unit_in(std::string("\x28\xb5\x2f\xfd", 4) + "# length unit: m\n"), "");
}

TEST(StatedUnit, InCommentsOfOtherPrograms) {
  const ScratchFolder folder;
  for (const auto& [text, unit] : {std::pair{"# Units: meters\nv 0 0 0\n", "m"},
                                   {"#units = km\n", "km"},
                                   {"# Asteroid X\r# UNIT: Kilometres\r", "km"},
                                   {"ply\ncomment units: (mm)\n", "mm"},
                                   {"// all lengths in cm\n", "cm"},
                                   {"# Vertices are in metres, body-fixed\n", "m"},
                                   {"# length unit: km, body-fixed\n", "km"},
                                   {"lat,lon,radius_km\n", "km"},
                                   {"# UNITS = feet\n", "ft"},
                                   {"# Units: millimetres\n", "mm"},
                                   {"# Units: centimetres\n", "cm"},
                                   {"# file units = inches\n", "in"},
                                   {"# Units: microns\n", "um"},
                                   {"# Units: parsecs\n", "parsecs"},
                                   {"# Units: SI\n", "m"},
                                   {"\xef\xbb\xbf# Units: meters\r", "m"},
                                   {"ply\ncomment unit m\n", "m"},
                                   {"ply\ncomment units metres\n", "m"},
                                   {"ply\ncomment length_unit m\n", "m"},
                                   {"# LENGTH UNIT KM\n", "km"},
                                   {"# coordinates, km units\n", "km"},
                                   {"# unit normals follow\n", ""},
                                   {"# units of force: m/s units\n", ""},
                                   {"# one unit mesh\n", ""},
                                   {"# coordinates in units of the mean radius\n", ""},
                                   {"# Unit M-type body\n", ""},
                                   {"# facet area unit m2\n", ""},
                                   {"# columns: x, y, z (m)\n", "m"},
                                   {"# x, y, z (m)\n", "m"}})
    EXPECT_EQ(stated_length_unit(folder.write("a.obj", text)), unit) << text;
}

TEST(StatedUnit, InHeadersOfStl) {
  const ScratchFolder folder;
  const std::string tail(100, '\1');
  EXPECT_EQ(stated_unit(folder.write("a.stl", "scanned part UNITS=mm" + tail)).unit, "mm");
  EXPECT_EQ(stated_unit(folder.write("b.stl", "solid part units: m\nfacet\n")).unit, "m");
  EXPECT_EQ(stated_unit(folder.write("c.stl", "scanned part" + tail + "UNITS=mm")).unit, "");
}

TEST(StatedUnit, InLabelsOfThePds) {
  const ScratchFolder folder;
  const std::string columns =
      "OBJECT = COLUMN\r\nNAME = LATITUDE\r\nUNIT = DEGREE\r\nEND_OBJECT\r\nOBJECT = COLUMN\r\nNAME = X\r\n"
      "UNIT  = \"METER\"\r\nEND_OBJECT\r\n";
  const std::filesystem::path table = folder.write("eros.tab", "1 2 3\n");
  EXPECT_EQ(
      stated_unit(folder.write("in.tab", "PDS_VERSION_ID = PDS3\r\n" + columns + "END\r\n1 2 3\n")).unit,
      "m");
  EXPECT_EQ(stated_unit(table).unit, "");
  folder.write("eros.lbl", "PDS_VERSION_ID = PDS3\r\n^TABLE = \"OTHER.TAB\"\r\n" + columns + "END\r\n");
  EXPECT_EQ(stated_unit(table).unit, "");
  folder.write("eros.lbl", "PDS_VERSION_ID = PDS3\r\n^TABLE = \"EROS.TAB\"\r\n" + columns + "END\r\n");
  EXPECT_EQ(stated_unit(table).unit, "m");
  EXPECT_EQ(stated_unit(table).label, folder / "eros.lbl");
  const std::filesystem::path new_table = folder.write("bennu.tab", "1 2 3\n");
  folder.write("bennu.xml",
               "<?xml version=\"1.0\"?><file_name>bennu.tab</file_name><unit>deg</unit>\n<unit>m</unit>");
  EXPECT_EQ(stated_unit(new_table).unit, "m");
}

}  // namespace
}  // namespace astrolith
