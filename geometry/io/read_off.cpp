// OFF (Geomview): the numbers of vertices, faces and edges, then one line for each vertex and face. Normals,
// colours and texture coordinates behind these numbers are ignored.
#include "geometry/io/format_internal.h"
#include "geometry/io/text_scanner_internal.h"

namespace astrolith {
namespace {

// Returns the first count and leaves `scan` behind it. The counts stand on the line of the keyword, directly
// behind it ("OFF8 6 12" occurs), or on the next line.
std::string_view first_count(TextScanner& scan) {
  if (!scan.next_filled_line()) scan.fail_truncated("'OFF'");
  std::string_view word = scan.word();
  const std::size_t keyword = lower_case(word).find("off");
  if (keyword == word.npos) return word;  // the keyword is optional
  word.remove_prefix(keyword + 3);
  if (!word.empty()) return word;
  while (scan.line_done() || scan.at_comment()) {
    if (!scan.next_filled_line()) scan.fail_truncated("the counts");
  }
  word = scan.word();
  if (lower_case(word) == "binary") scan.fail("is a binary OFF", "save it as text, or as .ply");
  return word;
}

std::size_t checked_count(const TextScanner& scan, std::int64_t count, std::size_t line_bytes,
                          const char* what) {
  if (count < 0 || static_cast<std::uint64_t>(count) > (scan.bytes_left() + 1) / line_bytes) {
    scan.fail(std::to_string(count) + " " + what + " are declared, more than the file can hold",
              "it may be truncated: fetch it again");
  }
  return static_cast<std::size_t>(count);
}

std::uint32_t index(TextScanner& scan) {
  const std::int64_t value = scan.integer("vertex index");
  if (value < 0 || value >= kMaxVertices) scan.fail("the vertex index is out of range", "correct the line");
  return static_cast<std::uint32_t>(value);
}

}  // namespace

TriangleMesh read_off(const MeshFile& file) {
  TriangleMesh mesh;
  TextScanner scan(file);
  const std::string_view first = first_count(scan);
  const std::size_t num_vertices =
      checked_count(scan, scan.to_integer(first, "number of vertices"), 6, "vertices");
  const std::size_t num_faces = checked_count(scan, scan.integer("number of faces"), 2, "faces");
  mesh.vertices.reserve(num_vertices);
  for (std::size_t i = 0; i < num_vertices; ++i) {
    if (!scan.next_filled_line()) scan.fail_truncated("a vertex");
    mesh.vertices.push_back(scan.point());
  }
  std::vector<std::uint32_t> polygon;
  PolygonFans fans;
  for (std::size_t i = 0; i < num_faces; ++i) {
    if (!scan.next_filled_line()) scan.fail_truncated("a face");
    polygon.clear();
    for (std::int64_t corners = scan.integer("number of corners"); corners > 0; --corners) {
      polygon.push_back(index(scan));
    }
    fans.append(polygon, mesh.triangles);
  }
  fans.cut_concave(file, mesh);
  return mesh;
}

}  // namespace astrolith
