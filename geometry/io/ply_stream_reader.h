// Reads a PLY file as PlyStreamWriter writes it, in memory that holds a few layers of the mesh.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "geometry/mesh_sink.h"
#include "numerics/files/output_file.h"

namespace astrolith {

//   PlyStreamReader reader("tile_3.ply");
//   ManifoldCheck check;
//   reader.read(check);
class PlyStreamReader {
 public:
  // Reads the header. Throws InputError for a file that cannot be read, that is no binary little-endian PLY
  // with float32 x y z in front of each vertex and one uchar and three uint32 for each triangle, or whose
  // size does not agree with its counts.
  explicit PlyStreamReader(const std::filesystem::path& file);

  std::uint64_t num_vertices() const { return num_vertices_; }
  std::uint64_t num_triangles() const { return num_triangles_; }

  // Passes the mesh on in the order of the file, without normals. Triangles that follow a call of
  // add_vertices name vertices of that call and of the call before. The calls are as small as the order of
  // the triangles allows; a file in another order than a mesher's is passed on in few large calls. Throws
  // InputError for a face that is no triangle, for a vertex that does not exist and for a coordinate that is
  // not finite.
  void read(MeshSink& sink);

 private:
  // The lowest and the highest vertex that a block of triangles names.
  struct BlockRange {
    std::uint32_t lowest, highest;
  };

  [[noreturn]] void fail(const std::string& what) const;
  void read_header();
  void go_to(std::uint64_t offset);
  void fill(void* data, std::size_t bytes);
  const std::vector<Triangle>& read_triangles(std::uint64_t block);
  std::vector<BlockRange> block_ranges();
  void pass_vertices(std::uint64_t end, MeshSink& sink);

  std::filesystem::path path_;
  FileHandle file_;
  std::uint64_t num_vertices_ = 0, num_triangles_ = 0;
  std::uint64_t vertices_at_ = 0;   // offset of the first vertex, bytes
  std::uint64_t triangles_at_ = 0;  // offset of the first triangle, bytes
  std::size_t vertex_bytes_ = 0;
  std::uint64_t passed_ = 0;  // vertices that the sink has
  std::vector<char> bytes_;
  std::vector<Triangle> triangles_;
};

}  // namespace astrolith
