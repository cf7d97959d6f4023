// OpenMesh reads what Astrolith writes.
#define _USE_MATH_DEFINES
#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include "geometry/io/mesh_io.h"
#include "geometry/mesh_measure.h"
#include "tests/support/meshes.h"
#include "tests/support/scratch_folder.h"

namespace astrolith {
namespace {

using namespace testing;
using PeerMesh = OpenMesh::TriMesh_ArrayKernelT<>;

class MeshPeer : public ::testing::TestWithParam<const char*> {};

TEST_P(MeshPeer, OpenMeshReadsTheSameMesh) {
  const ScratchFolder folder;
  const std::filesystem::path file = folder / (std::string("torus.") + GetParam());
  TriangleMesh mesh = torus(2, 0.5, 24, 12);
  mesh.normals = vertex_normals(mesh);
  write_mesh(mesh, file, {"km", "body-fixed, +z spin pole", "for a peer"});
  PeerMesh peer;
  ASSERT_TRUE(OpenMesh::IO::read_mesh(peer, file.string()));
  ASSERT_EQ(peer.n_faces(), mesh.triangles.size());
  ASSERT_EQ(peer.n_vertices(), mesh.vertices.size());
  // The peer may renumber vertices (STL), so that faces are compared by the places of their corners.
  for (const auto face : peer.faces()) {
    const Triangle& t = mesh.triangles[static_cast<std::size_t>(face.idx())];
    Vec3d ours{}, theirs{};
    for (const std::uint32_t index : t) ours += mesh.vertices[index];
    for (const auto vertex : face.vertices()) {
      const auto& p = peer.point(vertex);
      theirs += Vec3d{p[0], p[1], p[2]};
    }
    ASSERT_NEAR(norm(ours - theirs), 0, 1e-6);
  }
}

INSTANTIATE_TEST_SUITE_P(EveryFormat, MeshPeer, ::testing::Values("ply", "obj", "stl"));

}  // namespace
}  // namespace astrolith
