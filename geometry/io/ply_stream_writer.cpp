#include "geometry/io/ply_stream_writer.h"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <vector>

#include "geometry/io/format_internal.h"
#include "geometry/io/ply_header_internal.h"
#include "geometry/io/ply_values.h"

namespace astrolith {

static_assert(std::endian::native == std::endian::little, "vertices are written as they lie in memory");
static_assert(sizeof(MeshVertex) == 6 * sizeof(float), "a vertex is six floats without gaps");

static_assert(sizeof(VertexLabel) == 8, "a label is an int32 and a float without gaps");
static_assert(sizeof(VertexColor) == 3, "a colour is three bytes without gaps");

std::string ply_header(const MeshFileInfo& info, std::uint64_t num_vertices, std::uint64_t num_triangles,
                       const PlyVertexParts& parts) {
  std::string header = "ply\nformat binary_little_endian 1.0\n";
  for (const std::string& line : info_lines(info)) header += "comment " + line + "\n";
  const std::string vertices = std::to_string(num_vertices);
  const std::string triangles = std::to_string(num_triangles);
  constexpr std::size_t kLongestCounts = 40;  // two 64-bit numbers
  // The comment stands among the other comments, because OpenMesh cannot read one behind the last property.
  header += "comment " + std::string(kLongestCounts - vertices.size() - triangles.size(), '.') + "\n";
  header += "element vertex " + vertices + "\n";
  for (const char* name : {"x", "y", "z"}) header += std::string("property float ") + name + "\n";
  if (parts.normals) {
    for (const char* name : {"nx", "ny", "nz"}) header += std::string("property float ") + name + "\n";
  }
  if (parts.colors) {
    for (const char* name : {"red", "green", "blue"}) header += std::string("property uchar ") + name + "\n";
  }
  if (parts.labels) header += "property int label\nproperty float elevation\n";
  header += "element face " + triangles + "\nproperty list uchar uint vertex_indices\n";
  return header + "end_header\n";
}

PlyStreamWriter::PlyStreamWriter(const std::filesystem::path& file, const MeshFileInfo& info,
                                 VertexLabeller labeller, VertexPainter painter)
    : target_(file), info_(info), labeller_(std::move(labeller)), painter_(std::move(painter)), out_(file) {
  spill_ = open_nameless_file(file);
  if (!spill_) fail_spill();
  const std::string text = header();
  out_.write(text.data(), text.size());
}

std::string PlyStreamWriter::header() const {
  return ply_header(info_, num_vertices_, num_triangles_, {true, painter_ != nullptr, labeller_ != nullptr});
}

void PlyStreamWriter::add_vertices(std::span<const MeshVertex> vertices) {
  num_vertices_ += vertices.size();
  if (num_vertices_ > static_cast<std::uint64_t>(kMaxVertices)) {
    throw WorkError(target_.string() + ": more than 2^32 - 1 vertices; choose a smaller resolution");
  }
  if (labeller_ || painter_) {
    write_with_extras(vertices);
  } else {
    out_.write(vertices.data(), vertices.size_bytes());
  }
}

void PlyStreamWriter::write_with_extras(std::span<const MeshVertex> vertices) {
  std::vector<VertexLabel> labels(labeller_ ? vertices.size() : 0);
  std::vector<VertexColor> colors(painter_ ? vertices.size() : 0);
  if (labeller_) labeller_(vertices, labels);
  if (painter_) painter_(vertices, colors);
  BufferedOutput buffer(out_);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    buffer.append_value(vertices[i]);
    if (painter_) buffer.append_value(colors[i]);
    if (labeller_) buffer.append_value(labels[i]);
  }
  buffer.flush();
}

void PlyStreamWriter::require_known_vertices(std::span<const Triangle> triangles) const {
  std::uint32_t most = 0;
  for (const auto& [i, j, k] : triangles) most = std::max({most, i, j, k});
  if (triangles.empty() || most < num_vertices_) return;
  const auto wrong = std::find_if(triangles.begin(), triangles.end(), [&](const Triangle& t) {
    return *std::max_element(t.begin(), t.end()) >= num_vertices_;
  });
  throw WorkError(target_.string() + ": triangle " +
                  std::to_string(num_triangles_ + static_cast<std::uint64_t>(wrong - triangles.begin())) +
                  " names vertex " + std::to_string(*std::max_element(wrong->begin(), wrong->end())) +
                  " of " + std::to_string(num_vertices_));
}

void PlyStreamWriter::add_triangles(std::span<const Triangle> triangles) {
  require_known_vertices(triangles);
  constexpr std::size_t kAtOnce = 65536;
  for (std::size_t first = 0; first < triangles.size(); first += kAtOnce) {
    const auto piece = triangles.subspan(first, std::min(kAtOnce, triangles.size() - first));
    packed_.resize(piece.size() * kPlyTriangleBytes);
    char* out = packed_.data();
    for (const Triangle& triangle : piece) out = put_ply_triangle(triangle, out);
    if (std::fwrite(packed_.data(), 1, packed_.size(), spill_.get()) != packed_.size()) fail_spill();
  }
  num_triangles_ += triangles.size();
}

void PlyStreamWriter::finish() {
  append_spill();
  const std::string text = header();
  out_.seek(0);
  out_.write(text.data(), text.size());
  out_.commit();
}

void PlyStreamWriter::append_spill() {
  if (std::fflush(spill_.get()) != 0) fail_spill();
  out_.append_file(::fileno(spill_.get()), num_triangles_ * kPlyTriangleBytes);
  spill_.reset();
}

void PlyStreamWriter::fail_spill() const {
  throw WorkError(target_.string() + ": the temporary file of triangles beside it failed (" +
                  std::strerror(errno) + "); is the disk full?");
}

void write_ply(const TriangleMesh& mesh, const std::filesystem::path& file, const MeshFileInfo& info) {
  write_ply_values(mesh, {}, file, info);
}

}  // namespace astrolith
