// Error messages about files that readers refuse: one line with the file, the place, what is wrong and what
// to do.

#include "geometry/io/mesh_io.h"
#include "numerics/errors.h"
#include "numerics/files/output_file.h"
#include "tests/support/meshes.h"
#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

namespace astrolith {
namespace {

using namespace testing;

class MeshErrors : public ::testing::Test {
 protected:
  // The message of the InputError that reading the file gives; empty when it gives none.
  std::string complaint(const std::filesystem::path& file) {
    return testing::refusal_text([&] { read_mesh(file); });
  }
  // Expects that a file of this content gives a message with the file's name and the fragment.
  void expect(const std::string& name, const std::string& content, const std::string& fragment) {
    const std::filesystem::path file = folder.write(name, content);
    const std::string message = complaint(file);
    EXPECT_TRUE(message.starts_with(file.string() + ": ")) << name << " " << message;
    EXPECT_NE(message.find(fragment), message.npos) << "'" << fragment << "' in: " << message;
    EXPECT_NE(message.find("; "), message.npos) << message;
    EXPECT_EQ(message.find('\n'), message.npos) << message;
    for (const char c : message) EXPECT_TRUE(c >= ' ' && c <= '~') << message;
  }
  ScratchFolder folder;
};

const std::string kBoxes = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

TEST_F(MeshErrors, NoFileNoMesh) {
  EXPECT_NE(complaint(folder / "none.obj").find("No such file"), std::string::npos);
  EXPECT_NE(complaint(folder.path()).find("folder"), std::string::npos);
  EXPECT_NE(complaint("/dev/zero").find("plain file"), std::string::npos);
  expect("a.obj", "", "empty");
  expect("a.stl", "\n", "does not begin with 'solid'");
  expect("a.xyz", "hello world\n", "neither name nor content");
}

TEST_F(MeshErrors, Obj) {
  expect("a.obj", kBoxes, "no faces");
  expect("a.obj", kBoxes + "f 1 2 4\n", "vertex 4 of 3");
  expect("a.obj", kBoxes + "f 1 2 0\n", "line 4: vertex number 0");
  expect("a.obj", kBoxes + "f 1 2 -4\n", "line 4: vertex number -4");
  expect("a.obj", kBoxes + "f 1 2 99999999999999999999\n", "line 4");
  expect("a.obj", kBoxes + "f 1 2\n", "line 4: the face has fewer than three");
  expect("a.obj", kBoxes + "f 1 2 x\n", "line 4: vertex number is 'x'");
  expect("a.obj", "v 0 0\nf 1 1 1\n", "line 1: z is missing");
  expect("a.obj", "v 0 nan 0\nf 1 1 1\n", "line 1: y is 'nan'");
  expect("a.obj", "v -inf 0 0\nf 1 1 1\n", "line 1: x is '-inf'");
  expect("a.obj", "v 1e999 0 0\nf 1 1 1\n", "line 1: x is '1e999'");
  expect("a.obj", "v 1e19 0 0\nf 1 1 1\n", "vertex 1: a coordinate");
  expect("a.obj", "v 0 0 1.2.3\nf 1 1 1\n", "line 1: z is '1.2.3'");
  expect("a.obj", "v \xff\xfe\x01 0 0\nf 1 1 1\n", "line 1: x is '?\?\?'");
  std::string long_word = "v x";
  long_word.resize(100000, '7');
  expect("a.obj", long_word + " 0 0\n", "line 1: x is 'x777");
}

TEST_F(MeshErrors, PlyHeader) {
  expect("a.ply", "ply\n", "'end_header'");
  expect("a.ply", "ply\nend_header\n", "'format'");
  expect("a.ply", "ply\nformat ascii 1.0\nend_header\n", "no faces");
  expect("a.ply", "ply\nformat morse 1.0\n", "line 2: the format is 'morse'");
  expect("a.ply", "ply\nformat ascii 1.0\nproperty float x\n", "line 3: a property before");
  expect("a.ply", "ply\nformat ascii 1.0\nelement vertex -3\n", "line 3: the element's count is negative");
  expect("a.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty half x\n",
         "line 4: 'half' is no PLY type");
  expect("a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n",
         "no x, y and z");
}

std::string ply(const std::string& format, const std::string& vertices, const std::string& faces,
                const std::string& body) {
  return "ply\nformat " + format + " 1.0\nelement vertex " + vertices +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " + faces +
         "\nproperty list uchar int vertex_indices\nend_header\n" + body;
}

TEST_F(MeshErrors, PlyBody) {
  const std::string three = "0 0 0\n1 0 0\n0 1 0\n";
  expect("a.ply", ply("ascii", "3", "1", three), "line 13: the file ends");
  expect("a.ply", ply("ascii", "3", "1", three + "3 0 1"), "the file ends");
  expect("a.ply", ply("ascii", "3", "1", three + "3 0 1 3\n"), "triangle 1: names vertex 4 of 3");
  expect("a.ply", ply("ascii", "3", "1", three + "3 0 1 -1\n"), "line 13: a vertex index");
  expect("a.ply", ply("ascii", "3", "1", three + "2 0 1\n"), "no faces");
  expect("a.ply", ply("ascii", "3", "1", three + "999999999 0 1\n"), "999999999 list entries");
  expect("a.ply", ply("ascii", "9000000000000000000", "1", three), "more than the file can hold");
  expect("a.ply", ply("binary_little_endian", "9000000000000000000", "1", three), "bytes follow");
  expect("a.ply", ply("binary_little_endian", "1", "1", std::string(11, '\0')), "bytes follow");
  const std::string vertex(12, '\0');
  expect("a.ply", ply("binary_little_endian", "1", "1", vertex + "\xff"), "255 list entries");
  expect("a.ply", ply("binary_big_endian", "1", "1", "\x7f\x80\x01\x01" + vertex.substr(4) + "\3"),
         "x is not a finite");
}

TEST_F(MeshErrors, EmptyRowsDeclaredByTheBillion) {
  expect("a.ply", "ply\nformat ascii 1.0\nelement face 9000000000000000000\nend_header\n1\n", "no faces");
}

TEST_F(MeshErrors, StlOffPlateIcqBmf) {
  expect("a.stl", "solid facet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\n",
         "line 5: the facet has 2");
  expect("a.stl", "solid facet\nouter loop\nvertex 0 0 0\n", "'endsolid'");
  expect("a.stl", std::string(100, '\1'), "declared, but only 16 bytes follow");
  expect("a.stl", "; made by hand\nsolid a\n" + std::string(100, 'x'), "does not begin with 'solid'");
  expect("a.off", "OFF\n3 1 0\n0 0 0\n", "more than the file can hold");
  expect("a.off", "OFF BINARY\n\1\2", "is a binary OFF; save it as text");
  expect("a.off", "OFF\n1 1 0\n0 0 0\n", "line 4: the file ends");
  expect("a.off", "OFF\n1 1 0\n0 0 0\n3 0 0 7\n", "names vertex 8 of 1");
  expect("a.off", "OFF\n1 1 0\n0 0 0\n3 0 0\n", "line 4: vertex index is missing");
  expect("a.tab", "3\n1 0 0 0\n2 1 0 0\n4 0 1 0\n1\n1 1 2 3\n", "line 4: vertex 4 stands where 3");
  expect("a.tab", "3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n1\n1 1 2 4\n", "line 6: vertex number 4 does not exist");
  expect("a.tab", "3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n", "line 5: the file ends");
  expect("a.tab", "99\n1 0 0 0\n2 1 0 0\n3 0 1 0\n", "99 vertices are declared");
  expect("a.icq", "16385\n0 0 0\n", "line 1: Q is 16385");
  expect("a.icq", "512\n0 0 0\n", "more than the file can hold");
  std::string apart = "1\n";
  for (int i = 0; i < 24; ++i) apart += std::to_string(i * i) + " 0 0\n";
  expect("a.icq", apart, "meets no other face");
  expect("a.bmf", std::string("\1\0", 2), "byte 2: the file ends");
  expect("a.bmf", std::string(2, '\0') + "more", "bytes follow after");
}

TEST_F(MeshErrors, NameAndContentDisagree) {
  expect("a.ply", kBoxes + "f 1 2 3\n", "looks like Wavefront OBJ");
  expect("a.obj", "OFF\n3 1 0\n", "looks like OFF");
  expect("a.obj", "\x89PNG\r\n", "a PNG picture");
  expect("a.obj", "<html>", "HTML");
  expect("a.tab", "PK\x03\x04", "a zip archive");
  expect("a.obj", "ply\nformat ascii 1.0\n", "rename it to .ply");
}

// The fuzzer found this: an element's name may hold any bytes, of any number.
TEST_F(MeshErrors, NamesOfPlyElementsAreQuoted) {
  const std::filesystem::path file =
      folder.write("a.ply", "ply\nformat binary_little_endian 1.0\nelement a\x07" + std::string(500, 'b') +
                                " 100\nproperty float x\nend_header\n");
  const std::string message = complaint(file);
  EXPECT_EQ(message.find('\x07'), std::string::npos);
  EXPECT_LT(message.size(), file.string().size() + 200);
}

TEST_F(MeshErrors, CompressedFilesOfAnotherKind) {
  expect("a.ply.zst", "\x28\xb5\x2f\xfd", "ends too early");
  expect("b.ply.zst", "\x28\xb5\x2f\xfdrubbish", "is damaged");
  OutputFile bomb(folder / "c.ply.zst");
  bomb.write(std::string(1000000, 'x').data(), 1000000);
  bomb.commit();
  EXPECT_NE(complaint(folder / "c.ply.zst").find("unpacks to more than"), std::string::npos);
  EXPECT_THROW(write_mesh(icosphere(1), folder / "d.obj.zst", {}), InputError);
}

}  // namespace
}  // namespace astrolith
