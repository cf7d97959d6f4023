// glTF 2.0 in its binary container (Khronos): the triangles that its scene shows, in metres. Its +y up
// becomes +z up. Parts that only collide, by the names of Godot and Unreal, are left out.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "geometry/io/format_internal.h"
#include "geometry/wound_surface.h"

namespace astrolith {
namespace {

using GltfJson = nlohmann::json;

constexpr const char* kRemedy = "export it as .glb of triangles, uncompressed and with all data in the file";

// A linear map and a shift: p -> x p.x + y p.y + z p.z + shift.
struct Placement {
  Vec3d x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, shift{0, 0, 0};

  Vec3d turned(const Vec3d& p) const { return p.x * x + p.y * y + p.z * z; }
  Vec3d operator()(const Vec3d& p) const { return turned(p) + shift; }
  Placement operator()(const Placement& inner) const {
    return {turned(inner.x), turned(inner.y), turned(inner.z), (*this)(inner.shift)};
  }
  bool mirrors() const { return dot(cross(x, y), z) < 0.0; }
};

// Quaternions of single precision for quarter turns become exact ones.
double snapped(double value) {
  constexpr double kRounding = 1e-7;
  const double whole = std::round(value);
  return std::fabs(value - whole) < kRounding ? whole : value;
}

// A whole number of the document, which is not negative; `otherwise` where the member is absent.
std::uint64_t whole(const GltfJson& number) {
  if (!number.is_number_unsigned())
    throw GltfJson::other_error::create(501, "a number that is not whole", &number);
  return number.get<std::uint64_t>();
}
std::uint64_t whole(const GltfJson& object, const char* name, std::uint64_t otherwise) {
  return object.contains(name) ? whole(object.at(name)) : otherwise;
}

template <std::size_t kCount>
std::array<double, kCount> numbers_of(const GltfJson& node, const char* name,
                                      const std::array<double, kCount>& otherwise) {
  if (!node.contains(name)) return otherwise;
  const auto values = node.at(name).get<std::vector<double>>();
  if (values.size() != kCount) throw GltfJson::other_error::create(501, "another count of numbers", &node);
  return node.at(name).get<std::array<double, kCount>>();
}

Placement placement_of(const GltfJson& node) {
  if (node.contains("matrix")) {
    const auto m = numbers_of<16>(node, "matrix", {});
    return {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}, {m[12], m[13], m[14]}};
  }
  const auto [i, j, k, w] = numbers_of<4>(node, "rotation", {0, 0, 0, 1});
  const auto s = numbers_of<3>(node, "scale", {1, 1, 1}), t = numbers_of<3>(node, "translation", {0, 0, 0});
  const auto column = [](double scale, double a, double b, double c) {
    return scale * Vec3d{snapped(a), snapped(b), snapped(c)};
  };
  return {column(s[0], 1 - 2 * (j * j + k * k), 2 * (i * j + k * w), 2 * (i * k - j * w)),
          column(s[1], 2 * (i * j - k * w), 1 - 2 * (i * i + k * k), 2 * (j * k + i * w)),
          column(s[2], 2 * (i * k + j * w), 2 * (j * k - i * w), 1 - 2 * (i * i + j * j)),
          {t[0], t[1], t[2]}};
}

bool only_collides(const std::string& name) {
  return name.starts_with("UCX_") || name.starts_with("UBX_") || name.starts_with("USP_") ||
         name.ends_with("-colonly") || name.ends_with("-convcolonly");
}

class GlbReader {
 public:
  explicit GlbReader(const MeshFile& file) : file_(file) {
    constexpr std::size_t kHeader = 12, kChunkHeader = 8;
    std::string_view rest = file.bytes;
    if (rest.size() < kHeader || word(4) != 2) file.fail("byte 4", "is no glTF of version 2", kRemedy);
    rest.remove_prefix(kHeader);
    for (std::string_view* chunk : {&json_, &binary_}) {
      if (rest.size() < kChunkHeader) break;
      const std::size_t at = file.bytes.size() - rest.size(), length = word(at);
      if (length > rest.size() - kChunkHeader)
        file.fail("byte " + std::to_string(at), "a chunk ends beyond the file", "fetch the file again");
      *chunk = rest.substr(kChunkHeader, length);
      rest.remove_prefix(kChunkHeader + length);
    }
  }

  TriangleMesh read() {
    try {
      constexpr int kDeepest = 64;  // copies of a document call themselves for each level
      document_ = GltfJson::parse(json_, [&](int depth, GltfJson::parse_event_t, GltfJson&) {
        if (depth > kDeepest) file_.fail("its JSON", "is nested too deep", kRemedy);
        return true;
      });
      for (const GltfJson& required : document_.value("extensionsRequired", GltfJson::array())) {
        const auto name = required.get<std::string>();
        const auto is_about = [&](const char* word) { return name.find(word) != name.npos; };
        if (!is_about("texture") && !is_about("materials") && !is_about("lights"))
          file_.fail("", "needs the extension " + astrolith::quoted(name), kRemedy);
      }
      const GltfJson& scene = document_.at("scenes").at(whole(document_, "scene", 0));
      visited_.resize(document_.at("nodes").size());
      const Placement pole_up{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}};  // (x, y, z) -> (x, -z, y)
      for (const GltfJson& node : scene.at("nodes")) add_node(whole(node), pole_up);
      // Files of this program state an origin: readers add that of a whole body, not that of a patch.
      const GltfJson extras =
          document_.value("asset", GltfJson::object()).value("extras", GltfJson::object());
      if (extras.is_object() && extras.value("whole_body", false)) {
        const auto origin = numbers_of<3>(extras, "origin", {0, 0, 0});
        for (Vec3d& p : mesh_.vertices) p += Vec3d{origin[0], origin[1], origin[2]};
      }
    } catch (const GltfJson::exception& e) {
      file_.fail("its JSON", "is no glTF: " + astrolith::quoted(e.what()), kRemedy);
    }
    return weld_vertices(std::move(mesh_), 0.0);  // vertices are split where a texture or a normal has a seam
  }

