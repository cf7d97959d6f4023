// Small files written by hand, and the meshes that the reader of each format makes of them.
#include <algorithm>
#include <bit>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <numbers>

#include "geometry/io/mesh_io.h"
#include "geometry/mesh_measure.h"
#include "geometry/mesh_topology.h"
#include "numerics/errors.h"
#include "tests/support/meshes.h"
#include "tests/support/scratch_folder.h"

namespace astrolith {
namespace {

using namespace testing;
using Triangles = std::vector<Triangle>;

class MeshFormats : public ::testing::Test {
 protected:
  TriangleMesh read(const std::string& name, const std::string& content) {
    return read_mesh(folder.write(name, content));
  }
  ScratchFolder folder;
};

std::string format_row(const char* format, double x, double y, double z) {
  char row[160];
  std::snprintf(row, sizeof row, format, x, y, z);
  return row;
}

TEST_F(MeshFormats, ObjCornersNegativeIndicesPolygonsAndCrlf) {
  const TriangleMesh mesh =
      read("a.obj",
           "# a comment\r\nmtllib none.mtl\r\no body\r\nv 0 0 0 1.0\r\nv 1 0 0\r\nv 1 1 0 # here\r\n"
           "v 0 +1e0 0\r\nvt 0 0\r\nvn 0 0 1\r\ng side\r\ns off\r\n\r\n"
           "f 1/1 2/1 3/1 4/1\r\nf -4//1 -3//1 -2//1 # last\r\nf 2/1/1 3/1/1 4/1/1");
  EXPECT_EQ(mesh.vertices.size(), 4u);
  EXPECT_TRUE((mesh.triangles == Triangles{{0, 1, 2}, {0, 2, 3}, {0, 1, 2}, {1, 2, 3}}));
  EXPECT_TRUE(mesh.vertices[3] == (Vec3d{0, 1, 0}));
}

// What Astrolith writes comes back in metres, without the seams of its texture.
TEST_F(MeshFormats, GlbComesBack) {
  TriangleMesh mesh = icosphere(3, 0.5, {0.25, 0, 1});
  for (const bool textured : {false, true}) {
    MeshFileInfo info{"km", "body-fixed", ""};
    info.texture_coordinates = textured;
    write_mesh(mesh, folder / "a.glb", info);
    const TriangleMesh back = read_mesh(folder / "a.glb");
    EXPECT_TRUE(analyze_topology(back).closed);
    EXPECT_NEAR(volume(back) / volume(mesh), 1e9, textured ? 1e4 : 1e3);
    EXPECT_NEAR(back.bounds().max.z, 1500.0, 1e-3);
    EXPECT_EQ(stated_length_unit(folder / "a.glb"), "m");
  }
  write_mesh(mesh, folder / "a.glb", {"px", "", ""});
  EXPECT_EQ(stated_length_unit(folder / "a.glb"), "px");
  write_mesh(mesh, folder / "a.glb", {"km", "", "", Vec3d{0, 0, 2}, true});  // a whole body about its origin
  EXPECT_NEAR(read_mesh(folder / "a.glb").bounds().max.z, 3500.0, 1e-3);
}

// gzip, as its program makes it, of one piece and of two; the beginning tells the unit.
TEST_F(MeshFormats, GzipIsUnpacked) {
  write_mesh(icosphere(2, 1.5), folder / "a.obj", {"m", "", ""});
  const std::string plain = (folder / "a.obj").string(), half = (folder / "half").string();
  const auto ran = [](const std::string& command) { return std::system(command.c_str()); };  // NOLINT
  ASSERT_EQ(ran("gzip -nk " + plain + " && (head -c 5000 " + plain + " | gzip -n; tail -c +5001 " + plain +
                " | gzip -n) > " + half + ".obj.gz"),
            0);
  for (const char* name : {"a.obj.gz", "half.obj.gz"}) {
    EXPECT_TRUE(read_mesh(folder / name).vertices == read_mesh(folder / "a.obj").vertices) << name;
    EXPECT_EQ(stated_length_unit(folder / name), "m") << name;
  }
  const std::string packed = read_text(folder / "a.obj.gz");
  EXPECT_THROW(read("cut.obj.gz", packed.substr(0, packed.size() / 2)), InputError);
  EXPECT_THROW(write_mesh(icosphere(1, 1), folder / "a.ply.gz", {}), InputError);
}

// An index may name a vertex that comes later.
TEST_F(MeshFormats, ObjForwardReference) {
  EXPECT_EQ(read("a.obj", "f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n").triangles.size(), 1u);
}

TEST_F(MeshFormats, ObjFaceGoesOnBehindABackslash) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  EXPECT_EQ(read("a.obj", vertices + "f 1 2 \\\r\n 3\n").triangles.size(), 1u);
  EXPECT_THROW(read("b.obj", vertices + "f 1 2 \\"), InputError);
}

// Some editors put a byte order mark before the first vertex. Losing that line would shift every index.
TEST_F(MeshFormats, ByteOrderMarkIsPassedOver) {
  const std::string obj = "v 5 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  EXPECT_TRUE(read("a.obj", "\xef\xbb\xbf" + obj).vertices == read("b.obj", obj).vertices);
}

TEST_F(MeshFormats, PlyAsciiWithUnknownPropertiesAndElements) {
  const TriangleMesh mesh =
      read("a.ply",
           "ply\nformat ascii 1.0\ncomment x\nobj_info y\nelement camera 1\nproperty list uchar float view\n"
           "element vertex 4\nproperty double z\nproperty float quality\nproperty int x\nproperty list uchar "
           "int ids\n"
           "property float y\nelement face 2\nproperty uchar red\nproperty list uchar int "
           "vertex_index\nend_header\n"
           "3 1 2 3\n0 nan 0 0 0\n0 nan 1 2 7 7 0\n0 0 1 0 1\n0.5 0 0 0\n1\n9 4 0 1 2 3\n9 3 2 1 0\n");
  EXPECT_TRUE((mesh.triangles == Triangles{{0, 1, 2}, {0, 2, 3}, {2, 1, 0}}));
  EXPECT_TRUE(mesh.vertices[1] == (Vec3d{1, 0, 0}));
  EXPECT_TRUE(mesh.vertices[3] == (Vec3d{0, 1, 0.5}));
  EXPECT_TRUE(mesh.normals.empty());
}

// Appends the bytes of `value` in the given byte order.
template <typename T>
void append(std::string& bytes, T value, std::endian order = std::endian::little) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  if (order != std::endian::native) std::reverse(raw, raw + sizeof(T));
  bytes.append(raw, sizeof(T));
}

