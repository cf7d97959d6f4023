#include "geometry/io/mesh_io.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <locale>
#include <memory>
#include <sstream>
#include <utility>

#include "geometry/atlas/texture_coordinates.h"
#include "geometry/io/format_internal.h"

namespace astrolith {
namespace {

// Squares of coordinates must stay finite in float32, which renderers and distance trees compute in.
constexpr double kLargestCoordinate = 1e18;

bool usable(const Vec3d& p) {
  const auto small = [](double c) { return std::fabs(c) <= kLargestCoordinate; };
  return small(p.x) && small(p.y) && small(p.z);  // false for NaN too
}

std::size_t find_bad_face(const TriangleMesh& mesh) {
  const auto in_range = [&](const Triangle& t) {
    return std::max({t[0], t[1], t[2]}) < mesh.vertices.size();
  };
  return static_cast<std::size_t>(std::find_if_not(mesh.triangles.begin(), mesh.triangles.end(), in_range) -
                                  mesh.triangles.begin());
}

std::size_t find_bad_vertex(const TriangleMesh& mesh) {
  return static_cast<std::size_t>(std::find_if_not(mesh.vertices.begin(), mesh.vertices.end(), usable) -
                                  mesh.vertices.begin());
}

std::string face_complaint(const TriangleMesh& mesh, std::size_t face) {
  const Triangle& t = mesh.triangles[face];
  return "names vertex " + std::to_string(std::uint64_t{std::max({t[0], t[1], t[2]})} + 1) + " of " +
         std::to_string(mesh.vertices.size());
}

void require_valid(const MeshFile& file, const TriangleMesh& mesh) {
  const std::size_t vertex = find_bad_vertex(mesh);
  if (vertex < mesh.vertices.size()) {
    file.fail("vertex " + std::to_string(vertex + 1), "a coordinate is not finite or beyond 1e18",
              "repair it, or state lengths in a larger unit");
  }
  const std::size_t face = find_bad_face(mesh);
  if (face < mesh.triangles.size()) {
    file.fail("triangle " + std::to_string(face + 1), face_complaint(mesh, face),
              "repair the index, or fetch the file again");
  }
}

void require_writable(const TriangleMesh& mesh, const std::filesystem::path& file) {
  const std::string name = file.string();
  if (mesh.triangles.empty()) throw WorkError(name + ": the mesh has no triangles, nothing is written");
  const std::size_t face = find_bad_face(mesh);
  if (face < mesh.triangles.size()) {
    throw WorkError(name + ": triangle " + std::to_string(face + 1) + " " + face_complaint(mesh, face));
  }
  const std::size_t vertex = find_bad_vertex(mesh);
  if (vertex < mesh.vertices.size()) {
    throw WorkError(name + ": vertex " + std::to_string(vertex + 1) + " is not finite or beyond 1e18");
  }
  if (!mesh.normals.empty() && mesh.normals.size() != mesh.vertices.size()) {
    throw WorkError(name + ": the mesh has another number of normals than of vertices");
  }
}

// A whole body whose coordinates are relative to an origin that a comment states gets those of its frame.
TriangleMesh in_frame(TriangleMesh mesh, const MeshFile& file) {
  constexpr std::size_t kMostHeader = 4096, kLongestPoint = 100;
  const std::string_view header = std::string_view(file.bytes).substr(0, kMostHeader);
  const std::size_t at = header.find(kBodyOriginWords);
  if (at == header.npos) return mesh;
  std::istringstream words{std::string(header.substr(at + kBodyOriginWords.size(), kLongestPoint))};
  words.imbue(std::locale::classic());
  Vec3d origin;
  if (!(words >> origin.x >> origin.y >> origin.z)) {
    file.fail("comment", "states an origin of the body that is no three numbers", "mend it or take it out");
  }
  for (Vec3d& p : mesh.vertices) p += origin;
  return mesh;
}

}  // namespace

TriangleMesh read_any(const MeshFile& file) {
  TriangleMesh mesh = in_frame(read_content(file), file);
  require_valid(file, mesh);
  return mesh;
}

TriangleMesh read_mesh(const std::filesystem::path& file) {
  const MeshFile content = load_mesh_file(file);
  TriangleMesh mesh = read_any(content);
  if (mesh.triangles.empty()) content.fail("", "holds no faces", "give a mesh of triangles or polygons");
  return mesh;
}

TriangleMesh read_mesh_or_points(const std::filesystem::path& file) {
  const MeshFile content = load_mesh_file(file);
  TriangleMesh mesh = read_any(content);
  if (mesh.triangles.empty() && mesh.normals.empty()) {
    content.fail("", "holds neither faces nor points with normals",
                 "give a mesh, or a .ply with x y z nx ny nz");
  }
  return mesh;
}

namespace {

// The mesh with coordinates by longitude.
struct LongitudeLevel {
  TriangleMesh mesh;
  std::shared_ptr<const MeshSkin> skin;
};
LongitudeLevel longitude_level(const TriangleMesh& mesh, const MeshFileInfo& info) {
  LongitudeMap map = longitude_map(mesh, info.whole_body ? Vec3d{} : info.origin.value_or(Vec3d{}));
  MeshSkin skin{std::move(map.coordinates)};
  skin.repeats = true;
  return {std::move(map.mesh), std::make_shared<const MeshSkin>(std::move(skin))};
}

}  // namespace

void write_mesh(const TriangleMesh& mesh, const std::filesystem::path& file, const MeshFileInfo& info) {
  const MeshFormat& format = written_mesh_format(file);
  require_writable(mesh, file);
  if (info.texture_coordinates && format.has_texture_coordinates) {
    const LongitudeLevel level = longitude_level(mesh, info);
    MeshFileInfo skinned = info;
    skinned.texture_coordinates = false;
    skinned.skin = level.skin;
    return write_mesh(level.mesh, file, skinned);
  }
  if (!info.origin || !info.whole_body || format.tells_origin) return format.writer(mesh, file, info);
  TriangleMesh moved = mesh;
  for (Vec3d& p : moved.vertices) p += *info.origin;
  require_writable(moved, file);
  format.writer(moved, file, info);
}

void write_mesh_levels(std::span<const MeshLevel> levels, std::span<const double> coverage,
                       const std::filesystem::path& file, const MeshFileInfo& info) {
  for (const MeshLevel& level : levels) require_writable(*level.mesh, file);
  if (!info.texture_coordinates) return write_glb_levels(levels, coverage, file, info);
  std::deque<LongitudeLevel> cut;
  std::vector<MeshLevel> skinned;
  for (const MeshLevel& level : levels) {
    const LongitudeLevel& made = cut.emplace_back(longitude_level(*level.mesh, info));
    skinned.push_back({&made.mesh, made.skin});
  }
  write_glb_levels(skinned, coverage, file, info);
}

std::vector<std::string> info_lines(const MeshFileInfo& info) {
  std::vector<std::string> lines;
  const auto add = [&](std::string_view label, std::string text) {
    if (text.empty()) return;
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    lines.push_back(std::string(label) + text);
  };
  add("length unit: ", info.length_unit);
  if (info.origin) add(info.whole_body ? kBodyOriginWords : kPartOriginWords, point_text(*info.origin));
  add("frame: ", info.frame);
  add("", info.comment);
  for (const std::string& note : info.notes) add("", note);
  lines.push_back("written by Astrolith");
  return lines;
}

}  // namespace astrolith
