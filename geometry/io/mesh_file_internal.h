// A mesh file in memory, and the one way its readers complain.
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

  // "FILE: place: what; remedy".
  [[noreturn]] void fail(std::string_view place, std::string_view what, std::string_view remedy) const;
};

// The whole file in one read. Throws InputError when it is missing, a folder, empty, or not a plain file.
MeshFile load_mesh_file(const std::filesystem::path& path);

// At most 40 characters of a piece of a file, fit for a one-line message: what is not printable ASCII is
// shown as '?'.
std::string quoted(std::string_view piece);

// One reader a format. They may leave indices out of range and coordinates not finite: read_mesh checks both.
TriangleMesh read_obj(const MeshFile& file);
TriangleMesh read_ply(const MeshFile& file);
TriangleMesh read_stl_ascii(const MeshFile& file);
TriangleMesh read_stl_binary(const MeshFile& file);
TriangleMesh read_off(const MeshFile& file);
TriangleMesh read_plate(const MeshFile& file);
TriangleMesh read_icq(const MeshFile& file);
TriangleMesh read_bmf(const MeshFile& file);

}  // namespace astrolith
