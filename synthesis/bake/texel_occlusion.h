// Ambient occlusion of texels, by rays to a mesh of the body.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "numerics/vec3.h"
#include "synthesis/picture/ray_scene.h"

namespace astrolith {

// Sixteen neighbouring texels share 64 directions, four each, and a blur over them adds all 64: each direction
// counts as often as any other (interleaved sampling, Keller and Heidrich 2001).
class TexelOcclusion {
 public:
  static constexpr int kRays = 4, kPattern = 4;

  // `mesh` has cells of this side, length units. Rays start three quarters of a cell above the surface, since
  // the mesh does not follow details that are smaller.
  TexelOcclusion(const TriangleMesh& mesh, double cell);

  // How many of the rays of texel (x, y) leave the body: 0 .. kRays. Directions have the density of the cosine
  // about the normal.
  int open_rays(int x, int y, const Vec3f& place, const Vec3f& normal) const;

 private:
  RayScene scene_;
  float offset_;                    // length units
  std::vector<Vec3f> directions_;   // (16 x kRays) about +z
};

// The share of open rays in each texel, 255 for all: sums over the 4 x 4 texels of the pattern around it that
// are covered. `open` has kNotCovered in the others. Both (side x side).
inline constexpr std::uint8_t kNotCovered = 255;
std::vector<std::uint8_t> blurred_occlusion(std::span<const std::uint8_t> open, int side);

}  // namespace astrolith
