// The texels of an atlas in tiles, and the place on the mesh that each texel shows.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/atlas/texture_atlas.h"
#include "geometry/atlas/texture_coordinates.h"
#include "geometry/triangle_mesh.h"

namespace astrolith {

// A textured mesh: all of one mesh, which has normals.
struct TexturedMesh {
  const TriangleMesh& mesh;
  const TextureAtlas& atlas;
  std::span<const VertexTangent> tangents;  // (#W)
};

// What a material's interpolation has at the centre of a texel. Nothing of it has unit length but the sum of
// a triangle's weights.
struct TexelPlace {
  bool is_covered = false;  // whether the centre lies in a triangle; all else is 0 if not
  Vec3f position;           // length units
  Vec3f normal;             // weighted sum of the corners' unit normals
  Vec3f tangent;            // weighted sum of the corners' tangents
  float sign = 1.0f;        // of the bitangent
};

// Texels of one chart, with a border of one texel that neighbouring tiles have, too.
struct TexelTile {
  static constexpr int kSide = 24, kMostTexels = (kSide + 2) * (kSide + 2);

  int x = 0, y = 0, width = 0, height = 0;  // in the image, without the border
  std::uint32_t first = 0, count = 0;       // of its triangles

  int padded_width() const { return width + 2; }
  std::size_t num_texels() const { return static_cast<std::size_t>((width + 2) * (height + 2)); }
};

class AtlasTexels {
 public:
  explicit AtlasTexels(const TexturedMesh& textured);

  std::span<const TexelTile> tiles() const { return tiles_; }
  // (height + 2 x width + 2) The texels of a tile with its border, row-major. A centre on the side of several
  // triangles belongs to the first.
  void locate(const TexelTile& tile, std::span<TexelPlace> places) const;

 private:
  void draw(std::uint32_t triangle, const TexelTile& tile, std::span<TexelPlace> places) const;

  TexturedMesh textured_;
  std::vector<TexelTile> tiles_;
  std::vector<std::uint32_t> triangles_;  // of one tile after those of another
};

}  // namespace astrolith
