// The formats of meshes, one row each. Readers and writers, help texts, predictions and the Python package
// ask the row; a new format is a row and its functions.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "geometry/triangle_mesh.h"

namespace astrolith {

struct MeshFile;
struct MeshFileInfo;

struct MeshCounts {
  std::int64_t vertices = 0, triangles = 0;
};

struct MeshFormat {
  const char* name;
  std::array<std::string_view, 4> extensions;         // that may stand for it, its own first
  bool (*has)(const MeshFile&);                       // whether the content is of the format
  TriangleMesh (*reader)(const MeshFile&) = nullptr;  // null: meshes are only written so
  // Null: meshes are only read so. All below is about what is written.
  void (*writer)(const TriangleMesh&, const std::filesystem::path&, const MeshFileInfo&) = nullptr;
  const char* words = "";     // behind the extension in help texts
  bool tells_unit = false;    // in a comment, or by its nature, as a .glb is in metres
  bool tells_origin = false;  // so that coordinates may be relative to one
  bool has_colors = false;    // of vertices
  bool has_values = false;    // any numbers of vertices; a mesh without faces will do
  bool has_texture_coordinates = false;
  bool streamed = false;  // while the mesh is made; .zst behind the extension compresses it
  // The bytes of the file for each triangle, about, and those that the writer keeps of it.
  double file_bytes = 75.0, kept_bytes = 0.0;
  // What the file has of a mesh of so many vertices and triangles; null: the same.
  MeshCounts (*counts)(const MeshCounts&) = nullptr;
};

std::span<const MeshFormat> mesh_formats();

// The format in which a mesh of this name is written. Throws InputError for an extension that none writes.
// Programs that compute long before they write call it first.
const MeshFormat& written_mesh_format(const std::filesystem::path& file);

// Throws InputError where the format of this name lacks what is asked for, one of has_colors, has_values and
// has_texture_coordinates, with the extensions of those that have it.
void require_mesh_format(const std::filesystem::path& file, bool MeshFormat::*asked);

// What help texts say of the formats that are written: ".ply (binary, streamed), .stl or .obj"; and of those
// that are read.
std::string written_mesh_words();
std::string read_mesh_words();

// Whether the extension alone tells that the file is a mesh, and a mesh that read_mesh() reads. False for
// .txt, which may be anything.
bool has_mesh_extension(const std::filesystem::path& file);
bool has_readable_extension(const std::filesystem::path& file);

// The extension of a mesh's name in lower case, without the .zst or .gz of a compressed one: ".ply" for
// "Bennu.PLY" and for "bennu.ply.zst".
std::string mesh_extension(const std::filesystem::path& file);

}  // namespace astrolith
