// glTF 2.0 in its binary container (Khronos, sections 3 and 4.4): one chunk of JSON and one chunk of numbers.
#include <algorithm>
#include <array>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "geometry/io/format_internal.h"
#include "numerics/length_unit.h"
#include "numerics/srgb.h"

namespace astrolith {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kFloat = 5126, kUnsignedInt = 5125, kUnsignedShort = 5123;  // component types
constexpr int kArrayBuffer = 34962, kElementArrayBuffer = 34963;          // targets of buffer views

Json vector_json(const Vec3f& v) { return Json::array({v.x, v.y, v.z}); }

// A glTF is in metres. Positions are metres themselves, because many readers pass over the scale of a node.
// Lengths of an unknown unit stay as they are.
std::string stored_unit(const MeshFileInfo& info) {
  return has_known_length(info.length_unit) ? "m" : info.length_unit;
}

// The smallest and largest coordinates as stored, which the format demands.
std::pair<Vec3f, Vec3f> float_bounds(const TriangleMesh& mesh, double scale) {
  const Box box = mesh.bounds();
  return {to_float(scale * box.min), to_float(scale * box.max)};
}

// The vertices that a level stores: with a skin, its textured vertices.
std::uint64_t num_stored(const MeshLevel& level) {
  return level.skin ? level.skin->coordinates.uv.size() : level.mesh->vertices.size();
}

const std::vector<Triangle>& stored_triangles(const MeshLevel& level) {
  return level.skin ? level.skin->coordinates.triangles : level.mesh->triangles;
}

bool has_tangents(const MeshLevel& level) { return level.skin && !level.skin->tangents.empty(); }

// A map of colours takes the place of the colours of vertices, which would multiply it.
bool has_vertex_colors(const MeshLevel& level) {
  const auto is_color = [](const SkinMap& map) { return map.use == SkinMap::Use::kBaseColor; };
  return !level.mesh->colors.empty() &&
         !(level.skin && std::any_of(level.skin->maps.begin(), level.skin->maps.end(), is_color));
}

std::uint64_t padded(std::uint64_t bytes) { return (bytes + 3) / 4 * 4; }

class GlbDocument {
 public:
  GlbDocument(std::span<const MeshLevel> levels, std::span<const double> coverage, const MeshFileInfo& info)
      : scale_(metres_per_unit(info.length_unit)) {
    document_["asset"] = {{"version", "2.0"}, {"generator", "Astrolith"}, {"extras", extras(info)}};
    document_["scene"] = 0;
    document_["scenes"] = Json::array({{{"nodes", {0}}}});
    document_["nodes"] = Json::array();
    document_["materials"] = Json::array();
    for (const MeshLevel& level : levels) {
      const std::size_t number = document_["nodes"].size();
      document_["nodes"].push_back(node(number));
      if (number == 0 || has_maps(level)) add_material(level, number);
      add_arrays(level, number);
    }
    for (const MeshLevel& level : levels) add_images(level);
    if (levels.size() > 1) name_levels(levels.size(), coverage);
    document_["buffers"] = Json::array({{{"byteLength", num_bytes_}}});
  }

  std::string json() const { return document_.dump(-1, ' ', false, Json::error_handler_t::replace); }
  std::uint64_t num_bytes() const { return num_bytes_; }

 private:
  Json extras(const MeshFileInfo& info) const {
    Json extras = {{"length_unit", stored_unit(info)}, {"frame", info.frame}, {"comment", info.comment}};
    if (info.origin) {
      const Vec3d origin = scale_ * *info.origin;
      extras["origin"] = {origin.x, origin.y, origin.z};
      extras["whole_body"] = info.whole_body;
    }
    return extras;
  }

  // The node turns the body about x, so that +z up becomes +y up. Quaternions are (x y z w).
  static Json node(std::size_t level) {
    constexpr double kHalf = 0.70710678118654757;
    return {{"mesh", level}, {"name", level_name("body", level)}, {"rotation", {-kHalf, 0.0, 0.0, kHalf}}};
  }

  // The first node stands for all levels (MSFT_lod): engines show the others below these shares of the
  // screen's height.
  void name_levels(std::size_t levels, std::span<const double> coverage) {
    document_["extensionsUsed"] = {"MSFT_lod"};
    Json ids = Json::array();
    for (std::size_t level = 1; level < levels; ++level) ids.push_back(level);
    Json& first = document_["nodes"][0];
    first["extensions"] = {{"MSFT_lod", {{"ids", ids}}}};
    first["extras"] = {{"MSFT_screencoverage", coverage}};
  }

