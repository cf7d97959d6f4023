// Ambient occlusion of texels, by rays to a mesh of the body.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "numerics/vec3.h"
#include "synthesis/picture/ray_scene.h"

namespace astrolith {

// The 64 texels of a square of 8 x 8 have a direction each, and a blur over such a square adds all 64: each
// direction counts as often as any other (interleaved sampling, Keller and Heidrich 2001).
class TexelOcclusion {
 public:
  static constexpr int kPattern = 8;

  // `mesh` has cells of this side, length units. Rays start three quarters of a cell above the surface, since
  // the mesh does not follow details that are smaller.
  TexelOcclusion(const TriangleMesh& mesh, double cell);

  // Whether the ray of texel (x, y) leaves the body. Directions have the density of the cosine about the
  // normal.
  bool is_open(int x, int y, const Vec3f& place, const Vec3f& normal) const;

 private:
  RayScene scene_;
  float offset_;                   // length units
  std::vector<Vec3f> directions_;  // (kPattern x kPattern) about +z
};

// The share of open rays about each texel, 255 for all, over the covered texels of a square of 8 x 8. `open`
// is 1 where the ray of a texel leaves the body, and kNotCovered where it has none. Both (side x side).
// Charts are 8 texels apart, so that the square holds texels of one chart only.
inline constexpr std::uint8_t kNotCovered = 255;
std::vector<std::uint8_t> blurred_occlusion(std::span<const std::uint8_t> open, int side);

}  // namespace astrolith
