// Triangle meshes from files and into files.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace astrolith {

// Reads a mesh; the extension and the content must agree on the format:
//  - .obj: Wavefront; polygons, v/vt/vn corners, negative indices; texture and normals are passed over
//  - .ply: ascii, binary little and big endian; unit vertex normals are kept
//  - .stl: ascii and binary; corners at the same coordinates become one vertex
//  - .off: with or without colours and normals
//  - .tab .plt .txt: PDS plate model of rows "i x y z" and "i a b c", or "v x y z" and "f a b c"
//  - .icq (or .tab .plt .txt): Gaskell's implicitly connected quadrilaterals; the faces' edges are merged
//  - .bmf: bodies of OpenUniverse, in kilometres; welded, one winding of each triangle
// Another extension is decided by the content. Polygons become fans. Lengths stay in the file's unit.
//
// The mesh has coordinates of at most 1e18, at least one face and every index in range; it need not be
// closed. Throws InputError ("FILE: line 7: what is wrong; what to do"). Memory is bounded by the file's
// size, whatever the file declares.
TriangleMesh read_mesh(const std::filesystem::path& file);

// The same, but points with unit normals and no faces will do as well (.ply): the mesh then has vertices and
// normals and no triangles.
TriangleMesh read_mesh_or_points(const std::filesystem::path& file);

// What a mesh file says about itself; empty texts are left out.
struct MeshFileInfo {
  std::string length_unit;  // "m", "km", ...: what one unit of a coordinate is
  std::string frame;        // "body-fixed, +z spin pole, +x prime meridian"
  std::string comment;      // anything else, one line
  // In that frame, of coordinates that are relative to a point of it; absent: the frame's own.
  std::optional<Vec3d> origin = std::nullopt;
  std::vector<std::string> notes = {};  // further lines
};

// Writes .ply (binary little endian, float32), .obj (text, exact), .stl (binary, float32) or .glb (glTF 2.0,
// float32, a node that turns +z up into +y up and scales m, km, cm, mm into metres). Normals are written
// where the mesh has them. Throws InputError for another extension or a folder that cannot be written,
// WorkError for a mesh without triangles, with indices out of range, or with coordinates that float32 cannot
// hold.
void write_mesh(const TriangleMesh& mesh, const std::filesystem::path& file, const MeshFileInfo& info);

// Throws the InputError that write_mesh would throw for the extension: for programs that compute long before
// they write.
void check_mesh_extension(const std::filesystem::path& file);

}  // namespace astrolith
