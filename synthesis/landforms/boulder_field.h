// The boulders of a layer: placed on the surface that the other layers make, and joined to it as a union.
// A boulder is a signed distance to first order.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "numerics/host_device.h"
#include "numerics/progress.h"
#include "numerics/scalar_math.h"
#include "numerics/vec3.h"
#include "recipe/recipe.h"
#include "synthesis/landforms/bare_surface.h"
#include "synthesis/landforms/crater_profile.h"
#include "synthesis/landforms/population.h"
#include "synthesis/noise/simplex_noise.h"

namespace astrolith {

// A boulder with the constants that its evaluation needs: an ellipsoid with facets and noise.
struct BoulderKernel {
  Vec3f center;         // length units
  Vec3f across[3];      // unit vectors along the axes, each divided by half the axis' length, per length unit
  Vec3f inverse_half;   // 1 / half the length of each axis, per length unit
  float floor;          // added to |grad|, which keeps the distance finite at the centre, per length unit
  float smoothing;      // k of the union, length units
  float roughness;      // amplitude of the noise, length units
  std::uint32_t seed;   // seed of the noise
  float reach_squared;  // |u|^2 beyond which the boulder changes nothing, in half axes
  float facet_step;  // what a step of a facet's depth adds to 1 / its distance from the centre; 0: no facets
  Vec3f facet_axes[3];            // orthonormal: the frame of the facets in half axes
  std::uint32_t facet_depths[2];  // 3 bits for each of ten directions, and for their opposites
};

// The coordinates u of a point along the boulder's axes, in half axes: |u| = 1 on the ellipsoid.
ASTROLITH_KERNEL Vec3f boulder_coordinates(const BoulderKernel& b, float x, float y, float z) {
  const float dx = x - b.center.x, dy = y - b.center.y, dz = z - b.center.z;
  const auto along = [&](const Vec3f& a) { return math::fma(a.x, dx, math::fma(a.y, dy, a.z * dz)); };
  return {along(b.across[0]), along(b.across[1]), along(b.across[2])};
}

ASTROLITH_KERNEL float squared_length(float x, float y, float z) {
  return math::fma(x, x, math::fma(y, y, z * z));
}

// max(|u|, n u / d) over twenty facets with normals n at distances d <= 1 from the centre, in half axes. It
// is 1 on the surface of the ellipsoid that the facets cut. The normals are those of a dodecahedron and an
// octahedron, turned at random; facets whose depth is 0 only touch the ellipsoid.
ASTROLITH_KERNEL float faceted_length(const BoulderKernel& b, const Vec3f& u, float length) {
  constexpr float kShort = 0.525731112f, kLong = 0.850650808f, kDiagonal = 0.577350269f;
  const auto along = [&](const Vec3f& a) { return math::fma(a.x, u.x, math::fma(a.y, u.y, a.z * u.z)); };
  const float x = along(b.facet_axes[0]), y = along(b.facet_axes[1]), z = along(b.facet_axes[2]);
  float most = length;
  const auto cut = [&](float at, int direction) {
    const std::uint32_t depths = at > 0.0f ? b.facet_depths[0] : b.facet_depths[1];
    const auto depth = static_cast<float>(static_cast<std::int32_t>(depths >> (3 * direction) & 7u));
    most = math::max(most, math::abs(at) * math::fma(b.facet_step, depth, 1.0f));
  };
  cut(math::fma(kShort, y, kLong * z), 0), cut(math::fma(kShort, y, -kLong * z), 1);
  cut(math::fma(kShort, z, kLong * x), 2), cut(math::fma(kShort, z, -kLong * x), 3);
  cut(math::fma(kShort, x, kLong * y), 4), cut(math::fma(kShort, x, -kLong * y), 5);
  cut(kDiagonal * (x + y + z), 6), cut(kDiagonal * (x + y - z), 7);
  cut(kDiagonal * (x - y + z), 8), cut(kDiagonal * (y + z - x), 9);
  return most;
}

// Two octaves of simplex noise, in [-1, 1]. The features are about as wide as a half axis.
ASTROLITH_KERNEL float boulder_noise(const Vec3f& u, std::uint32_t seed) {
  const float wide = simplex_noise(1.2f * u.x, 1.2f * u.y, 1.2f * u.z, seed);
  const float narrow = simplex_noise(2.9f * u.x, 2.9f * u.y, 2.9f * u.z, seed + 1u);
  return math::fma(0.4f, narrow, wide) * (1.0f / 1.4f);
}

// The distance to the boulder's surface to first order, positive inside, length units:
// (1 - g) / |grad |u|| + roughness * noise(u), where g is |u|, or with facets their faceted_length().
ASTROLITH_KERNEL float boulder_distance(const BoulderKernel& b, const Vec3f& u) {
  const float length = math::sqrt(squared_length(u.x, u.y, u.z)) + 1e-6f;
  const float slope =
      math::sqrt(squared_length(u.x * b.inverse_half.x, u.y * b.inverse_half.y, u.z * b.inverse_half.z)) +
      b.floor;
  const float cut = b.facet_step > 0.0f ? faceted_length(b, u, length) : length;
  const float smooth = (1.0f - cut) * (length / slope);
  return b.roughness > 0.0f ? math::fma(b.roughness, boulder_noise(u, b.seed), smooth) : smooth;
}

// Whether the boulder changes F at a point.
ASTROLITH_KERNEL bool is_within_reach(const BoulderKernel& b, float x, float y, float z) {
  const Vec3f u = boulder_coordinates(b, x, y, z);
  return squared_length(u.x, u.y, u.z) < b.reach_squared;
}

// F of the union of the body, with F = `field` at the point, and the boulder.
ASTROLITH_KERNEL float join_boulder(const BoulderKernel& b, float x, float y, float z, float field) {
  const Vec3f u = boulder_coordinates(b, x, y, z);
  const float together = smooth_max(field, boulder_distance(b, u), b.smoothing);
  return squared_length(u.x, u.y, u.z) < b.reach_squared ? together : field;
}

// A boulder as it lies on a body; lengths in the recipe's unit, angles in degrees.
struct PlacedBoulder {
  Vec3d center;
  Vec3d directions[3];  // unit vectors along the axes
  Vec3d axes;           // full lengths
  double heading = 0.0, tilt = 0.0, burial = 0.0;
  std::uint32_t noise_seed = 0;
};

struct LayerBoulders {
  int layer = 0;  // number in the recipe
  std::vector<PlacedBoulder> boulders;
};

// The surface without boulders.
struct Terrain {
  std::function<double(const Vec3d&)> field;  // F, length units
  double height_bound = 0.0;                  // bound of its distance from the bare surface, length units
};

// The layer's listed boulders, then its drawn ones. Throws InputError, naming `where` in the recipe, for a
// boulder that has no place on the body or is longer than it, and WorkError where progress asks to stop. The
// result is empty for a body without a surface. `places` says where drawn boulders may lie.
std::vector<PlacedBoulder> place_boulders(const BoulderLayer& layer, const BareSurface& surface,
                                          const Terrain& terrain, std::uint64_t seed, int layer_index,
                                          const std::string& where, const Progress& progress = {},
                                          const DrawingPlaces& places = {});

// How far from its place a drawn boulder may change the surface, in its diameters. Craters of a layer reach
// no farther than the elevations that they make.
double drawn_reach(const BoulderLayer& layer);
inline double drawn_reach(const CraterLayer&) { return 0.0; }
// A bound of what the layer's boulders add to elevations, on which they lie; length units.
inline double largest_rise(const BoulderLayer&) { return 0.0; }

// A boulder as it joins a field, and the box that it reaches. Outside the box it changes nothing.
struct FieldBoulder {
  BoulderKernel kernel;
  Box box;                // in the body's frame
  bool in_patch = false;  // whether the kernel is relative to the centre of a patch
};
std::vector<FieldBoulder> field_boulders(const BoulderLayer& layer, std::span<const PlacedBoulder> boulders);

// Whether the boulder may change F at a point.
ASTROLITH_HD inline bool boulder_reaches(const FieldBoulder& boulder, float x, float y, float z) {
  const Vec3d p{double{x}, double{y}, double{z}};
  return boxes_touch(boulder.box, {p, p});
}

// Replaces field[i], F at point i, by F of the union with one boulder, for n points: the vectorised
// join_boulder(), with its bits.
void join_boulder(const BoulderKernel& kernel, int n, const float* x, const float* y, const float* z,
                  float* field);

}  // namespace astrolith
