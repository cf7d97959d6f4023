// Reads triangle meshes from files and writes them into files.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/atlas/texture_coordinates.h"
#include "geometry/io/mesh_format.h"
#include "geometry/triangle_mesh.h"

namespace astrolith {

// Reads a mesh. The extension and the content must agree on the format:
// - .obj: Wavefront; polygons, corners v, v/vt, v/vt/vn, negative indices; texture and normals are ignored
// - .ply: ascii, binary little and big endian; unit vertex normals are kept
// - .stl: ascii and binary; corners at the same coordinates become one vertex
// - .off: with or without colours and normals
// - .tab .plt .txt: PDS plate model with rows "i x y z" and "i a b c", with rows "x y z" and "a b c" below
//   both counts in one line, or with rows "v x y z" and "f a b c"; the number of corners may stand before
//   each plate (.ver)
// - .icq (or .tab .plt .txt): Gaskell's implicitly connected quadrilaterals; the faces' edges are merged
// - tables of latitude, longitude and radius on a regular grid, poles closed; in degrees, longitudes to the
// east
//   unless a name or a label says west
// - .bmf: bodies of OpenUniverse, in kilometres; welded, with one winding of each triangle
// - .glb: the triangles of the scene of a glTF, in metres with +z up; welded; without parts that only collide
// - .bds: the plates of a SPICE shape kernel, in kilometres
// Files compressed by Zstandard or gzip are unpacked.
// For any other extension the content decides. Polygons become triangles: fans around their first corners, or
// ears where a fan would leave a polygon that is not convex. Lengths stay in the file's unit.
//
// The mesh has coordinates of at most 1e18, at least one face and every index in range; it need not be
// closed. Throws InputError ("FILE: line 7: what is wrong; what to do"). The size of the file bounds the
// memory used, whatever counts the file declares.
TriangleMesh read_mesh(const std::filesystem::path& file);

// Reads as read_mesh does, but also accepts points with normals and without faces (.ply). The mesh then
// has vertices and normals and no triangles.
TriangleMesh read_mesh_or_points(const std::filesystem::path& file);

// An image that a material shows.
struct SkinMap {
  enum class Use { kBaseColor, kNormal, kOcclusion };
  Use use = Use::kBaseColor;
  std::string name;
  std::string png;  // the bytes of the file
};

// What lies on a mesh: texture coordinates, and the maps that they look up.
struct MeshSkin {
  TextureCoordinates coordinates;
  std::vector<VertexTangent> tangents = {};  // (#W), or empty
  std::vector<SkinMap> maps = {};
  bool repeats = false;  // maps go on beyond their left and right border, as those by longitude do
};

// Statements of a mesh file about itself. Empty texts are not written.
struct MeshFileInfo {
  std::string length_unit;  // "m", "km", ...: what one unit of a coordinate is
  std::string frame;        // "body-fixed, +z spin pole, +x prime meridian"
  std::string comment;      // any other text, one line
  // The place in `frame` of the point that coordinates are relative to; absent where they are relative to the
  // origin of the frame.
  std::optional<Vec3d> origin = std::nullopt;
  bool whole_body = false;              // readers add the origin of a whole body, not that of a part
  std::vector<std::string> notes = {};  // further comment lines
  // A .glb or .obj gets texture coordinates by longitude and latitude, seen from the origin of the frame, or
  // of a whole body (geometry/atlas/texture_coordinates.h). Triangles are then cut along the 180th meridian.
  bool texture_coordinates = false;
  std::shared_ptr<const MeshSkin> skin = nullptr;  // of a .glb or .obj, instead of that; none where null
};

// Writes .ply (binary little endian, float32; .ply.zst is compressed), .obj (text, exact), .stl (binary,
// float32) or .glb (glTF 2.0, float32, metres where the unit's length is known; a node turns +z up into +y),
// .tab (PDS plate model, text, exact) or .icq (Gaskell's quadrilaterals, as many as half the triangles; for
// bodies with one surface along each direction from their centre of mass, others give InputError). Normals
// are written where the mesh and the format have them, colours of vertices into .ply (sRGB bytes) and .glb
// (COLOR_0, linear light). Throws InputError for another extension and for a folder that cannot be written.
// Throws WorkError for a mesh without triangles, with indices out of range, or with coordinates that float32
// cannot hold. Formats that state no origin get a whole body's coordinates in the frame.
void write_mesh(const TriangleMesh& mesh, const std::filesystem::path& file, const MeshFileInfo& info);

// The material beside an .obj whose skin has maps: write_mesh() writes it, too. It names the maps' images.
std::filesystem::path material_file(std::filesystem::path obj);

// Writes the levels of detail of one body into a .glb, the finest first: an engine shows level k + 1 where
// the body takes less than coverage[k] of the screen's height (MSFT_lod). `coverage` has a number in 0 .. 1
// for each level, falling; the last is the one below which nothing is shown. Throws as write_mesh does.
struct MeshLevel {
  const TriangleMesh* mesh;
  std::shared_ptr<const MeshSkin> skin = nullptr;
};
void write_mesh_levels(std::span<const MeshLevel> levels, std::span<const double> coverage,
                       const std::filesystem::path& file, const MeshFileInfo& info);

// What a file says of the unit of its lengths.
struct StatedUnit {
  std::string unit;             // "m", "km", ...; empty where nothing states one
  std::filesystem::path label;  // the label that states it; empty where the file does
};

// The unit that a comment states, such as "length unit: km" of write_mesh() (any word of up to 8 letters) or
// "# Units: meters" (or "Units:" and any word of up to 20), or the names of a table's columns, or a PDS3
// label in front; else a label beside the file, of the same name with .lbl or .xml, that names the file
// (PDS3's UNIT, PDS4's <unit>). Looks at the first 4,096 bytes of a mesh, and the first 256 kB of a label.
// Never throws for a file that cannot be read.
StatedUnit stated_unit(const std::filesystem::path& file);
inline std::string stated_length_unit(const std::filesystem::path& file) { return stated_unit(file).unit; }

struct PointTable {
  std::vector<Vec3d> points;
  std::string words;  // which columns are taken, by their names, and which are left out; empty without names
};

// Reads one point a line. A first line, or a comment before the first row, may name the columns: x, y, z, or
// latitude, longitude and radius, with units as in x_km, x[m] or "x (km)", among others. Lengths come in
// `unit` where the names state one and it is not empty; else as they are. Without names a line holds x, y and
// z, and in an .xyz more, which is ignored. Commas, semicolons, tabs or blanks separate columns. Empty lines
// and comments (#, %, !) are skipped. Throws InputError ("FILE: line 7: what is wrong; what to do") for a
// file without points, for other names and widths, and for numbers that are missing or not finite. The size
// of the file bounds the memory used.
PointTable read_point_table(const std::filesystem::path& file, std::string_view unit);

// Reads a mesh, or a cloud of points: .xyz .pts .asc .xyzn .xyzrgb, other text that is no mesh, and meshes
// without faces. Text may have a line "//X Y Z ..." or the number of points in front, and more columns than
// x, y and z, which are ignored. Normals are kept where all points of a .ply have one. Throws InputError as
// read_mesh and read_point_table do, and for unnamed columns the first of which counts the lines.
TriangleMesh read_cloud(const std::filesystem::path& file);
std::vector<Vec3d> read_points(const std::filesystem::path& file);  // a cloud of text alone

// Whether the name is that of a cloud of points.
bool holds_points(const std::filesystem::path& file);

}  // namespace astrolith
