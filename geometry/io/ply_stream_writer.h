// Writes a binary PLY while a mesher makes the mesh, in memory that does not grow with the mesh.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>

#include "geometry/io/mesh_io.h"
#include "geometry/mesh_sink.h"
#include "numerics/files/output_file.h"
#include "numerics/unset_vector.h"

namespace astrolith {

// The origin of a vertex: the number of the layer that made the surface there, and its height above the bare
// body.
struct VertexLabel {
  std::int32_t label = 0;
  float elevation = 0.0f;  // length units
};

// Fills in the labels of as many vertices.
using VertexLabeller = std::function<void(std::span<const MeshVertex>, std::span<VertexLabel>)>;

// Fills in the colours of as many vertices.
using VertexPainter = std::function<void(std::span<const MeshVertex>, std::span<VertexColor>)>;

//   PlyStreamWriter writer("bennu.ply", {.length_unit = "km"});
//   mesh_field(field, bounds, 512, writer);
//   writer.finish();                    // without this call no file appears
//
// The file is binary little endian: float32 x y z nx ny nz for each vertex, one uchar and three uint32 for
// each triangle. Vertices go to the file at once. Triangles go to a nameless temporary file beside it, which
// is appended at the end. The bytes depend on the vertices and triangles alone, not on how calls group them.
class PlyStreamWriter : public MeshSink {
 public:
  // Throws InputError when the folder cannot be written. With a painter, each vertex has its colour as three
  // uchar behind its normal. With a labeller, an int32 label and a float32 elevation follow.
  PlyStreamWriter(const std::filesystem::path& file, const MeshFileInfo& info, VertexLabeller labeller = {},
                  VertexPainter painter = {});

  // Both throw WorkError when the disk is full. add_vertices also throws it for more than 2^32 - 1 vertices,
  // add_triangles for a triangle that names a vertex not yet given.
  void add_vertices(std::span<const MeshVertex> vertices) override;
  void add_triangles(std::span<const Triangle> triangles) override;

  // Appends the triangles, states the counts in the header and gives the file its name. Must be called once.
  void finish();

  std::uint64_t num_vertices() const { return num_vertices_; }
  std::uint64_t num_triangles() const { return num_triangles_; }

 private:
  [[noreturn]] void fail_spill() const;
  void append_spill();
  void require_known_vertices(std::span<const Triangle> triangles) const;
  std::string header() const;
  void write_with_extras(std::span<const MeshVertex> vertices);

  std::filesystem::path target_;
  MeshFileInfo info_;
  VertexLabeller labeller_;  // null where no labels are written
  VertexPainter painter_;    // null where no colours are written
  OutputFile out_;
  FileHandle spill_;
  UnsetVector<char> packed_;  // triangles on their way to the spill
  std::uint64_t num_vertices_ = 0;
  std::uint64_t num_triangles_ = 0;
};

}  // namespace astrolith