  static std::string level_name(const std::string& name, std::size_t level) {
    return level == 0 ? name : name + "_lod" + std::to_string(level);
  }

  static bool has_maps(const MeshLevel& level) { return level.skin && !level.skin->maps.empty(); }

  // A material without shine; the default of glTF is fully metallic. Its colour multiplies those of the
  // vertices and of its map.
  void add_material(const MeshLevel& level, std::size_t number) {
    Json surface = {{"metallicFactor", 0.0}, {"roughnessFactor", 1.0}};
    Json material = {{"name", level_name("regolith", number)}};
    bool is_colored = !level.mesh->colors.empty();
    if (has_maps(level)) {
      for (const SkinMap& map : level.skin->maps) {
        const Json texture = {{"index", add_texture(map, level.skin->repeats)}};
        if (map.use == SkinMap::Use::kBaseColor) surface["baseColorTexture"] = texture, is_colored = true;
        if (map.use == SkinMap::Use::kNormal) material["normalTexture"] = texture;
        if (map.use == SkinMap::Use::kOcclusion) material["occlusionTexture"] = texture;
      }
    }
    const double base = is_colored ? 1.0 : 0.5;
    surface["baseColorFactor"] = {base, base, base, 1.0};
    material["pbrMetallicRoughness"] = std::move(surface);
    document_["materials"].push_back(std::move(material));
  }

  // Names a texture and its image, whose bytes follow the arrays. Returns the number of the texture.
  std::size_t add_texture(const SkinMap& map, bool repeats) {
    constexpr int kRepeat = 10497, kClamp = 33071, kLinear = 9729, kLinearMipmaps = 9987;
    if (!document_.contains("textures")) {
      document_["samplers"] = Json::array({{{"magFilter", kLinear},
                                            {"minFilter", kLinearMipmaps},
                                            {"wrapS", repeats ? kRepeat : kClamp},
                                            {"wrapT", kClamp}}});
      document_["textures"] = Json::array();
      document_["images"] = Json::array();
    }
    const std::size_t number = document_["textures"].size();
    document_["textures"].push_back({{"name", map.name}, {"sampler", 0}, {"source", number}});
    document_["images"].push_back({{"name", map.name}, {"mimeType", "image/png"}});
    return number;
  }

  void add_images(const MeshLevel& level) {
    if (!has_maps(level)) return;
    for (const SkinMap& map : level.skin->maps) {
      document_["images"][num_images_++]["bufferView"] = document_["bufferViews"].size();
      document_["bufferViews"].push_back(
          {{"buffer", 0}, {"byteOffset", num_bytes_}, {"byteLength", map.png.size()}});
      num_bytes_ += padded(map.png.size());
    }
  }

  void add_arrays(const MeshLevel& level, std::size_t number) {
    const TriangleMesh& mesh = *level.mesh;
    const std::uint64_t vertices = num_stored(level);
    const auto [low, high] = float_bounds(mesh, scale_);
    Json attributes;
    attributes["POSITION"] = add_array(vertices, kArrayBuffer, kFloat, "VEC3", 12);
    document_["accessors"].back()["min"] = vector_json(low);
    document_["accessors"].back()["max"] = vector_json(high);
    if (!mesh.normals.empty()) {
      attributes["NORMAL"] = add_array(vertices, kArrayBuffer, kFloat, "VEC3", 12);
    }
    if (has_tangents(level)) attributes["TANGENT"] = add_array(vertices, kArrayBuffer, kFloat, "VEC4", 16);
    if (has_vertex_colors(level)) {
      attributes["COLOR_0"] = add_array(vertices, kArrayBuffer, kUnsignedShort, "VEC4", 8);
      document_["accessors"].back()["normalized"] = true;
    }
    if (level.skin) attributes["TEXCOORD_0"] = add_array(vertices, kArrayBuffer, kFloat, "VEC2", 8);
    const int indices = add_array(3 * mesh.triangles.size(), kElementArrayBuffer, kUnsignedInt, "SCALAR", 4);
    const std::size_t material = has_maps(level) ? number : 0;
    const Json primitive = {
        {"attributes", attributes}, {"indices", indices}, {"material", material}, {"mode", 4}};
    document_["meshes"].push_back(
        {{"name", level_name("body", number)}, {"primitives", Json::array({primitive})}});
  }

