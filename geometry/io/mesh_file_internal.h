// A mesh file in memory, and the one form of its readers' error messages.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "geometry/triangle_mesh.h"
#include "numerics/errors.h"

namespace astrolith {

struct MeshFile {
  std::filesystem::path path;
  std::string bytes;

  // Throws InputError("FILE: place: what; remedy"). An empty place is left out.
  [[noreturn]] void fail(std::string_view place, std::string_view what, std::string_view remedy) const;
};

// Reads the whole file, and unpacks Zstandard, to at most 100 times the file's size. Throws InputError when
// it is missing, empty, a folder, or not a plain file.
MeshFile load_mesh_file(const std::filesystem::path& path);

// At most 40 characters of a piece of a file, in quotes, for a one-line message. Characters that are not
// printable ASCII become '?'.
std::string quoted(std::string_view piece);

// One reader for each format. Readers may leave indices out of range and coordinates that are not finite;
// read_mesh checks both.
TriangleMesh read_obj(const MeshFile& file);
TriangleMesh read_ply(const MeshFile& file);
TriangleMesh read_stl_ascii(const MeshFile& file);
TriangleMesh read_stl_binary(const MeshFile& file);
TriangleMesh read_off(const MeshFile& file);
TriangleMesh read_plate(const MeshFile& file);
TriangleMesh read_icq(const MeshFile& file);
TriangleMesh read_bmf(const MeshFile& file);

}  // namespace astrolith
