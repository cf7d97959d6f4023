// Which format a file has, by its name and by its content.
#pragma once

#include <filesystem>
#include <string>

#include "geometry/io/mesh_file_internal.h"

namespace astrolith {

// ".ply" for "Bennu.PLY".
std::string lower_extension(const std::filesystem::path& file);

using MeshReader = TriangleMesh (*)(const MeshFile&);

// The reader for the file. Throws InputError when the extension names one format and the content is
// unmistakably another, or when neither tells.
MeshReader reader_for(const MeshFile& file);

}  // namespace astrolith
