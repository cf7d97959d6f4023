// Landforms of a recipe: craters and boulders that are listed one by one or drawn at random.
//
// Shapes are stated as fractions of a landform's own size, so that one profile serves every diameter. Lengths
// are in the recipe's `length_unit`. Include recipe/recipe.h, which includes this file.
#pragma once

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "numerics/vec3.h"
#include "recipe/noise_layers.h"

namespace astrolith {

inline constexpr int kMaxDrawnLandforms = 1'000'000;  // the most landforms that one layer draws

inline constexpr double kMinAxisRatio = 0.05;  // the least ratio of a boulder's shortest axis to its longest

// A place on the bare body. A position means the nearest point of the surface. A direction means the point
// where the ray from the frame's origin leaves the body for the last time.
struct SurfacePlace {
  Vec3d vector;  // a position in length units, or a direction of any length but 0
  bool is_direction = false;
};

// Sizes by Weibull's law: the number above a diameter D falls as
//   N(> D) ~ exp(-(D / scale)^shape)
// Counts of boulders below some metres follow it where a power law fails (Pajola et al. 2024, Dimorphos).
struct WeibullSizes {
  double scale = 1.0;  // length units, > 0
  double shape = 1.0;  // [0.05, 10]
};

// Landforms in clusters (a Thomas process): a cluster's landforms lie about its centre, normally distributed
// along both tangents. The centres are uniform over the area of the bare body.
struct Clusters {
  int number = 10;      // of clusters on the body, 1 .. kMaxClusters
  double radius = 1.0;  // standard deviation along each tangent, length units, > 0
  double share = 1.0;   // of the landforms that lie in clusters, [0, 1]; the others lie anywhere
};
inline constexpr int kMaxClusters = 100'000;

// Landforms drawn over the area of the bare body: uniformly, or with a weight in [0, 1] that varies over it.
// The number above a diameter D falls as
//   N(> D) ~ D^-exponent
// or by Weibull's law, between two limits. A population has either a count or a density. A count is exact
// whatever the weight. A density is the density where the weight is 1.
struct Population {
  std::optional<int> count;        // exact number, 0 .. kMaxDrawnLandforms
  std::optional<double> density;   // mean of a Poisson number, per squared length unit, >= 0
  double least_diameter = 0.0;     // > 0
  double greatest_diameter = 0.0;  // >= least_diameter
  double exponent = 2.0;           // [0.01, 10]
  std::optional<WeibullSizes> weibull = std::nullopt;  // in place of the power law
  std::optional<Clusters> clusters = std::nullopt;     // absent: places are independent of each other
  std::optional<Locality> locality = std::nullopt;     // a factor of the weight
  std::optional<LayerMask> mask = std::nullopt;        // a factor of the weight, by an earlier layer's height
  // Whether landforms are drawn cell by cell of space, so that a patch draws only those that reach it. The
  // population then has a density and no clusters, and its sizes may reach far below what a whole body can
  // hold.
  bool by_cells = false;

  // Multiplies all lengths by the ratio.
  void rescale(double ratio) {
    least_diameter *= ratio;
    greatest_diameter *= ratio;
    if (density) *density /= ratio * ratio;
    if (weibull) weibull->scale *= ratio;
    if (clusters) clusters->radius *= ratio;
    if (locality) locality->width *= ratio;
    if (mask) mask->rescale(ratio);
  }
};

// The relief of a crater over x = distance from its centre / radius, above the surroundings:
//   cavity(x) = depth + rim_height times terraced(1 + sharpness (x^2 - 1)), less depth
//   rim(x)    = rim_height ((extent - x) / (extent - 1))^flank,  0 beyond extent
//   peak(x)   = peak_height (1 - (x / peak_radius)^2)^2,         0 beyond peak_radius
//   height(x) = smooth_max(smooth_min(cavity, rim, k), -depth, k) + peak,     k = smoothing * depth
// A sharpness of 1 is a bowl. With a larger sharpness the floor is flat to x = sqrt(1 - 1 / sharpness).
// Cavity and rim meet at x = 1 at rim_height, and a smooth minimum lowers the crest by k/4.
struct CraterProfile {
  double depth = 0.1;         // floor below the surroundings, in diameters, [0, 1]
  double rim_height = 0.036;  // crest above the surroundings, in diameters, [0, 1]
  double extent = 2.5;        // end of the rim's outer flank, in radii, [1.05, 10]
  double flank = 3.0;         // exponent of the flank's fall, [1, 8]
  double sharpness = 1.0;     // steepness of the walls independent of depth, [1, 100]
  double smoothing = 0.0;     // width of the joints, in depths, [0, 1]
  double peak_height = 0.0;   // central peak above the floor, in diameters, [0, 1]
  double peak_radius = 0.25;  // radius of the central peak, in radii, [0.01, 1]
  int terraces = 0;           // steps of the wall, 0 .. 16
};

struct Crater {
  SurfacePlace place;
  double diameter = 1.0;             // of the rim's crest, length units, > 0
  std::optional<double> depth;       // length units, 0 .. diameter; absent: the profile's
  std::optional<double> rim_height;  // length units, 0 .. diameter; absent: the profile's
  double age = 0.0;                  // any unit, >= 0; with equal ages the later in the list is younger
};

struct CraterPopulation {
  Population drawn;
  double greatest_age = 1.0;  // ages are uniform in [0, greatest_age]; >= 0
  double depth_spread = 0.0;  // a uniform factor of depth and rim in 1 +- depth_spread; [0, 1]
  double degradation = 0.0;   // a factor of depth and rim, 1 - degradation * age / greatest_age; [0, 1]
  // Standard deviation of a normal factor of depth and rim, whose mean is 1. The factor is cut at three
  // deviations and at 0.1; [0, 1]
  double depth_deviation = 0.0;
};

// Craters, added one by one from the oldest to the youngest. A crater changes the elevation E that earlier
// layers and older craters made. With x as above, and base = E at the crater's centre due to earlier layers
// and to older craters that are not smaller,
//   E <- base + (E - base) min(x^2, 1) + height(x).
// The crater replaces the elevation within its rim and adds to the elevation outside. A crater whose diameter
// is at least `complex_from` has the profile `complex`, and a smaller one has `simple`.
struct CraterLayer {
  static constexpr std::string_view kType = "craters";
  static constexpr LayerTraits kTraits = kLandforms;

