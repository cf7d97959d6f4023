// A glTF library reads the GLB that Astrolith writes.
#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#include <tiny_gltf.h>
#pragma GCC diagnostic pop

#include <cmath>
#include <cstring>

#include "geometry/io/mesh_io.h"
#include "geometry/mesh_measure.h"
#include "geometry/mesh_topology.h"
#include "geometry/wound_surface.h"
#include "tests/support/meshes.h"
#include "tests/support/scratch_folder.h"

namespace astrolith {
namespace {

using namespace testing;

class WriteGlb : public ::testing::Test {
 protected:
  WriteGlb() {
    mesh = icosphere(2, 0.5, {0, 0, 1});
    mesh.normals = vertex_normals(mesh);
    write_and_load({"km", "body-fixed", "said \"so\"\n\xff"});
  }
  void write_and_load(const MeshFileInfo& info) {
    write_mesh(mesh, folder / "a.glb", info);
    model = {};
    tinygltf::TinyGLTF loader;
    std::string error, warning;
    EXPECT_TRUE(loader.LoadBinaryFromFile(&model, &error, &warning, (folder / "a.glb").string())) << error;
    EXPECT_EQ(error + warning, "");
  }

  template <typename T>
  std::vector<T> array(int accessor_number) const {
    const tinygltf::Accessor& accessor = model.accessors.at(static_cast<std::size_t>(accessor_number));
    const tinygltf::BufferView& view = model.bufferViews.at(static_cast<std::size_t>(accessor.bufferView));
    const auto& bytes = model.buffers.at(0).data;
    EXPECT_LE(view.byteOffset + accessor.count * sizeof(T), bytes.size());
    std::vector<T> values(accessor.count);
    std::memcpy(values.data(), bytes.data() + view.byteOffset, accessor.count * sizeof(T));
    return values;
  }

