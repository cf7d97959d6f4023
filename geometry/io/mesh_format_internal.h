// The formats of meshes: by a file's name and content for readers, by its name for writers.
#pragma once

#include <filesystem>

#include "geometry/io/mesh_file_internal.h"
#include "geometry/io/mesh_io.h"

namespace astrolith {

using MeshReader = TriangleMesh (*)(const MeshFile&);
using MeshWriter = void (*)(const TriangleMesh&, const std::filesystem::path&, const MeshFileInfo&);

// The reader for the file. Throws InputError when the extension names one format and the content is clearly
// another, and when neither tells the format.
MeshReader reader_for(const MeshFile& file);

// The writer for the extension. Throws InputError for an extension that none writes.
MeshWriter writer_for(const std::filesystem::path& file);

}  // namespace astrolith