TEST_F(MeshFormats, PlyBinaryInBothByteOrdersAndOddTypes) {
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    std::string file =
        std::string("ply\r\nformat binary_") + (order == std::endian::big ? "big" : "little") +
        "_endian 1.0\r\nelement face 1\r\nproperty list ushort short vertex_indices\r\nproperty "
        "double weight\r\nelement vertex 3\r\nproperty double x\r\nproperty int8 y\r\nproperty uint16 "
        "z\r\nend_header\r\n";
    append(file, std::uint16_t{3}, order);
    for (const std::int16_t i : {2, 1, 0}) append(file, i, order);
    append(file, 0.25, order);
    for (const double x : {0.1, 0.2, 0.3}) {
      append(file, x, order);
      append(file, std::int8_t{-5}, order);
      append(file, std::uint16_t{40000}, order);
    }
    const TriangleMesh mesh = read("a.ply", file);
    EXPECT_TRUE((mesh.triangles == Triangles{{2, 1, 0}}));
    EXPECT_TRUE(mesh.vertices[2] == (Vec3d{0.3, -5, 40000}));
  }
}

TEST_F(MeshFormats, PlyNormalsThatAreNoneAreDropped) {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float nx\nproperty float ny\nproperty float "
      "nz\nproperty float x\n"
      "property float y\nproperty float z\nelement face 1\nproperty list uchar int "
      "vertex_indices\nend_header\n";
  EXPECT_EQ(read("a.ply", header + "0 0 1 0 0 0\n0 0 1 1 0 0\n0 0 1 0 1 0\n3 0 1 2\n").normals.size(), 3u);
  EXPECT_TRUE(read("a.ply", header + "0 0 0 0 0 0\n0 0 0 1 0 0\n0 0 0 0 1 0\n3 0 1 2\n").normals.empty());
}