  ScratchFolder folder;
  TriangleMesh mesh;
  tinygltf::Model model;
};

TEST_F(WriteGlb, ArraysComeBack) {
  const tinygltf::Primitive& primitive = model.meshes.at(0).primitives.at(0);
  const auto positions = array<Vec3f>(primitive.attributes.at("POSITION"));
  const auto normals = array<Vec3f>(primitive.attributes.at("NORMAL"));
  const auto indices = array<std::uint32_t>(primitive.indices);
  ASSERT_EQ(positions.size(), mesh.vertices.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    ASSERT_EQ(positions[i].x, static_cast<float>(1000.0 * mesh.vertices[i].x));  // metres
    ASSERT_EQ(normals[i].z, static_cast<float>(mesh.normals[i].z));
  }
  const auto& accessor = model.accessors.at(static_cast<std::size_t>(primitive.indices));
  EXPECT_EQ(accessor.count, 3 * mesh.triangles.size());
  EXPECT_EQ(accessor.componentType, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT);
  for (std::size_t i = 0; i < indices.size(); ++i) ASSERT_EQ(indices[i], mesh.triangles[i / 3][i % 3]);
}

// Colours are sRGB in the mesh and linear light in the file, where the material must not darken them.
TEST_F(WriteGlb, ColoursAreLinearLight) {
  mesh.colors.assign(mesh.vertices.size(), {0, 188, 255});
  write_and_load({"km", "body-fixed", ""});
  const int number = model.meshes.at(0).primitives.at(0).attributes.at("COLOR_0");
  const auto& accessor = model.accessors.at(static_cast<std::size_t>(number));
  EXPECT_EQ(accessor.componentType, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT);
  EXPECT_EQ(accessor.type, TINYGLTF_TYPE_VEC4);
  EXPECT_TRUE(accessor.normalized);
  const auto colors = array<std::array<std::uint16_t, 4>>(number);
  ASSERT_EQ(colors.size(), mesh.vertices.size());
  for (const auto& color : colors) {
    ASSERT_EQ(color[0], 0);
    ASSERT_NEAR(color[1] / 65535.0, 0.5029, 1e-4);  // ((188 / 255 + 0.055) / 1.055)^2.4
    ASSERT_EQ(color[2], 65535);
    ASSERT_EQ(color[3], 65535);
  }
  EXPECT_EQ(model.materials.at(0).pbrMetallicRoughness.baseColorFactor, std::vector<double>(4, 1.0));
}

// Every vertex has the coordinates of its place, with u in [0, 1]. The 180th meridian cuts the triangles that
// cross it: none covers much of the map but at the poles, and the surface stays closed and where it was.
TEST_F(WriteGlb, TextureCoordinatesAreLongitudeAndLatitude) {
  mesh = icosphere(3, 0.5);  // about the origin of the frame, at (0, 0, -1) of the file's coordinates
  for (Vec3d& v : mesh.vertices) v.z -= 1;
  mesh.normals = vertex_normals(mesh);
  mesh.colors.assign(mesh.vertices.size(), {1, 2, 3});
  MeshFileInfo info{"m", "body-fixed", "", Vec3d{0, 0, 1}};
  info.texture_coordinates = true;
  write_and_load(info);
  const tinygltf::Primitive& primitive = model.meshes.at(0).primitives.at(0);
  const auto positions = array<Vec3f>(primitive.attributes.at("POSITION"));
  const auto normals = array<Vec3f>(primitive.attributes.at("NORMAL"));
  const auto colors = array<std::array<std::uint16_t, 4>>(primitive.attributes.at("COLOR_0"));
  const auto texcoords = array<std::array<float, 2>>(primitive.attributes.at("TEXCOORD_0"));
  const auto indices = array<std::uint32_t>(primitive.indices);
  ASSERT_GT(positions.size(), mesh.vertices.size());
  ASSERT_LT(positions.size(), mesh.vertices.size() + 100);
  ASSERT_EQ(texcoords.size(), positions.size());
  ASSERT_EQ(normals.size(), positions.size());
  ASSERT_EQ(colors.size(), positions.size());
  constexpr double kPi = 3.14159265358979323846;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Vec3d place = Vec3d{positions[i].x, positions[i].y, positions[i].z + 1.0};
    ASSERT_GE(texcoords[i][0], 0.0f);
    ASSERT_LE(texcoords[i][0], 1.0f);
    const double u = 0.5 + std::atan2(place.y, place.x) / (2 * kPi);
    if (place.y == 0.0 && place.x < 0.0) {
      ASSERT_TRUE(texcoords[i][0] == 0.0f || texcoords[i][0] == 1.0f);
    } else if (std::hypot(place.x, place.y) > 1e-9) {
      ASSERT_NEAR(texcoords[i][0], u, 1e-6);
    }
    ASSERT_NEAR(texcoords[i][1], 0.5 - std::asin(place.z / norm(place)) / kPi, 1e-6);
    ASSERT_NEAR(dot(place, {normals[i].x, normals[i].y, normals[i].z}), 0.5, 0.01);
  }
  TriangleMesh stored;  // with one vertex at each place
  for (const Vec3f& p : positions) stored.vertices.push_back({p.x, p.y, p.z});
  for (std::size_t t = 0; t < indices.size(); t += 3) {
    stored.triangles.push_back({indices[t], indices[t + 1], indices[t + 2]});
    const auto [west, east] =
        std::minmax({texcoords[indices[t]][0], texcoords[indices[t + 1]][0], texcoords[indices[t + 2]][0]});
    const Vec3d& corner = stored.vertices[indices[t]];
    const bool at_pole = std::hypot(corner.x, corner.y) < 0.2;
    ASSERT_LT(east - west, at_pole ? 0.5f : 0.2f) << t;
  }
  const TriangleMesh welded = weld_vertices(stored, 0.0);
  EXPECT_TRUE(analyze_topology(welded).closed);
  EXPECT_NEAR(volume(welded), volume(mesh), 1e-6);
}

TEST_F(WriteGlb, BoundsAreThoseOfThePositions) {
  const auto& accessor = model.accessors.at(0);
  const Box box = mesh.bounds();
  EXPECT_EQ(static_cast<float>(accessor.minValues.at(2)), static_cast<float>(1000.0 * box.min.z));
  EXPECT_EQ(static_cast<float>(accessor.maxValues.at(0)), static_cast<float>(1000.0 * box.max.x));
}

// The spin pole +z must point up, which is +y. Positions are metres without a scale.
TEST_F(WriteGlb, NodeTurnsPoleUpAndScalesNothing) {
  const tinygltf::Node& node = model.nodes.at(0);
  const Vec3d axis{node.rotation.at(0), node.rotation.at(1), node.rotation.at(2)};
  const double w = node.rotation.at(3);
  const auto rotate = [&](const Vec3d& v) { return v + 2.0 * cross(axis, cross(axis, v) + w * v); };
  EXPECT_NEAR(norm(rotate({0, 0, 1}) - Vec3d{0, 1, 0}), 0, 1e-12);
  EXPECT_NEAR(norm(rotate({1, 0, 0}) - Vec3d{1, 0, 0}), 0, 1e-12);
  EXPECT_TRUE(node.scale.empty() && node.matrix.empty());
}

TEST_F(WriteGlb, AssetStatesUnitAndFrame) {
  EXPECT_EQ(model.asset.version, "2.0");
  EXPECT_EQ(model.asset.extras.Get("length_unit").Get<std::string>(), "m");
  EXPECT_EQ(model.asset.extras.Get("frame").Get<std::string>(), "body-fixed");
}

}  // namespace
}  // namespace astrolith