  std::string name;
  std::optional<int> seed;  // a LayerSeed, recipe/noise_layers.h
  CraterProfile simple;
  CraterProfile complex{0.06, 0.03, 2.5, 3.0, 1.8, 0.1, 0.03, 0.25, 3};
  std::optional<double> complex_from;  // length units, > 0; absent: all craters are simple
  std::vector<Crater> craters;
  std::optional<CraterPopulation> population;
  std::optional<CraterAlbedo> albedo;  // absent: craters show the ground's

  StatedHeight stated_height() const { return {craters.empty() ? "population" : "craters", 0.0}; }
  // The size of the smallest crater that the layer lists, length units.
  double least_listed() const {
    double least = std::numeric_limits<double>::infinity();
    for (const Crater& crater : craters) least = std::min(least, crater.diameter);
    return least;
  }
  // Multiplies all lengths by the ratio.
  void rescale(double ratio) {
    if (complex_from) *complex_from *= ratio;
    for (Crater& crater : craters) {
      crater.place.vector *= ratio;
      crater.diameter *= ratio;
      if (crater.depth) *crater.depth *= ratio;
      if (crater.rim_height) *crater.rim_height *= ratio;
    }
    if (population) population->drawn.rescale(ratio);
  }
};
void visit_fields(FieldVisitor& v, CraterLayer& layer);

// An ellipsoid on the surface that all other layers make. Without a tilt, its axis c is upright: it lies
// along the normal of the bare surface or, in a layer with gravity, along the local vertical.
struct Boulder {
  SurfacePlace place;
  Vec3d axes{1, 1, 1};   // full lengths a, b, c, length units, > 0; none below kMinAxisRatio of the longest
  double heading = 0.0;  // of axis a, degrees from east (z x upright) to north, [-360, 360]
  double tilt = 0.0;     // of axis c about axis a, degrees, [-180, 180]
  double burial = 0.3;   // share of the upright chord that lies below the surface, [0, 1]
};

// The local vertical is against the body's own attraction and the centrifugal force. The bare body has a
// uniform density and may turn about +z through its centre of mass.
struct LocalGravity {
  double density = 2000.0;       // kg / m^3, [1, 30000]
  double rotation_period = 0.0;  // hours, [0.01, 1e6], or 0 for a body at rest
};

struct BoulderPopulation {
  Population drawn;                 // diameters are the boulders' axes a
  Vec3d axis_ratios{1, 0.71, 0.5};  // a : b : c, each in [kMinAxisRatio, 1]
  double ratio_spread = 0.2;        // a uniform factor of b and of c in 1 +- ratio_spread; [0, 0.9]
  double least_burial = 0.1;        // burials are uniform in [least_burial, greatest_burial]; [0, 1]
  double greatest_burial = 0.6;     // least_burial .. 1
  double greatest_tilt = 20.0;      // tilts are uniform within +- greatest_tilt; degrees, [0, 90]
};

// Boulders join the body as a smooth union with the joint k = smoothing * (half the shortest axis).
struct BoulderLayer {
  static constexpr std::string_view kType = "boulders";
  static constexpr LayerTraits kTraits = kLandforms;

  std::string name;
  std::optional<int> seed;  // a LayerSeed, recipe/noise_layers.h
  double smoothing = 0.1;   // width of the joint, in half the shortest axis, [0, 1]
  double roughness = 0.1;   // amplitude of noise on a boulder, in half its shortest axis, [0, 0.5]
  // How far facets cut into the ellipsoids: 0, not at all; 1, to three fifths of the radius. [0, 1]
  double angularity = 0.8;
  std::vector<Boulder> boulders;
  std::optional<BoulderPopulation> population;
  std::optional<LocalGravity> gravity;  // absent: boulders stand along the normal
  std::optional<BoulderAlbedo> albedo;  // absent: boulders show the ground's

  StatedHeight stated_height() const { return {boulders.empty() ? "population" : "boulders", 0.0}; }
  // The size of the smallest boulder that the layer lists, length units.
  double least_listed() const {
    double least = std::numeric_limits<double>::infinity();
    for (const Boulder& boulder : boulders) least = std::min(least, boulder.axes.x);
    return least;
  }
  // Multiplies all lengths by the ratio.
  void rescale(double ratio) {
    for (Boulder& boulder : boulders) {
      boulder.place.vector *= ratio;
      boulder.axes *= ratio;
    }
    if (population) population->drawn.rescale(ratio);
  }
};
void visit_fields(FieldVisitor& v, BoulderLayer& layer);

}  // namespace astrolith
