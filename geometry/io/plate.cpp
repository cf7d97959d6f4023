// Plate models of the Planetary Data System: a count, rows "i x y z", a count, rows "i a b c", numbered from
// 1. The first line may state both counts, and rows may lack their numbers. The number of corners may stand
// before each plate, on the line above or the same: type 4 of NAIF's MKDSK, .ver. (Models with rows "v x y z"
// and "f a b c" are read as OBJ.)
#include "geometry/io/format_internal.h"
#include "geometry/io/text_scanner_internal.h"

namespace astrolith {
namespace {

constexpr std::size_t kLeastRowBytes = 6;  // "0 0 0\n"

std::size_t checked_count(const TextScanner& scan, std::int64_t count, const char* what) {
  if (count < 1 || static_cast<std::uint64_t>(count) > (scan.bytes_left() + 1) / kLeastRowBytes) {
    scan.fail(std::to_string(count) + " " + what + " are declared, which the file does not hold",
              "it may be truncated, or not a plate model");
  }
  return static_cast<std::size_t>(count);
}

// Reads the number at the start of row i (counted from 1) of a table where rows are numbered. The first row
// tells: one of three words has no number.
void start_row(TextScanner& scan, std::size_t i, const char* what, bool& numbered) {
  if (i == 1) numbered = scan.words_left() != 3;
  if (!numbered) return;
  const std::int64_t stated = scan.integer("row number");
  if (stated != static_cast<std::int64_t>(i)) {
    scan.fail(
        std::string(what) + " " + std::to_string(stated) + " stands where " + std::to_string(i) + " is due",
        "rows are numbered from 1 without gaps");
  }
}

std::uint32_t vertex_index(TextScanner& scan, std::size_t num_vertices) {
  const std::int64_t number = scan.integer("vertex number");
  if (number < 1 || static_cast<std::uint64_t>(number) > num_vertices) {
    scan.fail("vertex number " + std::to_string(number) + " does not exist (there are " +
                  std::to_string(num_vertices) + ")",
              "vertices are numbered from 1");
  }
  return static_cast<std::uint32_t>(number - 1);
}

// Whether plates have the number of their corners before them. The scanner stands on the line of the first.
bool counts_corners(TextScanner scan) {
  const std::size_t words = scan.words_left();
  const std::int64_t first = scan.integer("plate");
  return words == 1 || (first > 2 && words == static_cast<std::size_t>(first) + 1);
}

// A plate on the lines from the scanner's on.
void read_counted_plate(TextScanner& scan, std::size_t num_vertices, std::vector<std::uint32_t>& corners) {
  const std::int64_t count = scan.integer("number of corners");
  if (count < 3) scan.fail("a plate has " + std::to_string(count) + " corners", "give it three or more");
  corners.clear();
  for (std::int64_t k = 0; k < count; ++k) {
    if (scan.line_done() && !scan.next_filled_line()) scan.fail_truncated("a plate's corner");
    corners.push_back(vertex_index(scan, num_vertices));
  }
}

// Reads the plates from the line behind the scanner's on.
void read_plates(TextScanner& scan, std::size_t count, const MeshFile& file, TriangleMesh& mesh) {
  bool numbered = true, counted = false;
  std::vector<std::uint32_t> corners;
  PolygonFans fans;
  for (std::size_t i = 1; i <= count; ++i) {
    if (!scan.next_filled_line()) scan.fail_truncated("plate " + std::to_string(i));
    if (i == 1) counted = counts_corners(scan);
    if (counted) {
      read_counted_plate(scan, mesh.vertices.size(), corners);
      fans.append(corners, mesh.triangles);
      continue;
    }
    start_row(scan, i, "plate", numbered);
    Triangle& t = mesh.triangles.emplace_back();
    for (std::uint32_t& corner : t) corner = vertex_index(scan, mesh.vertices.size());
  }
  fans.cut_concave(file, mesh);
}

}  // namespace

TriangleMesh read_plate(const MeshFile& file) {
  TriangleMesh mesh;
  TextScanner scan(file);
  if (!scan.next_filled_line()) scan.fail_truncated("the number of vertices");
  const std::string_view first = scan.word();
  if (first.find_first_not_of("+0123456789") != first.npos || first == "0") {
    // Tables of other kinds come here by their names alone.
    scan.fail("begins with " + astrolith::quoted(first) +
                  ", and is neither a plate model, which begins with a count of vertices, nor a regular grid "
                  "of latitude, longitude and radius from pole to pole",
              "name its columns, such as lat,lon,radius_km, fill its gaps, or give a mesh");
  }
  const std::size_t num_vertices =
      checked_count(scan, scan.to_integer(first, "number of vertices"), "vertices");
  std::int64_t num_plates = scan.line_done() ? 0 : scan.integer("number of plates");
  mesh.vertices.reserve(num_vertices);
  bool numbered = true;
  for (std::size_t i = 1; i <= num_vertices; ++i) {
    if (!scan.next_filled_line()) scan.fail_truncated("vertex " + std::to_string(i));
    start_row(scan, i, "vertex", numbered);
    mesh.vertices.push_back(scan.point());
  }
  if (num_plates == 0) {
    if (!scan.next_filled_line()) scan.fail_truncated("the number of plates");
    num_plates = scan.integer("number of plates");
  }
  const std::size_t plates = checked_count(scan, num_plates, "plates");
  mesh.triangles.reserve(plates);
  read_plates(scan, plates, file, mesh);
  return mesh;
}

void write_plate(const TriangleMesh& mesh, const std::filesystem::path& file, const MeshFileInfo&) {
  OutputFile out(file);
  BufferedOutput buffer(out);
  const auto row = [&](const auto&... values) {
    std::string line;
    append_words(line, values...);
    buffer.append(line + "\n");
  };
  buffer.append(std::to_string(mesh.vertices.size()) + "\n");
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Vec3d& p = mesh.vertices[i];
    row(i + 1, p.x, p.y, p.z);
  }
  buffer.append(std::to_string(mesh.triangles.size()) + "\n");
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& [a, b, c] = mesh.triangles[i];
    row(i + 1, std::uint64_t{a} + 1, std::uint64_t{b} + 1, std::uint64_t{c} + 1);
  }
  buffer.flush();
  out.commit();
}

}  // namespace astrolith
