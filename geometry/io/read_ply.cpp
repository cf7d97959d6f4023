// PLY, ascii and binary. Properties may come in any order and have any type; unknown properties and elements
// are skipped.
#include <algorithm>
#include <cmath>
#include <iterator>

#include "geometry/io/byte_reader_internal.h"
#include "geometry/io/format_internal.h"
#include "geometry/io/ply_header_internal.h"
#include "geometry/io/ply_values.h"
#include "geometry/io/text_scanner_internal.h"

namespace astrolith {
namespace {

// Reads the numbers of a binary body.
class BinarySource {
 public:
  BinarySource(const MeshFile& file, std::size_t offset, std::endian order) : bytes_(file, offset, order) {}

  double number(PlyType type, std::string_view what) {
    switch (type) {
      case PlyType::int8:
        return bytes_.read<std::int8_t>(what);
      case PlyType::uint8:
        return bytes_.read<std::uint8_t>(what);
      case PlyType::int16:
        return bytes_.read<std::int16_t>(what);
      case PlyType::uint16:
        return bytes_.read<std::uint16_t>(what);
      case PlyType::int32:
        return bytes_.read<std::int32_t>(what);
      case PlyType::uint32:
        return bytes_.read<std::uint32_t>(what);
      case PlyType::float32:
        return bytes_.read<float>(what);
      case PlyType::float64:
        return bytes_.read<double>(what);
    }
    return 0.0;
  }
  void skip(PlyType type) { bytes_.skip(type_size(type), "a property"); }
  void need_rows(const PlyElement& e) const {
    bytes_.need_rows(e.count, e.least_row_bytes(), astrolith::quoted(e.name) + " rows");
  }
  void need_entries(std::uint64_t count, PlyType type) const {
    bytes_.need_rows(count, type_size(type), "list entries");
  }
  [[noreturn]] void fail(std::string_view what, std::string_view remedy) const { bytes_.fail(what, remedy); }

 private:
  ByteReader bytes_;
};

// Reads the numbers of an ascii body.
class TextSource {
 public:
  explicit TextSource(TextScanner& scan) : scan_(scan) {}

  double number(PlyType, std::string_view what) {
    const std::string_view word = scan_.word_anywhere();
    if (word.empty()) scan_.fail_truncated(what);
    return scan_.to_number(word, what);
  }
  void skip(PlyType) {
    if (scan_.word_anywhere().empty()) scan_.fail_truncated("a property");
  }
  // A number takes a digit and a blank; the last blank of the file may be missing.
  void need_rows(const PlyElement& e) const {
    need(e.count, 2 * e.properties.size(), astrolith::quoted(e.name) + " rows");
  }
  void need_entries(std::uint64_t count, PlyType) const { need(count, 2, "list entries"); }
  [[noreturn]] void fail(std::string_view what, std::string_view remedy) const { scan_.fail(what, remedy); }

 private:
  void need(std::uint64_t count, std::size_t bytes, const std::string& rows) const {
    // The current line may hold entries too, so that the size of the whole file is the bound.
    if (bytes != 0 && count > (scan_.bytes_in_file() + 1) / bytes) {
      scan_.fail(std::to_string(count) + " " + rows + " are declared, more than the file can hold",
                 "it may be truncated: fetch it again");
    }
  }

