// Reads triangle meshes from files and writes them into files.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "geometry/io/mesh_format.h"
#include "geometry/triangle_mesh.h"

namespace astrolith {

// Reads a mesh. The extension and the content must agree on the format:
// - .obj: Wavefront; polygons, corners v, v/vt, v/vt/vn, negative indices; texture and normals are ignored
// - .ply: ascii, binary little and big endian; unit vertex normals are kept
// - .stl: ascii and binary; corners at the same coordinates become one vertex
// - .off: with or without colours and normals
// - .tab .plt .txt: PDS plate model with rows "i x y z" and "i a b c", with rows "x y z" and "a b c" below
//   both counts in one line, or with rows "v x y z" and "f a b c"
// - .icq (or .tab .plt .txt): Gaskell's implicitly connected quadrilaterals; the faces' edges are merged
// - .bmf: bodies of OpenUniverse, in kilometres; welded, with one winding of each triangle
// For any other extension the content decides. Polygons become fans. Lengths stay in the file's unit.
//
// The mesh has coordinates of at most 1e18, at least one face and every index in range; it need not be
// closed. Throws InputError ("FILE: line 7: what is wrong; what to do"). The size of the file bounds the
// memory used, whatever counts the file declares.
TriangleMesh read_mesh(const std::filesystem::path& file);

// Reads as read_mesh does, but also accepts points with unit normals and without faces (.ply). The mesh then
// has vertices and normals and no triangles.
TriangleMesh read_mesh_or_points(const std::filesystem::path& file);

// Statements of a mesh file about itself. Empty texts are not written.
struct MeshFileInfo {
  std::string length_unit;  // "m", "km", ...: what one unit of a coordinate is
  std::string frame;        // "body-fixed, +z spin pole, +x prime meridian"
  std::string comment;      // any other text, one line
  // The place in `frame` of the point that coordinates are relative to; absent where they are relative to the
  // origin of the frame.
  std::optional<Vec3d> origin = std::nullopt;
  std::vector<std::string> notes = {};  // further comment lines
  // A .glb gets texture coordinates: u = 1/2 + longitude / 360 degrees, v = 1/2 - latitude / 180 degrees,
  // seen from the origin of the frame. Vertices along the 180th meridian are then there twice, at equal
  // places.
  bool texture_coordinates = false;
};

// Writes .ply (binary little endian, float32; .ply.zst is compressed), .obj (text, exact), .stl (binary,
// float32) or .glb (glTF 2.0, float32; a node turns +z up into +y up and scales m, km, cm, mm to metres),
// .tab (PDS plate model, text, exact) or .icq (Gaskell's quadrilaterals, as many as half the triangles; for
// bodies with one surface along each direction from their centre of mass, others give InputError). Normals
// are written where the mesh and the format have them, colours of vertices into .ply (sRGB bytes) and .glb
// (COLOR_0, linear light). Throws InputError for another extension and for a folder that cannot be written.
// Throws WorkError for a mesh without triangles, with indices out of range, or with coordinates that float32
// cannot hold.
void write_mesh(const TriangleMesh& mesh, const std::filesystem::path& file, const MeshFileInfo& info);

// The unit in the comment "length unit: km" that write_mesh() writes in front of a .ply, .obj or .stl, .zst
// or not. Any word of up to 8 letters is one. Empty where the file states none or cannot be read. Looks at
// the first 4,096 bytes of the content only.
std::string stated_length_unit(const std::filesystem::path& file);

// Reads one point a line: x, y and z, separated by commas or blanks; what follows them is ignored. Empty
// lines, lines that begin with # and one line of column names at the start are skipped. Throws InputError
// ("FILE: line 7: what is wrong; what to do") for a file without points and for numbers that are missing or
// not finite. The size of the file bounds the memory used.
std::vector<Vec3d> read_points(const std::filesystem::path& file);

}  // namespace astrolith
