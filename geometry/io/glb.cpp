// glTF 2.0 in its binary container (Khronos, sections 3 and 4.4): one chunk of JSON and one chunk of numbers.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <span>
#include <unordered_map>

#include "geometry/io/format_internal.h"
#include "numerics/length_unit.h"
#include "numerics/portable_angles.h"
#include "numerics/srgb.h"

namespace astrolith {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kFloat = 5126, kUnsignedInt = 5125, kUnsignedShort = 5123;  // component types
constexpr int kArrayBuffer = 34962, kElementArrayBuffer = 34963;          // targets of buffer views

Json vector_json(const Vec3f& v) { return Json::array({v.x, v.y, v.z}); }

// The smallest and largest coordinates as stored, which the format demands.
std::pair<Vec3f, Vec3f> float_bounds(const TriangleMesh& mesh) {
  const Box box = mesh.bounds();
  return {to_float(box.min), to_float(box.max)};
}

// A mesh whose vertices have texture coordinates. A triangle that crosses the 180th meridian would run
// backwards over the whole map. Its western vertices are therefore there twice: the second has u + 1, and
// maps repeat in u.
struct LongitudeLatitude {
  std::vector<std::uint32_t> doubled;  // (d) the vertices that are there twice, in the order of their seconds
  std::vector<std::array<float, 2>>
      texcoords;                    // (#V + d) u = 1/2 + longitude / 360 deg, v = 1/2 - latitude / 180 deg
  std::vector<Triangle> triangles;  // (#F) index #V + k is the second of doubled[k]
};

std::array<float, 2> texcoord_of(const Vec3d& place) {
  const double longitude = portable::atan2(place.y, place.x);
  const double latitude = portable::atan2(place.z, std::sqrt(place.x * place.x + place.y * place.y));
  return {static_cast<float>(0.5 + longitude / (2.0 * std::numbers::pi)),
          static_cast<float>(0.5 - latitude / std::numbers::pi)};
}

// Longitudes run east from +x about z, latitudes from the xy plane towards +z, both seen from the origin of
// the frame, which lies at -`origin` in the mesh's coordinates. The triangles at the two poles are distorted,
// as in every such map.
LongitudeLatitude longitude_latitude(const TriangleMesh& mesh, const Vec3d& origin) {
  LongitudeLatitude result;
  result.texcoords.reserve(mesh.vertices.size());
  for (const Vec3d& v : mesh.vertices) result.texcoords.push_back(texcoord_of(v + origin));
  std::unordered_map<std::uint32_t, std::uint32_t> second;
  const auto second_of = [&](std::uint32_t vertex) {
    const auto [found, is_new] =
        second.try_emplace(vertex, static_cast<std::uint32_t>(result.texcoords.size()));
    if (is_new) {
      result.doubled.push_back(vertex);
      result.texcoords.push_back({result.texcoords[vertex][0] + 1.0f, result.texcoords[vertex][1]});
    }
    return found->second;
  };
  result.triangles = mesh.triangles;
  for (Triangle& triangle : result.triangles) {
    const auto u = [&](int corner) {
      return result.texcoords[triangle[static_cast<std::size_t>(corner)]][0];
    };
    const auto [west, east] = std::minmax({u(0), u(1), u(2)});
    if (east - west <= 0.5f) continue;
    for (std::uint32_t& vertex : triangle) {
      if (result.texcoords[vertex][0] < 0.5f) vertex = second_of(vertex);
    }
  }
  return result;
}

// A mesh of the file, as it is stored.
struct StoredMesh {
  const TriangleMesh& mesh;
  std::optional<LongitudeLatitude> map;

  // Vertices that are there twice count twice.
  std::uint64_t num_vertices() const { return map ? map->texcoords.size() : mesh.vertices.size(); }
};

class GlbDocument {
 public:
  GlbDocument(std::span<const StoredMesh> levels, std::span<const double> coverage,
              const MeshFileInfo& info) {
    document_["asset"] = {{"version", "2.0"}, {"generator", "Astrolith"}, {"extras", extras(info)}};
    document_["scene"] = 0;
    document_["scenes"] = Json::array({{{"nodes", {0}}}});
    document_["nodes"] = Json::array();
    document_["materials"] = Json::array({material(levels.front().mesh)});
    for (const StoredMesh& level : levels) {
      document_["nodes"].push_back(node(info, document_["nodes"].size()));
      add_arrays(level);
    }
    if (levels.size() > 1) name_levels(levels.size(), coverage);
    document_["buffers"] = Json::array({{{"byteLength", num_bytes_}}});
  }

  std::string json() const { return document_.dump(-1, ' ', false, Json::error_handler_t::replace); }
  std::uint64_t num_bytes() const { return num_bytes_; }

 private:
  static Json extras(const MeshFileInfo& info) {
    Json extras = {{"length_unit", info.length_unit}, {"frame", info.frame}, {"comment", info.comment}};
    if (info.origin) extras["origin"] = {info.origin->x, info.origin->y, info.origin->z};
    return extras;
  }

