// Writes a mesh with named numbers at its vertices.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "geometry/io/mesh_io.h"

namespace astrolith {

// The values of one quantity, one for each vertex. The name is a word of letters, digits and underscores.
struct VertexValues {
  std::string name;
  std::vector<double> values;
};

// Reads the values of one property of the vertices of a PLY, of any type but a list, in the order of
// read_mesh(). Throws InputError for a file that is no PLY and for a property that it lacks, with the names
// that it has.
VertexValues read_ply_values(const std::filesystem::path& file, const std::string& name);

// The properties of the vertices of a PLY that are single numbers, in the file's order. Throws InputError for
// a file that is no PLY.
std::vector<std::string> ply_value_names(const std::filesystem::path& file);

// Writes a binary little-endian PLY: float32 x y z (and normals and uchar red green blue where the mesh has
// them), then each quantity as a float32 property of the vertex, which MeshLab, ParaView and CloudCompare
// show. The mesh must be as write_mesh() wants it. Throws InputError when the file cannot be written,
// WorkError when writing fails or when a quantity has another number of values than the mesh has vertices.
void write_ply_values(const TriangleMesh& mesh, std::span<const VertexValues> quantities,
                      const std::filesystem::path& file, const MeshFileInfo& info);

}  // namespace astrolith
