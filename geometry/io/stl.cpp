// STL, ascii and binary. The format has no shared vertices: corners at equal coordinates become one vertex,
// and facets that name a vertex twice afterwards are dropped.
#include <limits>

#include "geometry/io/byte_reader_internal.h"
#include "geometry/io/format_internal.h"
#include "geometry/io/text_scanner_internal.h"
#include "geometry/mesh_measure.h"
#include "geometry/wound_surface.h"

namespace astrolith {
namespace {

constexpr std::size_t kFacetBytes = 50;
constexpr std::uint32_t kMostFacets = 0xffffffffu / 3;

void add_corner_triangle(TriangleMesh& mesh) {
  const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.triangles.push_back({n - 3, n - 2, n - 1});
}

TriangleMesh share_vertices(TriangleMesh mesh) {
  mesh = weld_vertices(std::move(mesh), 0.0);
  std::erase_if(mesh.triangles,
                [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
  return mesh;
}

// The next keyword of the line in lower case, "end solid" as "endsolid"; empty at the line's end. Programs
// write keywords in either case.
std::string stl_keyword(TextScanner& scan) {
  std::string word = lower_case(scan.word());
  return word == "end" ? word + lower_case(scan.word()) : word;
}

// The number of triangles that a binary file declares. Programs that write while they compute leave 0 or the
// largest number: then it follows from the size. Bytes behind the triangles are passed over, but not
// triangles.
std::uint32_t read_triangle_count(ByteReader& bytes) {
  auto count = bytes.read<std::uint32_t>("the number of triangles");
  const std::size_t held = bytes.bytes_left() / kFacetBytes;
  const bool whole = bytes.bytes_left() % kFacetBytes == 0;
  if (whole && held <= kMostFacets && (count == 0 || count == 0xffffffffu))
    count = static_cast<std::uint32_t>(held);
  if (whole && held > count) {
    bytes.fail(std::to_string(count) + " triangles are declared, but " + std::to_string(held) + " follow",
               "correct the count in bytes 80 to 83");
  }
  bytes.need_rows(count, kFacetBytes, "triangles");
  if (count > kMostFacets) bytes.fail("more corners than 2^32", "write it as .ply");
  return count;
}

}  // namespace

TriangleMesh read_stl_ascii(const MeshFile& file) {
  TriangleMesh mesh;
  TextScanner scan(file);
  std::size_t corners = 0;
  bool complete = false;
  while (scan.next_filled_line()) {
    for (std::string keyword = stl_keyword(scan); !keyword.empty(); keyword = stl_keyword(scan)) {
      complete = keyword == "endsolid";
      if (complete || keyword == "solid") break;  // a name follows
      if (keyword == "vertex") {
        mesh.vertices.push_back(scan.point());
        ++corners;
      } else if (keyword == "endloop") {
        if (corners != 3)
          scan.fail("the facet has " + std::to_string(corners) + " vertices", "give it three");
        add_corner_triangle(mesh);
        corners = 0;
      }
    }
  }
  if (!complete) scan.fail_truncated("'endsolid'");
  return share_vertices(std::move(mesh));
}

TriangleMesh read_stl_binary(const MeshFile& file) {
  TriangleMesh mesh;
  ByteReader bytes(file);
  bytes.skip(80, "the header");
  const std::uint32_t count = read_triangle_count(bytes);
  mesh.vertices.reserve(std::size_t{3} * count);
  mesh.triangles.reserve(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    bytes.skip(12, "a normal");
    for (int corner = 0; corner < 3; ++corner) {
      mesh.vertices.push_back(bytes.read_floats_xyz());
    }
    bytes.skip(2, "an attribute");
    add_corner_triangle(mesh);
  }
  return share_vertices(std::move(mesh));
}

void write_stl(const TriangleMesh& mesh, const std::filesystem::path& file, const MeshFileInfo& info) {
  if (mesh.triangles.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw WorkError(file.string() + ": STL holds at most 2^32 - 1 triangles; write a .ply");
  }
  // The text must not start with "solid": readers would take the file for the ascii form.
  std::string header = "Binary STL";
  MeshFileInfo short_info = info;
  short_info.origin.reset();  // its numbers might be cut off
  for (const std::string& line : info_lines(short_info)) header += "; " + line;
  header.resize(80, ' ');
  OutputFile out(file);
  BufferedOutput buffer(out);
  buffer.append(header);
  buffer.append_value(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const Triangle& t : mesh.triangles) {
    buffer.append_value(to_float(triangle_normal(mesh, t)));
    for (const std::uint32_t index : t) buffer.append_value(to_float(mesh.vertices[index]));
    buffer.append_value(std::uint16_t{0});
  }
  buffer.flush();
  out.commit();
}

}  // namespace astrolith