std::string ascii_stl(const TriangleMesh& mesh) {
  std::string text = "solid body\n";
  for (const Triangle& t : mesh.triangles) {
    text += "  facet normal 0 0 0\n    outer loop\n";
    for (const std::uint32_t i : t) {
      const Vec3d& p = mesh.vertices[i];
      text += format_row("      vertex %.9e %.9e %.9e\n", p.x, p.y, p.z);
    }
    text += "    endloop\n  endfacet\n";
  }
  return text + "endsolid body\n";
}

TEST_F(MeshFormats, StlAsciiIsWelded) {
  const TriangleMesh mesh = read("a.stl", ascii_stl(icosphere(2, 3)));
  EXPECT_EQ(mesh.vertices.size(), icosphere(2).vertices.size());
  EXPECT_TRUE(analyze_topology(mesh).closed);
}

// Some programs start the 80 bytes of the binary form with "solid", the first word of the ascii form.
TEST_F(MeshFormats, StlBinaryThatCallsItselfSolid) {
  write_mesh(icosphere(1), folder / "a.stl", {});
  std::string bytes = read_text(folder / "a.stl");
  bytes.replace(0, 11, "solid facet");
  EXPECT_EQ(read("b.stl", bytes).triangles.size(), 80u);
}

TEST_F(MeshFormats, OffInItsVariants) {
  const char* body = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3 255 0 0\n3 2 1 0\n";
  for (const std::string header :
       {"OFF\n4 2 0\n", "OFF 4 2 0\n", "OFF4 2 0\n", "OFF\n# comment\n\n4 2 0\n", "4 2 0\n"}) {
    const TriangleMesh mesh = read("a.off", header + body);
    EXPECT_TRUE((mesh.triangles == Triangles{{0, 1, 2}, {0, 2, 3}, {2, 1, 0}})) << header;
  }
  EXPECT_EQ(
      read("b.off", "COFF\n3 1 0\n0 0 0 1 0 0 1\n1 0 0 1 0 0 1\n0 1 0 1 0 0 1\n3 0 1 2\n").vertices.size(),
      3u);
}

struct PlateStyle {
  bool both_counts_first, fortran, comments;
};

std::string plate_model(const TriangleMesh& mesh, const PlateStyle& style) {
  const std::string nv = std::to_string(mesh.vertices.size()), nf = std::to_string(mesh.triangles.size());
  std::string text = style.comments ? "# body-fixed, km\n#\n" : "";
  text += style.both_counts_first ? "  " + nv + "  " + nf + "\n" : nv + "\n";
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Vec3d& p = mesh.vertices[i];
    std::string row = std::to_string(i + 1) + format_row(" %.9e  %.9e\t%.9e\r\n", p.x, p.y, p.z);
    if (style.fortran) std::replace(row.begin(), row.end(), 'e', 'D');
    text += row;
  }
  if (!style.both_counts_first) text += nf + "\n";
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& [a, b, c] = mesh.triangles[i];
    text += std::to_string(i + 1) + format_row(" %.0f %.0f %.0f\n", a + 1.0, b + 1.0, c + 1.0);
  }
  return text;
}

TEST_F(MeshFormats, PlateModelsInTheirVariants) {
  const TriangleMesh body = icosphere(2, 17, {1, 2, 3});
  for (const PlateStyle style :
       {PlateStyle{}, {true, false, false}, {false, true, false}, {true, true, true}}) {
    for (const char* name : {"eros.tab", "EROS.TAB", "eros.plt", "eros.shape"}) {
      const TriangleMesh mesh = read(name, plate_model(body, style));
      EXPECT_TRUE(mesh.triangles == body.triangles);
      EXPECT_NEAR(volume(mesh), volume(body), 1e-5);
    }
  }
}

TEST_F(MeshFormats, PlateModelWithoutRowNumbers) {
  const std::string rows = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
  for (const char* name : {"eros.tab", "eros.plt", "eros.shape"}) {
    const TriangleMesh mesh = read(name, " 4 2\n" + rows + "1 3 2\n1 2 4\n");
    EXPECT_EQ(mesh.vertices.size(), 4u);
    EXPECT_TRUE((mesh.triangles == Triangles{{0, 2, 1}, {0, 1, 3}}));
  }
  // One table may have numbers and the other none.
  EXPECT_TRUE((read("a.tab", "4 1\n" + rows + "1 1 3 2\n").triangles == Triangles{{0, 2, 1}}));
}

