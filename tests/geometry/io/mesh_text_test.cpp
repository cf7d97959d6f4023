// Text formats as people's programs write them: letters of either case, marks and blanks in front, other ends
// of lines, decimal commas, another encoding; and files of other kinds, which are named.
#include <gtest/gtest.h>

#include <cstring>
#include <string>

#include "geometry/io/mesh_io.h"
#include "geometry/mesh_topology.h"
#include "tests/support/meshes.h"
#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

namespace astrolith {
namespace {

using namespace testing;

const std::string kObj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
const std::string kMark = "\xef\xbb\xbf";

std::string with(std::string text, const std::string& piece, const std::string& other) {
  for (std::size_t at = 0; (at = text.find(piece, at)) != text.npos; at += other.size())
    text.replace(at, piece.size(), other);
  return text;
}

std::string utf16(const std::string& text, bool big_endian) {
  std::string wide;
  for (const char c : text) wide += big_endian ? std::string{'\0', c} : std::string{c, '\0'};
  return wide;
}

std::string stl() {
  std::string text = "solid forged part\n";
  for (const char* facet :
       {"0 0 0|0 1 0|1 0 0|", "0 0 0|1 0 0|0 0 1|", "0 0 0|0 0 1|0 1 0|", "1 0 0|0 1 0|0 0 1|"})
    text += "facet normal 0 0 0\nouter loop\n" +
            with("vertex " + with(facet, "|", "\nvertex ") + "#", "vertex #", "") + "endloop\nendfacet\n";
  return text + "endsolid forged part\n";
}

class MeshText : public ::testing::Test {
 protected:
  void expect_tetrahedron(const std::string& name, const std::string& content) {
    const TriangleMesh mesh = read_mesh(folder_.write(name, content));
    EXPECT_EQ(mesh.vertices.size(), 4u) << content;
    EXPECT_TRUE(mesh.triangles.size() == 4 && analyze_topology(mesh).closed) << content;
  }
  void expect_refused(const std::string& name, const std::string& content, const std::string& words) {
    const std::string message = refusal_text([&] { read_mesh(folder_.write(name, content)); });
    EXPECT_NE(message.find(words), message.npos) << message;
  }
  ScratchFolder folder_;
};

TEST_F(MeshText, StlKeywordsInAnyCaseAndPlace) {
  const std::string text = stl();
  std::string capitals = text;
  for (char& c : capitals) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  for (const std::string& one :
       {text, capitals, kMark + text, "\n \t" + text, kMark + "  " + capitals,
        with(text, "endsolid", "end solid"), with(text, "\n", "\r"), with(text, "\n", "\r\n"),
        with(text, "endloop\nendfacet", "end loop end facet"), with(text, "\nvertex", " vertex"),
        with(text, "forged", "vertex endsolid")})
    expect_tetrahedron("a.stl", one);
  expect_refused("a.stl", text.substr(0, text.size() / 2), "'endsolid'");
}

std::string binary_stl(const std::string& header, std::uint32_t count) {
  std::string bytes = header;
  bytes.resize(80, ' ');
  bytes.append(reinterpret_cast<const char*>(&count), sizeof count);
  static constexpr float kCorners[4][9] = {{0, 0, 0, 0, 1, 0, 1, 0, 0},
                                           {0, 0, 0, 1, 0, 0, 0, 0, 1},
                                           {0, 0, 0, 0, 0, 1, 0, 1, 0},
                                           {1, 0, 0, 0, 1, 0, 0, 0, 1}};
  for (const auto& facet : kCorners) {
    bytes.append(12, '\0');
    bytes.append(reinterpret_cast<const char*>(facet), sizeof facet);
    bytes.append(2, '\0');
  }
  return bytes;
}

TEST_F(MeshText, BinaryStlThatSaysSolid) {
  for (const char* header : {"solid", "solid facet normal", "SOLID of a scanner", "exported"}) {
    expect_tetrahedron("a.stl", binary_stl(header, 4));
    expect_tetrahedron("a.stl", binary_stl(header, 4) + "bytes behind");
    expect_tetrahedron("a.stl", binary_stl(header, 0));
    expect_tetrahedron("a.stl", binary_stl(header, 0xffffffff));
    expect_refused("a.stl", binary_stl(header, 3),
                   "3 triangles are declared, but 4 follow; correct the count");
    expect_refused("a.stl", binary_stl(header, 5), "5 triangles are declared, but only 200 bytes follow");
  }
}

TEST_F(MeshText, EndsOfLinesMarksAndBlanks) {
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 4\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
      "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
  const std::string off = "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
  const std::string tab = "4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n4\n1 1 3 2\n2 1 2 4\n3 1 4 3\n4 2 3 4\n";
  for (const auto& [name, text] : {std::pair{"a.obj", kObj}, std::pair{"a.ply", ply}, std::pair{"a.off", off},
                                   std::pair{"a.tab", tab}}) {
    for (const char* end : {"\n", "\r\n", "\r", "\r\r\n"}) {
      expect_tetrahedron(name, with(text, "\n", end));
      expect_tetrahedron(name, kMark + with(text, "\n", end));
    }
    expect_refused(name, "\xff\xfe" + utf16(text, false), "its text is UTF-16; save it as UTF-8");
    expect_refused(name, "\xfe\xff" + utf16(text, true), "UTF-16");
    expect_refused(name, utf16(text, false), "UTF-16");
  }
}

// Headers of binary files that end in carriage returns alone: the first byte behind may be a line feed.
TEST_F(MeshText, BinaryPlyBehindCarriageReturns) {
  std::string bytes =
      "ply\rformat binary_little_endian 1.0\relement vertex 3\rproperty uchar x\rproperty uchar y\r"
      "property uchar z\relement face 1\rproperty list uchar uchar vertex_indices\rend_header\r";
  bytes += std::string("\x0a\0\0\x0b\0\0\0\x0d\0\x03\0\1\2", 13);
  const TriangleMesh mesh = read_mesh(folder_.write("a.ply", bytes));
  EXPECT_TRUE(mesh.vertices[0] == (Vec3d{10, 0, 0}));
}

TEST_F(MeshText, BackslashAtTheEndOfAnyObjLine) {
  expect_tetrahedron("a.obj", with(with(kObj, "v 1 ", "v 1 \\\n"), "f 2", "f \\\r\n 2"));
  expect_tetrahedron("a.obj", with(kObj, "f 1 3 2\n", "f 1 3\\\n2\n"));
  expect_tetrahedron("a.obj", "g one two \\\nv 7 7 7\nvn 0 0 \\\n1\n" + kObj);
  // No line goes on behind the name of a folder.
  expect_tetrahedron("a.obj", "# C:\\bodies\\\n" + with(kObj, "f 1 3", "usemtl C:\\rock\\\nf 1 3"));
}

TEST_F(MeshText, DecimalCommasAreNamed) {
  const std::string commas = with(with(kObj, "1 0 0", "1,5 0,0 0,0"), "0 1 0", "0,0 1,5 0,0");
  expect_refused("a.obj", commas, "line 2: the number '1,5' has a decimal comma; write decimal points");
  expect_refused("a.obj", with(kObj, "1 0 0", "-1,5e3 0 0"), "'-1,5e3' has a decimal comma");
  expect_refused("a.stl", with(stl(), "vertex 1 0 0", "vertex 1,25 0,5 0"), "'1,25' has a decimal comma");
  expect_refused("a.off", "OFF\n3 1 0\n0,5;0,5;0,5\n1 0 0\n0 1 0\n3 0 1 2\n", "'0,5' has a decimal comma");
  for (const char* separated : {"1,0,0", "1, 0, 0", "1, 0,0", "1 , 0 ,0", "1;0;0", "1.0,0.0,0.0 # 1,5 2,5"})
    expect_tetrahedron("a.obj", with(kObj, "v 1 0 0", std::string("v ") + separated));
}

TEST_F(MeshText, OtherFilesAreNamedWithARemedy) {
  expect_refused("a.obj", "PK\x03\x04.......3D/3dmodel.model",
                 "is a 3MF scene; open it in its program, and export");
  expect_refused("a.obj", "PK\x03\x04...............",
                 "a zip archive or a document of an office; unpack it, or save its table as .csv");
  expect_refused("a.step", "ISO-10303-21;\nHEADER;\n", "a STEP file; export it as triangles");
  expect_refused("a.fbx", "Kaydara FBX Binary  ", "an FBX scene; open it in its program");
  expect_refused("a.blend", "BLENDER-v300", "a scene of Blender");
  expect_refused("a.bds", "DAF/DSK ", "a SPICE DSK; export its plates: dskexp");
  expect_refused("a.bds", "DAS/DSK ", "ends within its first record");
  expect_refused("a.glb", "glTF", "is no glTF of version 2");
  expect_refused("a.cub", "Object = IsisCube\n", "an ISIS cube");
  expect_refused("a.tab", "<?xml version=\"1.0\"?>", "give the file that a label names");
}

}  // namespace
}  // namespace astrolith
