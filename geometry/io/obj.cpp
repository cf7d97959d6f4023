// Wavefront OBJ. The shape of a body needs the lines "v" and "f" only; all others are ignored. PDS plate
// models in the style "v x y z", "f a b c" can be read as OBJ too.
#include <algorithm>

#include "geometry/io/format_internal.h"
#include "geometry/io/text_scanner_internal.h"

namespace astrolith {
namespace {

// The index of the vertex that a corner names: "7", "7/1", "7//3" or "7/1/3". Numbers count from 1, or are
// negative and count back from the last vertex so far.
std::uint32_t corner_index(const TextScanner& scan, std::string_view corner, std::size_t vertices_so_far) {
  const std::int64_t index = scan.to_integer(corner.substr(0, corner.find('/')), "vertex number");
  const std::int64_t count = static_cast<std::int64_t>(vertices_so_far);
  const std::int64_t zero_based = index < 0 ? count + index : index - 1;
  if (index == 0 || zero_based < 0 || zero_based >= kMaxVertices) {
    scan.fail("vertex number " + std::to_string(index) + " does not exist (" + std::to_string(count) +
                  " vertices so far)",
              "vertices are numbered from 1, or from -1 backwards");
  }
  return static_cast<std::uint32_t>(zero_based);
}

std::string to_line(std::string keyword, const Vec3d& v) {
  append_words(keyword, v.x, v.y, v.z);
  return keyword + "\n";
}

// The line of a face. `textured` has its corners in the texture, or is null.
std::string to_line(const Triangle& triangle, const Triangle* textured, bool with_normals) {
  const auto number = [](std::uint32_t index) { return std::to_string(std::uint64_t{index} + 1); };
  std::string line = "f";
  for (std::size_t k = 0; k < 3; ++k) {
    line += ' ';
    line += number(triangle[k]);
    if (textured != nullptr || with_normals) line += '/';
    if (textured != nullptr) line += number((*textured)[k]);
    if (with_normals) line += '/' + number(triangle[k]);
  }
  return line + "\n";
}

// Wavefront counts v from the bottom of the image up.
std::string to_line(const TexturePoint& uv) {
  std::string line = "vt";
  append_words(line, double{uv[0]}, 1.0 - double{uv[1]});
  return line + "\n";
}

// The material of a mesh with maps, for programs that know the classic words (Wavefront, Alias) and those
// that know "norm". "map_Bump" is a map of normals in Blender, Godot and Unity; three.js prefers "norm".
std::string material_text(const std::vector<SkinMap>& maps) {
  const auto is_color = [](const SkinMap& map) { return map.use == SkinMap::Use::kBaseColor; };
  const std::string grey = std::any_of(maps.begin(), maps.end(), is_color) ? "1 1 1" : "0.5 0.5 0.5";
  std::string text = "newmtl regolith\nKa 1 1 1\nKd " + grey + "\nKs 0 0 0\nd 1\nillum 1\nPr 1\n";
  for (const SkinMap& map : maps) {
    const std::string image = " " + map.name + ".png\n";
    if (map.use == SkinMap::Use::kBaseColor) text += "map_Kd" + image;
    if (map.use == SkinMap::Use::kOcclusion) text += "map_Ka" + image;
    if (map.use == SkinMap::Use::kNormal) text += "map_Bump" + image + "norm" + image;
  }
  return text;
}

}  // namespace

std::filesystem::path material_file(std::filesystem::path obj) { return obj.replace_extension(".mtl"); }

TriangleMesh read_obj(const MeshFile& file) {
  TriangleMesh mesh;
  TextScanner scan(file, true);
  std::vector<std::uint32_t> polygon;
  PolygonFans fans;
  while (scan.next_filled_line()) {
    const std::string_view keyword = scan.word();
    if (keyword == "v") {
      mesh.vertices.push_back(scan.point());
    } else if (keyword == "f") {
      polygon.clear();
      while (!scan.line_done()) {
        const std::string_view corner = scan.word();
        if (corner.front() == '#') break;
        polygon.push_back(corner_index(scan, corner, mesh.vertices.size()));
      }
      if (polygon.size() < 3) scan.fail("the face has fewer than three vertices", "remove or complete it");
      fans.append(polygon, mesh.triangles);
    }
  }
  fans.cut_concave(file, mesh);
  return mesh;
}

void write_obj(const TriangleMesh& mesh, const std::filesystem::path& file, const MeshFileInfo& info) {
  OutputFile out(file);
  BufferedOutput buffer(out);
  for (const std::string& text : info_lines(info)) buffer.append("# " + text + "\n");
  buffer.append("# axes: z up; import into Blender with forward axis Y, up axis Z\n");
  for (const Vec3d& v : mesh.vertices) buffer.append(to_line("v", v));
  for (const Vec3d& n : mesh.normals) buffer.append(to_line("vn", n));
  const TextureCoordinates* const texture = info.skin ? &info.skin->coordinates : nullptr;
  if (texture != nullptr) {
    for (const TexturePoint& uv : texture->uv) buffer.append(to_line(uv));
  }
  if (info.skin && !info.skin->maps.empty()) {
    write_file(material_file(file), material_text(info.skin->maps));
    buffer.append("mtllib " + material_file(file).filename().string() + "\nusemtl regolith\n");
  }
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    buffer.append(to_line(mesh.triangles[f], texture != nullptr ? &texture->triangles[f] : nullptr,
                          !mesh.normals.empty()));
  }
  buffer.flush();
  out.commit();
}

}  // namespace astrolith