// Type 4 of NAIF's MKDSK, and the number of corners on the plate's own line.
TEST_F(MeshFormats, PlatesBehindTheNumberOfTheirCorners) {
  const std::string vertices = " 4 2\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
  for (const char* plates :
       {"3\n 1 3 2\n3\n 1 2 4\n", "3 1 3 2\n3 1 2 4\n", "3\n1\n3 2\n\n# next\n3\n1 2 4\n"}) {
    for (const char* name : {"phobos.ver", "phobos.tab"})
      EXPECT_TRUE((read(name, vertices + plates).triangles == Triangles{{0, 2, 1}, {0, 1, 3}})) << plates;
  }
  const std::string quads = "4 1\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
  EXPECT_EQ(read("a.ver", quads + "4\n1 2 3 4\n").triangles.size(), 2u);
  EXPECT_EQ(read("a.ver", quads + "4 1 2 3 4\n").triangles.size(), 2u);
  EXPECT_THROW(read("a.ver", quads + "4\n1 2 3\n"), InputError);
  EXPECT_THROW(read("a.ver", quads + "2\n1 2\n"), InputError);
}

TEST_F(MeshFormats, PlateModelWithLetters) {
  const TriangleMesh mesh = read("kw4a.tab", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_TRUE((mesh.triangles == Triangles{{0, 1, 2}}));
}

// A sphere on the six faces of a cube. Face number `flipped`, if any, is stored with rows and columns
// exchanged.
std::string icq_sphere(int q, double radius, int flipped = -1) {
  static constexpr double kU[6][3] = {{0, 1, 0}, {0, 1, 0}, {1, 0, 0}, {0, -1, 0}, {-1, 0, 0}, {0, 1, 0}};
  static constexpr double kV[6][3] = {{1, 0, 0}, {0, 0, -1}, {0, 0, -1}, {0, 0, -1}, {0, 0, -1}, {-1, 0, 0}};
  static constexpr double kW[6][3] = {{0, 0, 1}, {1, 0, 0}, {0, -1, 0}, {-1, 0, 0}, {0, 1, 0}, {0, 0, -1}};
  std::string text = "  " + std::to_string(q) + "\n";
  for (int f = 0; f < 6; ++f) {
    for (int j = 0; j <= q; ++j) {
      for (int i = 0; i <= q; ++i) {
        const double u = 2.0 * (f == flipped ? j : i) / q - 1, v = 2.0 * (f == flipped ? i : j) / q - 1;
        const auto along = [&](int k) { return kW[f][k] + u * kU[f][k] + v * kV[f][k]; };
        const Vec3d p = radius * normalized(Vec3d{along(0), along(1), along(2)});
        text += format_row("%12.5f%12.5f%12.5f\n", p.x, p.y, p.z);
      }
    }
  }
  return text;
}

TEST_F(MeshFormats, IcqMergesTheEdgesOfItsFaces) {
  for (const int q : {1, 2, 8, 33}) {
    const TriangleMesh mesh = read("sphere.icq", icq_sphere(q, 10));
    EXPECT_EQ(mesh.vertices.size(), static_cast<std::size_t>(6 * q * q + 2));
    EXPECT_EQ(mesh.triangles.size(), static_cast<std::size_t>(12 * q * q));
    const MeshTopology topology = analyze_topology(mesh);
    EXPECT_TRUE(topology.closed && topology.manifold && topology.oriented);
    EXPECT_EQ(topology.genus, 0);
    EXPECT_GT(volume(mesh), 0);
  }
  EXPECT_NEAR(volume(read("sphere.txt", icq_sphere(64, 10))) / (4 * std::numbers::pi / 3 * 1000), 1, 1e-3);
  EXPECT_TRUE(analyze_topology(read("flipped.icq", icq_sphere(8, 10, 3))).oriented);
}

// Neighbouring vertices that a coarse print has made equal stay two vertices.
TEST_F(MeshFormats, IcqKeepsVerticesThatFellTogether) {
  std::string text = icq_sphere(4, 10);
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    lines.push_back(text.substr(at, end + 1 - at));
    at = end + 1;
  }
  lines[1 + 6] = lines[1 + 7];  // two vertices inside face 1
  std::string squeezed;
  for (const std::string& line : lines) squeezed += line;
  EXPECT_EQ(read("a.icq", squeezed).vertices.size(), 98u);
}

}  // namespace
}  // namespace astrolith