  TextScanner& scan_;
};

template <typename Source>
std::uint64_t list_length(Source& source, const PlyProperty& property) {
  const double length = source.number(property.count_type, "a list's length");
  if (length < 0.0 || length != std::floor(length))
    source.fail("a list's length is no count", "repair the file");
  const auto count = static_cast<std::uint64_t>(std::min(length, 9e15));
  source.need_entries(count, property.type);
  return count;
}

template <typename Source>
void skip_property(Source& source, const PlyProperty& property) {
  const std::uint64_t count = property.is_list ? list_length(source, property) : 1;
  for (std::uint64_t i = 0; i < count; ++i) source.skip(property.type);
}

// `wanted` gets the values of the property that it names; nothing where its name is empty.
template <typename Source>
void read_vertices(Source& source, const PlyElement& element, TriangleMesh& mesh, VertexValues& wanted) {
  static constexpr std::string_view kNames[] = {"x", "y", "z", "nx", "ny", "nz"};
  constexpr int kWanted = 6, kSkipped = 7;
  std::vector<int> slots;
  int known = 0;
  for (const PlyProperty& property : element.properties) {
    int slot = 0;
    while (slot < kWanted && (property.is_list || kNames[slot] != property.name)) ++slot;
    if (slot == kWanted && (property.is_list || wanted.name != property.name)) slot = kSkipped;
    slots.push_back(slot);
    if (slot < kSkipped) known |= 1 << slot;
  }
  if ((known & 7) != 7) source.fail("the vertices have no x, y and z", "add the properties");
  const bool with_normals = (known & 63) == 63;
  const std::ptrdiff_t wanted_slot =
      std::find(std::begin(kNames), std::end(kNames), wanted.name) - std::begin(kNames);
  const bool with_wanted = (known >> wanted_slot & 1) != 0;
  mesh.vertices.reserve(element.count);
  if (with_normals) mesh.normals.reserve(element.count);
  for (std::uint64_t i = 0; i < element.count; ++i) {
    double values[kSkipped] = {};
    for (std::size_t p = 0; p < slots.size(); ++p) {
      if (slots[p] == kSkipped) {
        skip_property(source, element.properties[p]);
      } else {
        values[slots[p]] = source.number(element.properties[p].type, element.properties[p].name);
      }
    }
    mesh.vertices.push_back({values[0], values[1], values[2]});
    if (with_normals) mesh.normals.push_back({values[3], values[4], values[5]});
    if (with_wanted) wanted.values.push_back(values[wanted_slot]);
  }
}

template <typename Source>
void read_polygon(Source& source, const PlyProperty& list, std::vector<std::uint32_t>& polygon) {
  polygon.clear();
  for (std::uint64_t n = list_length(source, list); n > 0; --n) {
    const double index = source.number(list.type, "a vertex index");
    if (index < 0.0 || index >= static_cast<double>(kMaxVertices) || index != std::floor(index)) {
      source.fail("a vertex index is negative or no whole number", "repair the file");
    }
    polygon.push_back(static_cast<std::uint32_t>(index));
  }
}

template <typename Source>
void read_faces(Source& source, const PlyElement& element, TriangleMesh& mesh, PolygonFans& fans) {
  mesh.triangles.reserve(element.count);
  std::vector<std::uint32_t> polygon;
  for (std::uint64_t i = 0; i < element.count; ++i) {
    for (const PlyProperty& property : element.properties) {
      if (property.is_list && (property.name == "vertex_indices" || property.name == "vertex_index")) {
        read_polygon(source, property, polygon);
        fans.append(polygon, mesh.triangles);
      } else {
        skip_property(source, property);
      }
    }
  }
}

template <typename Source>
TriangleMesh read_body(Source&& source, const PlyHeader& header, VertexValues& wanted, PolygonFans& fans) {
  TriangleMesh mesh;
  for (const PlyElement& element : header.elements) {
    if (element.properties.empty()) continue;  // rows without properties take no bytes
    source.need_rows(element);
    if (element.name == "vertex" && mesh.vertices.empty()) {
      read_vertices(source, element, mesh, wanted);
    } else if (element.name == "face" && mesh.triangles.empty()) {
      read_faces(source, element, mesh, fans);
    } else {
      for (std::uint64_t i = 0; i < element.count; ++i) {
        for (const PlyProperty& property : element.properties) skip_property(source, property);
      }
    }
  }
  return mesh;
}

// False where a normal is not a unit vector: some programs write zeros for normals they do not have.
bool all_unit(const std::vector<Vec3d>& normals) {
  for (const Vec3d& n : normals) {
    if (!(std::fabs(squared_norm(n) - 1.0) < 1e-3)) return false;
  }
  return true;
}

TriangleMesh read_after(const PlyHeader& header, const MeshFile& file, TextScanner& scan,
                        VertexValues& wanted) {
  const std::size_t offset = file.bytes.size() - scan.bytes_left();
  PolygonFans fans;
  TriangleMesh mesh = header.ascii
                          ? read_body(TextSource(scan), header, wanted, fans)
                          : read_body(BinarySource(file, offset, header.order), header, wanted, fans);
  fans.cut_concave(file, mesh);
  return mesh;
}

// The properties of the vertices that are single numbers; and for messages.
std::vector<std::string> value_names(const PlyHeader& header) {
  std::vector<std::string> names;
  for (const PlyElement& element : header.elements) {
    if (element.name != "vertex") continue;
    for (const PlyProperty& p : element.properties) {
      if (!p.is_list) names.push_back(p.name);
    }
  }
  return names;
}

std::string describe_values(const PlyHeader& header) {
  std::string words;
  for (const std::string& name : value_names(header)) {
    if (words.size() < 200) words += (words.empty() ? "" : ", ") + name.substr(0, 40);
  }
  return words;
}

// A PLY, or else an error.
MeshFile loaded_ply(const std::filesystem::path& file) {
  MeshFile content = load_mesh_file(file);
  if (mesh_extension(file) != ".ply") content.fail("", "has no properties of vertices", "give a .ply");
  return content;
}

}  // namespace

VertexValues read_ply_values(const std::filesystem::path& file, const std::string& name) {
  const MeshFile content = loaded_ply(file);
  TextScanner scan(content);
  const PlyHeader header = read_ply_header(scan);
  VertexValues wanted{name, {}};
  const TriangleMesh mesh = read_after(header, content, scan, wanted);
  if (wanted.values.empty() || wanted.values.size() != mesh.vertices.size()) {
    content.fail("", "the vertices have no property " + astrolith::quoted(name),
                 "choose from " + describe_values(header));
  }
  return wanted;
}

std::vector<std::string> ply_value_names(const std::filesystem::path& file) {
  const MeshFile content = loaded_ply(file);
  TextScanner scan(content);
  return value_names(read_ply_header(scan));
}

TriangleMesh read_ply(const MeshFile& file) {
  VertexValues nothing;
  TextScanner scan(file);
  const PlyHeader header = read_ply_header(scan);
  TriangleMesh mesh = read_after(header, file, scan, nothing);
  if (mesh.triangles.empty()) {
    // The normals of points say where outside is, whatever their length.
    for (Vec3d& n : mesh.normals) n = normalized(n);
  }
  if (mesh.normals.size() != mesh.vertices.size() || !all_unit(mesh.normals)) mesh.normals.clear();
  return mesh;
}

}  // namespace astrolith