  // The node turns the body about x, so that +z up becomes +y up. Quaternions are (x y z w).
  static Json node(const MeshFileInfo& info, std::size_t level) {
    constexpr double kHalf = 0.70710678118654757;
    const double scale = metres_of(info.length_unit);
    const std::string name = level == 0 ? "body" : "body_lod" + std::to_string(level);
    Json result = {{"mesh", level}, {"name", name}, {"rotation", {-kHalf, 0.0, 0.0, kHalf}}};
    result["scale"] = {scale, scale, scale};
    return result;
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

  // A material without shine; the default of glTF is fully metallic. Its colour multiplies those of the
  // vertices.
  static Json material(const TriangleMesh& mesh) {
    const double base = mesh.colors.empty() ? 0.5 : 1.0;
    return {
        {"name", "regolith"},
        {"pbrMetallicRoughness",
         {{"baseColorFactor", {base, base, base, 1.0}}, {"metallicFactor", 0.0}, {"roughnessFactor", 1.0}}}};
  }

  void add_arrays(const StoredMesh& level) {
    const TriangleMesh& mesh = level.mesh;
    const std::uint64_t vertices = level.num_vertices();
    const auto [low, high] = float_bounds(mesh);
    Json attributes;
    attributes["POSITION"] = add_array(vertices, kArrayBuffer, kFloat, "VEC3", 12);
    document_["accessors"].back()["min"] = vector_json(low);
    document_["accessors"].back()["max"] = vector_json(high);
    if (!mesh.normals.empty()) {
      attributes["NORMAL"] = add_array(vertices, kArrayBuffer, kFloat, "VEC3", 12);
    }
    if (!mesh.colors.empty()) {
      attributes["COLOR_0"] = add_array(vertices, kArrayBuffer, kUnsignedShort, "VEC4", 8);
      document_["accessors"].back()["normalized"] = true;
    }
    if (level.map) attributes["TEXCOORD_0"] = add_array(vertices, kArrayBuffer, kFloat, "VEC2", 8);
    const int indices = add_array(3 * mesh.triangles.size(), kElementArrayBuffer, kUnsignedInt, "SCALAR", 4);
    const Json primitive = {{"attributes", attributes}, {"indices", indices}, {"material", 0}, {"mode", 4}};
    document_["meshes"].push_back({{"primitives", Json::array({primitive})}});
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

  Json document_;
  std::uint64_t num_bytes_ = 0;  // a multiple of four: every array holds 4-byte numbers
};

// The linear light of each sRGB byte, full scale = 65535: glTF stores colours of vertices in linear light.
std::array<std::uint16_t, 256> linear_shorts() {
  std::array<std::uint16_t, 256> table{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    table[i] = static_cast<std::uint16_t>(65535.0 * linear_of_srgb(static_cast<double>(i) / 255.0) + 0.5);
  }
  return table;
}

// One value for each vertex, and again for those that are there twice; none where the mesh has none.
template <typename Value, typename Stored>
void append_all(BufferedOutput& buffer, const std::vector<Value>& values,
                std::span<const std::uint32_t> doubled, const Stored& stored) {
  if (values.empty()) return;
  for (const Value& value : values) buffer.append_value(stored(value));
  for (const std::uint32_t vertex : doubled) buffer.append_value(stored(values[vertex]));
}

void append_arrays(BufferedOutput& buffer, const StoredMesh& level) {
  const auto& [mesh, map] = level;
  const std::span<const std::uint32_t> doubled = map ? std::span(map->doubled) : std::span<std::uint32_t>{};
  const auto narrowed = [](const Vec3d& v) { return to_float(v); };
  append_all(buffer, mesh.vertices, doubled, narrowed);
  append_all(buffer, mesh.normals, doubled, narrowed);
  append_all(buffer, mesh.colors, doubled, [linear = linear_shorts()](const VertexColor& c) {
    return std::array<std::uint16_t, 4>{linear[c[0]], linear[c[1]], linear[c[2]], std::uint16_t{65535}};
  });
  if (map) {
    for (const std::array<float, 2>& uv : map->texcoords) buffer.append_value(uv);
  }
  for (const Triangle& t : map ? map->triangles : mesh.triangles) buffer.append_value(t);
}

void append_chunk_header(BufferedOutput& buffer, std::uint64_t bytes, std::string_view type) {
  buffer.append_value(static_cast<std::uint32_t>(bytes));
  buffer.append(type);
}

}  // namespace

void write_glb(const TriangleMesh& mesh, const std::filesystem::path& file, const MeshFileInfo& info) {
  const TriangleMesh* const only = &mesh;
  write_glb_levels({&only, 1}, {}, file, info);
}

void write_glb_levels(std::span<const TriangleMesh* const> levels, std::span<const double> coverage,
                      const std::filesystem::path& file, const MeshFileInfo& info) {
  std::vector<StoredMesh> stored;
  for (const TriangleMesh* mesh : levels) {
    stored.push_back({*mesh, std::nullopt});
    if (info.texture_coordinates) {
      stored.back().map =
          longitude_latitude(*mesh, info.whole_body ? Vec3d{} : info.origin.value_or(Vec3d{}));
    }
  }
  const GlbDocument document(stored, coverage, info);
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
  for (const StoredMesh& level : stored) append_arrays(buffer, level);
  buffer.flush();
  out.commit();
}

}  // namespace astrolith
