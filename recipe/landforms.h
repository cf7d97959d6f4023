// Features that stand on the surface one by one, listed or drawn: what a recipe says of them.
//
// Shapes are stated as fractions of a feature's own size, so that one profile serves every diameter. Lengths
// are in the recipe's unit. Included by recipe/recipe.h.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "numerics/vec3.h"

namespace astrolith {

inline constexpr int kMaxDrawnFeatures = 1'000'000;  // of one layer

inline constexpr double kMinAxisRatio = 0.05;  // of a boulder's shortest axis to its longest

// Where on the bare body: the point of its surface nearest to a position, or where the ray along a direction
// from the frame's origin leaves the body for the last time.
struct SurfacePlace {
  Vec3d vector;               // length units, or a direction of any length
  bool is_direction = false;  // the zero vector is none
};

// Features drawn uniformly over the area of the bare body, with diameters between two limits and
//   N(> D) ~ D^-exponent.
struct Population {
  std::optional<int> count;        // exactly so many, 0 .. kMaxDrawnFeatures; or
  std::optional<double> density;   // so many on average (Poisson) per squared length unit, >= 0
  double least_diameter = 0.0;     // > 0
  double greatest_diameter = 0.0;  // >= least_diameter
  double exponent = 2.0;           // cumulative, (0, 10]
};

// The relief of a crater over x = distance from its centre / radius, above the surroundings:
//   cavity(x) = depth + rim_height times terraced(1 + sharpness (x^2 - 1)), less depth
//   rim(x)    = rim_height ((extent - x) / (extent - 1))^flank,  0 beyond extent
//   peak(x)   = peak_height (1 - (x / peak_radius)^2)^2,         0 beyond peak_radius
//   height(x) = smooth_max(smooth_min(cavity, rim, k), -depth, k) + peak,     k = smoothing * depth
// A sharpness of 1 is a bowl; above that the floor is flat to x = sqrt(1 - 1 / sharpness). Cavity and rim
// meet at x = 1 at rim_height, which a smooth minimum lowers by k/4.
struct CraterProfile {
  double depth = 0.1;         // of the floor below the surroundings, in diameters, [0, 1]
  double rim_height = 0.036;  // above the surroundings, in diameters, [0, 1]
  double extent = 2.5;        // where the rim's outer flank ends, in radii, [1.05, 10]
  double flank = 3.0;         // how fast it falls, [1, 8]
  double sharpness = 1.0;     // steepness of the walls independent of depth, [1, 100]
  double smoothing = 0.0;     // of the joints, [0, 1]
  double peak_height = 0.0;   // of a central peak above the floor, in diameters, [0, 1]
  double peak_radius = 0.25;  // in radii, [0.01, 1]
  int terraces = 0;           // steps of the wall, 0 .. 16
};

struct Crater {
  SurfacePlace place;
  double diameter = 1.0;             // of the rim's crest, > 0
  std::optional<double> depth;       // length units, >= 0; by the profile when absent
  std::optional<double> rim_height;  // length units, >= 0; by the profile when absent
  double age = 0.0;                  // in any unit, >= 0; of equal ages the later in the list is younger
};

struct CraterPopulation {
  Population drawn;
  double greatest_age = 1.0;  // ages are uniform from 0 to here, >= 0
  double depth_spread = 0.0;  // depths and rims are multiplied by 1 +- this, uniformly, [0, 1]
  double degradation = 0.0;   // and by 1 - this * age / greatest_age, [0, 1]
};

// Craters one by one, from the oldest to the youngest. A crater changes the elevation E made by the layers
// before and by older craters: with x as above and base = E at its centre from what is older and not smaller,
//   E <- base + (E - base) min(x^2, 1) + height(x).
// Within it replaces what it obscures, outside it adds. Craters whose diameter is at least `complex_from`
// have the profile `complex`, others `simple`.
struct CraterLayer {
  std::string name;
  std::optional<int> seed;  // as of all layers, recipe/noise_layers.h
  CraterProfile simple;
  CraterProfile complex{0.06, 0.03, 2.5, 3.0, 1.8, 0.1, 0.03, 0.25, 3};
  std::optional<double> complex_from;  // > 0; all are simple when absent
  std::vector<Crater> craters;
  std::optional<CraterPopulation> population;
};

// An ellipsoid on the surface that all other layers make, its shortest axis along the bare surface's normal
// but for the tilt.
struct Boulder {
  SurfacePlace place;
  Vec3d axes{1, 1, 1};   // full lengths a, b, c, > 0
  double heading = 0.0;  // of axis a on the surface, degrees from east (z x normal) towards north
  double tilt = 0.0;     // of axis c, degrees about axis a
  double burial = 0.3;   // share of its chord along the normal that is below ground, [0, 1]
};

struct BoulderPopulation {
  Population drawn;                 // diameters are the boulders' axes a
  Vec3d axis_ratios{1, 0.71, 0.5};  // a : b : c, each in [0.05, 1]
  double ratio_spread = 0.2;        // b and c are multiplied by 1 +- this, uniformly, [0, 0.9]
  double least_burial = 0.1;        // burials are uniform between two limits, [0, 1]
  double greatest_burial = 0.6;
  double greatest_tilt = 20.0;  // tilts are uniform between +- this, degrees, [0, 90]
};

// Boulders join the body as a smooth union with the joint k = smoothing * (half the shortest axis).
struct BoulderLayer {
  std::string name;
  std::optional<int> seed;  // as of all layers, recipe/noise_layers.h
  double smoothing = 0.0;   // [0, 1]
  double roughness = 0.0;   // amplitude of noise on a boulder, in half its shortest axis, [0, 0.5]
  std::vector<Boulder> boulders;
  std::optional<BoulderPopulation> population;
};

}  // namespace astrolith