 private:
  std::uint32_t word(std::size_t at) const {
    std::uint32_t value = 0;
    std::memcpy(&value, file_.bytes.data() + at, sizeof value);
    return value;
  }

  void add_node(std::size_t first, const Placement& outer) {
    std::vector<std::pair<std::size_t, Placement>> waiting{{first, outer}};
    while (!waiting.empty()) {
      const auto [number, around] = waiting.back();
      waiting.pop_back();
      const GltfJson& node = document_.at("nodes").at(number);
      if (visited_.at(number)) file_.fail("node " + std::to_string(number), "hangs in two places", kRemedy);
      visited_[number] = true;
      const Placement place = around(placement_of(node));
      if (node.contains("mesh") && !only_collides(node.value("name", std::string()))) {
        for (const GltfJson& primitive : document_.at("meshes").at(whole(node["mesh"])).at("primitives"))
          add_primitive(primitive, place);
      }
      for (const GltfJson& child : node.value("children", GltfJson::array()))
        waiting.emplace_back(whole(child), place);
    }
  }

  void add_primitive(const GltfJson& primitive, const Placement& place) {
    constexpr std::uint64_t kTriangles = 4;
    if (whole(primitive, "mode", kTriangles) != kTriangles)
      file_.fail("a mesh", "holds points, lines or strips", kRemedy);
    const Rows positions = rows(primitive.at("attributes").at("POSITION"), 5126, 12);
    const Rows indices = primitive.contains("indices") ? rows(primitive["indices"], 0, 0) : Rows{};
    // Nodes may show one mesh many times.
    constexpr std::size_t kMostGrowth = 16;
    const std::size_t corners = indices.bytes != nullptr ? indices.count : positions.count;
    if (mesh_.vertices.size() + positions.count + mesh_.triangles.size() + corners / 3 >
        kMostGrowth * file_.bytes.size() / 12)
      file_.fail("", "shows its meshes too many times", kRemedy);
    const auto base = static_cast<std::uint32_t>(mesh_.vertices.size());
    for (std::size_t i = 0; i < positions.count; ++i) {
      float p[3];
      std::memcpy(p, positions.bytes + i * positions.stride, sizeof p);
      const Vec3d placed = place(Vec3d{p[0], p[1], p[2]});
      if (!std::isfinite(squared_norm(placed)))
        file_.fail("a mesh", "a coordinate is not finite", "repair it, or state lengths in a larger unit");
      mesh_.vertices.push_back(placed);
    }
    for (std::size_t i = 0; i + 2 < corners; i += 3) {
      Triangle t{};
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint64_t corner = indices.bytes != nullptr ? indices.number(i + k) : i + k;
        if (corner >= positions.count)
          file_.fail("a mesh", "a triangle names a vertex that is not there", "fetch the file again");
        t[k] = base + static_cast<std::uint32_t>(corner);
      }
      if (place.mirrors()) std::swap(t[1], t[2]);
      mesh_.triangles.push_back(t);
    }
  }

  struct Rows {
    const char* bytes = nullptr;
    std::size_t count = 0, stride = 0;
    std::size_t width = 0;  // of an index

    std::uint64_t number(std::size_t i) const {
      std::uint32_t value = 0;
      std::memcpy(&value, bytes + i * stride, width);
      return value;
    }
  };

  // The values of an accessor, of this component and width in bytes; 0: indices.
  Rows rows(const GltfJson& number, std::uint64_t component, std::size_t width) const {
    const GltfJson& accessor = document_.at("accessors").at(whole(number));
    const std::uint64_t stored = whole(accessor.at("componentType"));
    if (width == 0) width = stored == 5121 ? 1 : stored == 5123 ? 2 : stored == 5125 ? 4 : 0;
    const char* const type = component != 0 ? "VEC3" : "SCALAR";
    if (width == 0 || (component != 0 && stored != component) || accessor.at("type") != type ||
        accessor.contains("sparse") || !accessor.contains("bufferView"))
      file_.fail("accessor " + number.dump(), "stores positions or indices in a way that is not read",
                 kRemedy);
    const GltfJson& view = document_.at("bufferViews").at(whole(accessor["bufferView"]));
    if (view.at("buffer") != 0 || document_.at("buffers").at(0).contains("uri"))
      file_.fail("", "keeps its data in another file", kRemedy);
    const std::uint64_t count = whole(accessor.at("count")), offset = whole(accessor, "byteOffset", 0),
                        view_offset = whole(view, "byteOffset", 0), stride = whole(view, "byteStride", width);
    const std::uint64_t size = binary_.size();
    if (stride < width || view_offset > size || offset > size - view_offset ||
        (count > 0 && (size - view_offset - offset < width ||
                       (count - 1) > (size - view_offset - offset - width) / stride)))
      file_.fail("accessor " + number.dump(), "ends beyond the data", "fetch the file again");
    return {binary_.data() + view_offset + offset, static_cast<std::size_t>(count),
            static_cast<std::size_t>(stride), width};
  }

  const MeshFile& file_;
  std::string_view json_, binary_;
  GltfJson document_;
  std::vector<bool> visited_;
  TriangleMesh mesh_;
};

}  // namespace

bool is_glb(const MeshFile& file) { return file.bytes.starts_with("glTF"); }

TriangleMesh read_glb(const MeshFile& file) { return GlbReader(file).read(); }

}  // namespace astrolith
