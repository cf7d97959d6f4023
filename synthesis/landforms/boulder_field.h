// The boulders of a layer: placed on the surface that the other layers make, and joined to it as a union.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "numerics/progress.h"
#include "numerics/vec3.h"
#include "recipe/recipe.h"
#include "synthesis/landforms/bare_surface.h"
#include "synthesis/landforms/boulder_shape.h"
#include "synthesis/landforms/population.h"

namespace astrolith {

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
inline double rise_of(const BoulderLayer&) { return 0.0; }

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
// join_boulder of boulder_shape.h, with its bits.
void join_boulder(const BoulderKernel& kernel, int n, const float* x, const float* y, const float* z,
                  float* field);

}  // namespace astrolith