  // Adds one buffer view with one accessor and returns the number of the accessor.
  int add_array(std::uint64_t count, int target, int component, const char* type, std::uint64_t bytes_each) {
    const int number = static_cast<int>(document_["accessors"].size());
    document_["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", num_bytes_}, {"byteLength", count * bytes_each}, {"target", target}});
    document_["accessors"].push_back(
        {{"bufferView", number}, {"componentType", component}, {"count", count}, {"type", type}});
    num_bytes_ += count * bytes_each;
    return number;
  }

  double scale_;  // metres of the unit of the mesh
  Json document_;
  std::size_t num_images_ = 0;   // whose bytes have a place
  std::uint64_t num_bytes_ = 0;  // a multiple of four: every array holds 4-byte numbers
};

// The linear light of each sRGB byte, full scale = 65535: glTF stores colours of vertices in linear light.
std::array<std::uint16_t, 256> linear_shorts() {
  std::array<std::uint16_t, 256> table{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    table[i] = static_cast<std::uint16_t>(65535.0 * srgb_to_linear(static_cast<double>(i) / 255.0) + 0.5);
  }
  return table;
}

// One value for each stored vertex; none where the mesh has none.
template <typename Value, typename Stored>
void append_all(BufferedOutput& buffer, const std::vector<Value>& values, const MeshLevel& level,
                const Stored& stored) {
  if (values.empty()) return;
  if (!level.skin) {
    for (const Value& value : values) buffer.append_value(stored(value));
    return;
  }
  for (const std::uint32_t vertex : level.skin->coordinates.mesh_vertex)
    buffer.append_value(stored(values[vertex]));
}

void append_arrays(BufferedOutput& buffer, const MeshLevel& level, double scale) {
  append_all(buffer, level.mesh->vertices, level, [scale](const Vec3d& v) { return to_float(scale * v); });
  append_all(buffer, level.mesh->normals, level, [](const Vec3d& v) { return to_float(v); });
  if (has_tangents(level)) {
    for (const VertexTangent& tangent : level.skin->tangents) buffer.append_value(tangent);
  }
  if (has_vertex_colors(level)) {
    append_all(buffer, level.mesh->colors, level, [linear = linear_shorts()](const VertexColor& c) {
      return std::array<std::uint16_t, 4>{linear[c[0]], linear[c[1]], linear[c[2]], std::uint16_t{65535}};
    });
  }
  if (level.skin) {
    for (const TexturePoint& uv : level.skin->coordinates.uv) buffer.append_value(uv);
  }
  for (const Triangle& t : stored_triangles(level)) buffer.append_value(t);
}

void append_images(BufferedOutput& buffer, const MeshLevel& level) {
  if (!level.skin) return;
  for (const SkinMap& map : level.skin->maps) {
    buffer.append(map.png);
    buffer.append(std::string(padded(map.png.size()) - map.png.size(), '\0'));
  }
}

void append_chunk_header(BufferedOutput& buffer, std::uint64_t bytes, std::string_view type) {
  buffer.append_value(static_cast<std::uint32_t>(bytes));
  buffer.append(type);
}

}  // namespace

void write_glb(const TriangleMesh& mesh, const std::filesystem::path& file, const MeshFileInfo& info) {
  const MeshLevel only{&mesh, info.skin};
  write_glb_levels({&only, 1}, {}, file, info);
}

void write_glb_levels(std::span<const MeshLevel> levels, std::span<const double> coverage,
                      const std::filesystem::path& file, const MeshFileInfo& info) {
  const GlbDocument document(levels, coverage, info);
  std::string json = document.json();
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::uint64_t total = 12 + 8 + json.size() + 8 + document.num_bytes();
  if (total > std::numeric_limits<std::uint32_t>::max()) {
    throw WorkError(file.string() + ": a GLB holds at most 4 GB; write a .ply");
  }
  OutputFile out(file);
  BufferedOutput buffer(out);
  buffer.append("glTF");
  buffer.append_value(std::uint32_t{2});
  buffer.append_value(static_cast<std::uint32_t>(total));
  append_chunk_header(buffer, json.size(), "JSON");
  buffer.append(json);
  append_chunk_header(buffer, document.num_bytes(), {"BIN\0", 4});
  const double scale = metres_per_unit(info.length_unit);
  for (const MeshLevel& level : levels) append_arrays(buffer, level, scale);
  for (const MeshLevel& level : levels) append_images(buffer, level);
  buffer.flush();
  out.commit();
}

}  // namespace astrolith
