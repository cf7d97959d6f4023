// Finds the format of a file by its name and by its content.
#pragma once

#include "geometry/io/mesh_file_internal.h"

namespace astrolith {

using MeshReader = TriangleMesh (*)(const MeshFile&);

// The reader for the file. Throws InputError when the extension names one format and the content is clearly
// another, and when neither tells the format.
MeshReader reader_for(const MeshFile& file);

}  // namespace astrolith
