// BMF, the format of OpenUniverse for bodies. A file holds parts, and a part holds a flag, the name of a
// texture, a material, vertices and faces, all little endian. Vertices are repeated along texture seams, and
// every triangle stands twice, once in each winding.
#include <algorithm>

#include "geometry/io/byte_reader_internal.h"
#include "geometry/io/format_internal.h"
#include "geometry/wound_surface.h"

namespace astrolith {
namespace {

constexpr std::size_t kMaterialBytes = 48;
constexpr std::size_t kVertexBytes = 8 * sizeof(float);
constexpr std::size_t kFaceBytes = 3 * sizeof(std::uint16_t);

void read_vertices(ByteReader& bytes, TriangleMesh& mesh) {
  const auto count = bytes.read<std::uint16_t>("the number of vertices");
  bytes.need_rows(count, kVertexBytes, "vertices");
  for (std::uint32_t i = 0; i < count; ++i) {
    bytes.skip(5 * sizeof(float), "u v nx ny nz");
    mesh.vertices.push_back(bytes.read_floats_xyz());
  }
}

void read_part(ByteReader& bytes, TriangleMesh& mesh) {
  bytes.skip(sizeof(std::uint16_t), "a part's flag");
  bytes.skip(bytes.read<std::uint16_t>("a texture name's length"), "a texture's name");
  bytes.skip(kMaterialBytes, "a material");
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  read_vertices(bytes, mesh);
  const auto count = bytes.read<std::uint16_t>("the number of faces");
  bytes.need_rows(count, kFaceBytes, "faces");
  for (std::uint32_t i = 0; i < count; ++i) {
    Triangle& t = mesh.triangles.emplace_back();
    for (std::uint32_t& corner : t) corner = first + bytes.read<std::uint16_t>("a vertex index");
    if (std::max({t[0], t[1], t[2]}) >= mesh.vertices.size()) {
      bytes.fail("a face names a vertex that its part does not have", "fetch the file again");
    }
  }
}

}  // namespace

TriangleMesh read_bmf(const MeshFile& file) {
  TriangleMesh mesh;
  ByteReader bytes(file);
  for (int parts = bytes.read<std::uint16_t>("the number of parts"); parts > 0; --parts)
    read_part(bytes, mesh);
  if (bytes.bytes_left() != 0) bytes.fail("bytes follow after the last part", "give a BMF file");
  // Either winding of a triangle may come first in the file, hence orient_faces.
  return orient_faces(drop_degenerate_and_repeated_faces(weld_vertices(std::move(mesh), 0.0)));
}

}  // namespace astrolith
