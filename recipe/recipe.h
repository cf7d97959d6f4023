// The recipe: the contract between fitting and synthesis, and the meaning of the JSON file of the same shape
// (recipe/recipe.schema.json). Plain data; recipe_json.h reads and writes it, and checks every rule stated
// here.
//
// All lengths are in `length_unit`; positions are in the body-fixed frame. No number exceeds kMaxNumber in
// magnitude and "> 0" means at least kMinPositive, which keeps absurd files out; combinations at
// the ends of both ranges can still leave what a float holds.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "numerics/vec3.h"
#include "recipe/surface_features.h"

namespace astrolith {

inline constexpr int kRecipeFormatVersion = 1;
inline constexpr double kMaxNumber = 1e12;
inline constexpr double kMinPositive = 1e-12;
inline constexpr double kMaxKernelExponent = 80.0;  // e^80 times a million spheres is still a float
inline constexpr double kMaxTension = 10.0;         // of kernels other than the Gaussian

struct Sphere {
  Vec3d center;
  double radius = 1.0;  // > 0
};

// A displacement of coordinates by three fractal sums of simplex noise, one along each axis (thesis eq. 4.6):
//   warp_k(p) = amplitude * sum_o gain^o simplex_k(lacunarity^o * frequency * p)
struct Warp {
  double amplitude = 0.0;    // length units
  double frequency = 1.0;    // cycles per length unit of the first octave, > 0
  int octaves = 3;           // 1 .. 24; the last octave's frequency is at most kMaxNumber
  double gain = 0.5;         // [0, 4]
  double lacunarity = 1.95;  // (1, 16]
};

// The kernels of thesis 2.1, eq. 2.5 to 2.9.
enum class Kernel { kGaussian, kMetaball, kSoftObject, kWyvill, kCauchy };
inline constexpr Kernel kKernels[] = {Kernel::kGaussian, Kernel::kMetaball, Kernel::kSoftObject,
                                      Kernel::kWyvill, Kernel::kCauchy};

// As recipes and command lines name it.
constexpr std::string_view kernel_word(Kernel kernel) {
  constexpr std::string_view kWords[] = {"gaussian", "metaball", "soft_object", "wyvill", "cauchy"};
  return kWords[static_cast<int>(kernel)];
}

// Spheres, by their place in the body's list, that layers can be tied to.
struct SphereGroup {
  std::string name;
  std::vector<int> spheres;  // at least one, each below the number of spheres and once
};

// How a body is combined with another (thesis 2.2), both by their signed distances f and g, positive inside:
//   union, intersection   (f + g +- sqrt(f^2 + g^2 - 2 alpha f g)) / (1 + alpha)       (R-functions)
//   difference            the intersection of f and -g
//   blend                 (f'^n + g'^n)^(1/n) = 1 with f' = max(0, 1 + f / width)      (super-elliptic)
//   clean union           f + g + sqrt(f^2 + g^2) + a0 / (1 + (f/a1)^2 + (g/a2)^2)     (eq. 2.16, 2.17)
// All but blend and bulge are exact on the surfaces; alpha < 1 rounds the field off them, and so what layers
// build on it.
enum class Operator { kUnion, kIntersection, kDifference, kBlend, kCleanUnion };
inline constexpr Operator kOperators[] = {Operator::kUnion, Operator::kIntersection, Operator::kDifference,
                                          Operator::kBlend, Operator::kCleanUnion};
constexpr std::string_view operator_word(Operator op) {
  constexpr std::string_view kWords[] = {"union", "intersection", "difference", "blend", "clean_union"};
  return kWords[static_cast<int>(op)];
}

struct MetaballBody;
struct BodyOperation {
  Operator kind = Operator::kUnion;
  double alpha = 1.0;                 // of the three R-functions, [-0.9, 1]
  double exponent = 2.0;              // n of the blend, [1, 64]
  double width = 1.0;                 // of the blend, length units, > 0: it ends this far from either body
  double bulge = 0.0;                 // a0 of the clean union, length units; below 0 it carves
  double reach[2] = {1.0, 1.0};       // a1, a2 of the clean union, length units, > 0
  std::vector<MetaballBody> operand;  // exactly one
};
inline constexpr int kMaxOperationDepth = 8;  // of operands within operands
inline constexpr int kMaxOperations = 256;    // in a whole recipe

// m(p) = (sum_i f_i(p)^m)^(1/m),  f_i = exp(a - b |p - c_i|^2 / r_i^2)     (thesis eq. 4.3 to 4.5, per
// sphere) with f_i = 0 beyond cutoff_radii * r_i. The bare body is the set where m(p) >= iso_value. With a =
// b and iso_value = 1 a lone sphere's surface has its own radius.
//
// The other kernels are scaled to the same two values: f_i is e^a at the centre and 1 where |p - c_i|^2 is
// a/b r_i^2. They end continuously: where their own support does or, lowered by what is left there, at
// cutoff_radii, whichever comes first (synthesis/kernel_profile.h). That needs a tension of
// least_tension(body) at least. Their blend is a p-norm with m >= 1.
//
// With a warp, m is taken at p + warp(p) instead of p: low frequencies and high amplitudes make caves,
// tunnels and arches.
struct MetaballBody {
  Kernel kernel = Kernel::kGaussian;
  double a = 1.0;                   // tension, > 0; at most kMaxTension for kernels other than the Gaussian
  double b = 1.0;                   // tension, > 0
  double blend_exponent = 1.0;      // the thesis's m, > 0 or >= 1; blend_exponent * a <= kMaxKernelExponent
  double iso_value = 1.0;           // the thesis's T, > 0
  double cutoff_radii = 5.0;        // support of each kernel in its own radii, > 1
  std::vector<Sphere> spheres;      // at least one
  std::vector<SphereGroup> groups;  // sorted by name, each name once
  std::vector<BodyOperation> operations;  // done to these metaballs, in order
  std::optional<Warp> warp;

  // Null where there is none of that name.
  const SphereGroup* find_group(std::string_view name) const {
    for (const SphereGroup& group : groups) {
      if (group.name == name) return &group;
    }
    return nullptr;
  }
};

// The flattest kernel with its end at cutoff_radii is a parabola: below its tension there is none. Infinite
// where the surface lies beyond the end.
inline double least_tension(const MetaballBody& body) {
  const double surface = body.a / body.b, end = body.cutoff_radii * body.cutoff_radii;
  if (body.kernel == Kernel::kGaussian) return 0.0;
  return surface < end ? -std::log1p(-surface / end) : std::numeric_limits<double>::infinity();
}

// Ties a layer to a group of spheres (thesis 5.1): its heights are multiplied by
//   1/2 - atan((D(p) - E(p)) / width) / pi,
// with D the distance to the nearest surface of the group's spheres, E that to the others'. The weight is 1/2
// where both are equally far, and those of a group and of all other spheres add up to 1.
struct Locality {
  std::string group;  // of the body
  double width =
      1.0;  // length units, > 0: the weight falls from 3/4 to 1/4 where D - E goes from -width to width
};

// What every kind of layer has but explicit craters and boulders, which have places of their own.
struct LayerUse {
  std::optional<Locality> locality;  // absent: the same everywhere
};

// Simplex and Perlin noise lie in [-1, 1]. Worley noise is the distance to the nearest feature point, to the
// second nearest, or their difference, less its mean, in a range of length 1. All have zero mean.
enum class Noise { kSimplex, kPerlin, kWorleyF1, kWorleyF2, kWorleyF2MinusF1 };

inline constexpr bool is_worley(Noise noise) { return noise != Noise::kSimplex && noise != Noise::kPerlin; }

// Fractal sum of noise (thesis algorithms 4 and 5, section 4.3.3):
//   n(p) = amplitude * weight * sum_o gain^o noise_o / (1 + gradient_modulation |D_o|^2),
//   noise_o = noise(lacunarity^o * frequency * q),   q = scale * (p + warp(p)) + bias,
//   D_o = sum_{k <= o} (gain lacunarity)^k grad noise_k, the slope so far over amplitude * frequency.
// A height in length units, added along the outward normal.
struct FractalLayer {
  std::string name;
  LayerUse use;
  Noise noise = Noise::kSimplex;
  double amplitude = 0.0;      // length units
  double frequency = 1.0;      // cycles per length unit of the first octave, > 0
  int octaves = 8;             // 1 .. 24; the last octave's frequency is at most kMaxNumber
  double gain = 0.5;           // [0, 4]
  double lacunarity = 1.95;    // (1, 16]
  Vec3d scale{1.0, 1.0, 1.0};  // of the coordinates
  Vec3d bias{0.0, 0.0, 0.0};   // added after scaling, length units
  double weight = 1.0;
  double gradient_modulation = 0.0;  // >= 0: octaves fade where the sum is steep; 0 for Worley noise
  std::optional<Warp> warp;          // of the coordinates, before scale and bias
};

// One symmetric pair of Gaussians in the power spectrum of a texture.
struct GaborLobe {
  // Spectral standard deviation 2^-bandwidth / (2 sqrt(2 ln 2)) cycles per pixel: the full width at half
  // maximum is 2^-bandwidth. 1 .. 12.
  int bandwidth = 4;
  double frequency_x = 0.0;  // cycles per pixel along a row, [-1/2, 1/2]
  double frequency_y = 0.0;  // cycles per pixel down a column, [-1/2, 1/2]
  double variance = 0.0;     // what this pair adds to the texture's variance, in squared exemplar units, > 0
};

// What a layer paints where a texture has colours: RGB values as stored in the exemplar, full scale = 1,
//   color(p) = sum over the coloured layers of (mean + axis * exemplar_rms * (noise of the layer's lobes,
//   unit variance)).
// Colour never moves a surface: that is height_rms alone.
struct LayerColor {
  Vec3d axis;  // a principal axis of the exemplar's colours, each part in [-1, 1]; (1, 1, 1) is grey
  Vec3d mean;  // what the layer adds everywhere: the first of an exemplar's layers holds its mean colour
};

// Bandwidth-quantised Gabor noise (thesis eq. 5.7 to 5.11) fitted to an exemplar.
// Height of the layer = height_rms * (noise of the lobes, scaled to unit variance), along the outward normal.
struct GaborLayer {
  std::string name;
  LayerUse use;
  double pixel_size = 1.0;       // length units per exemplar pixel, > 0
  double height_rms = 0.0;       // length units, >= 0: brightness is not height, so the user states it
  int impulses_per_kernel = 32;  // expected impulses under one kernel, for each bandwidth, 1 .. 1024
  double exemplar_mean = 0.0;    // of the exemplar's grey values, full scale = 1
  double exemplar_rms = 0.0;     // their standard deviation after the fit's preprocessing
  std::optional<LayerColor> color;
  std::vector<GaborLobe> lobes;  // at least one
};

// Locally controlled spot noise (thesis eq. 5.4 to 5.6): craters, or boulders when inverted.
//   n(p) = -amplitude sum_j gain^j sum_l w_l K(lacunarity^j (p - p_l) / size),      j = 0 .. layers - 1
//   K(q) = gaussian exp(-alpha q.q) + kappa exp(-beta (log(gamma q.q))^2) where q.V^-1 q <= sigma, else 0
// with V diagonal. Impulses p_l lie in a lattice of cells, cell_size / lacunarity^j wide: a cell is occupied
// with `probability`, and then holds a Poisson number of impulses, density_j on average, uniform within
// `reach` cells of it. Weights w_l are uniform in [least_weight, 1]. On a surface the number of spots above a
// size falls as the size to the power -exponent, by density_j = density * lacunarity^(j (exponent - 2)).
struct SpotLayer {
  std::string name;
  LayerUse use;
  double amplitude = 0.0;     // length units
  bool inverted = false;      // without the minus
  double size = 1.0;          // length units to a unit of q, > 0
  double cell_size = 4.0;     // length units, > 0; no half axis of a spot exceeds kMaxSpotCells of it
  double density = 1.0;       // [0, kMaxSpotDensity]; so is that of every j
  double probability = 1.0;   // [0, 1]
  double reach = 0.5;         // cells, [0, 1]
  double least_weight = 0.5;  // [0, 1]
  double gaussian = 1.0;      // weight of the first kernel
  double alpha = 1.0;         // >= 0
  double kappa = 0.0;         // weight of the second kernel, a ring
  double beta = 10.0;         // >= 0; sharpness of the ring
  double gamma = 1.0;         // > 0; the ring lies at |q| = gamma^(-1/2)
  Vec3d variances{1, 1, 1};   // the diagonal of V, > 0
  double sigma = 4.0;         // > 0
  int layers = 1;             // 1 .. 12
  double lacunarity = 2.0;    // (1, 16]
  double gain = 0.5;          // [0, 4]
  double exponent = 2.0;      // [0, 6]
};

inline constexpr double kMaxSpotDensity = 64.0;
inline constexpr double kMaxSpotCells = 4.0;

// Thermal erosion of the finished surface (thesis eq. 5.12): slopes steeper than the talus angle, measured
// against the gravity of a body of uniform density that may turn about +z, slide down until they are not.
struct Erosion {
  double talus_angle = 35.0;     // degrees, [1, 85]
  int iterations = 10000;        // sweeps over the surface at most, 1 .. 100000; ends when all has settled
  double density = 2000.0;       // kg / m^3, [1, 30000]
  double rotation_period = 0.0;  // hours, 0 (at rest) or [0.01, 1e6]
};

// White noise of cells that is mostly zero, upscaled from level to level by quadratic interpolation: round
// pits where cells are not zero, each level's half as wide as the last one's.
//   N_l(p) = upscaled noise of cells cell_size / 2^l wide; a lone value v has its peak v
//   n(p) = -amplitude sum_l gain^l max(N_l - threshold, 0),    l = 0 .. levels - 1
// or, merged, n(p) = -amplitude max(sum_l gain^l N_l - threshold, 0). The threshold cuts a crisp border.
struct SparseLayer {
  std::string name;
  LayerUse use;
  double amplitude = 0.0;     // length units
  double cell_size = 1.0;     // of the first level, length units, > 0
  int levels = 4;             // 1 .. 16
  double probability = 0.05;  // of a cell's value being uniform in [0, 1) instead of zero, [0, 1]
  double threshold = 0.2;     // [0, 1]
  double gain = 0.5;          // [0, 4]
  bool merged = false;        // one image for all levels
};

// Local random phase noise (Gilet et al. 2014; thesis eq. 2.25): in each cell of a lattice a sum of plane
// waves of its own phases, faded into the next cells' by windows. Frequencies are spread evenly from
// frequency_min to frequency_max; the power of a wave goes as its frequency to the power -exponent. A phase
// is the wave's own plus, in every cell, up to half a turn times randomness: at 0 the waves run through all
// cells and make a regular pattern, at 1 nothing but the spectrum is left of it.
struct RandomPhaseLayer {
  std::string name;
  LayerUse use;
  double height_rms = 0.0;     // length units, >= 0: the standard deviation
  double cell_size = 1.0;      // length units, > 0
  int waves = 16;              // 1 .. 128
  double frequency_min = 1.0;  // cycles per length unit, > 0
  double frequency_max = 4.0;  // cycles per length unit, >= frequency_min
  double exponent = 0.0;       // [-8, 8]
  Vec3d direction{0, 0, 1};    // of the waves; not zero
  double spread = 1.0;         // [0, 1]: directions have a cosine with it of at least 1 - spread
  double randomness = 1.0;     // [0, 1]
};

// What a phasor layer draws over a turn of the phase, between -1 and 1.
enum class PhasorProfile { kSine, kTriangle, kSawtooth, kSquare };
inline constexpr PhasorProfile kPhasorProfiles[] = {PhasorProfile::kSine, PhasorProfile::kTriangle,
                                                    PhasorProfile::kSawtooth, PhasorProfile::kSquare};
constexpr std::string_view profile_word(PhasorProfile profile) {
  constexpr std::string_view kWords[] = {"sine", "triangle", "sawtooth", "square"};
  return kWords[static_cast<int>(profile)];
}

// Phasor noise (Tricard et al. 2019; thesis eq. 2.27 to 2.30): the phase of a sum of Gabor kernels, drawn by
// a profile. Stripes, ridges, hatches and ripples whose contrast never fades.
struct PhasorLayer {
  std::string name;
  LayerUse use;
  double amplitude = 0.0;     // length units
  double frequency = 1.0;     // cycles per length unit, > 0
  double cell_size = 1.0;     // reach of a kernel, length units, > 0; frequency * cell_size is at most 1024
  int impulses_per_cell = 2;  // 1 .. 16
  Vec3d direction{1, 0, 0};   // across the stripes; not zero
  double spread = 0.1;        // [0, 1]: directions have a cosine with it of at least 1 - spread
  PhasorProfile profile = PhasorProfile::kSine;
};
inline constexpr double kMaxPhasorTurns = 1024.0;

using Layer = std::variant<FractalLayer, GaborLayer, SpotLayer, CraterLayer, BoulderLayer, SparseLayer,
                           RandomPhaseLayer, PhasorLayer>;

// Null for the kinds that have none.
inline LayerUse* use_of(Layer& layer) {
  return std::visit(
      [](auto& l) -> LayerUse* {
        if constexpr (requires { l.use; }) {
          return &l.use;
        } else {
          return nullptr;
        }
      },
      layer);
}
inline const LayerUse* use_of(const Layer& layer) { return use_of(const_cast<Layer&>(layer)); }

// Where a recipe came from.
struct Provenance {
  std::string tool;                                          // "fit_shape 0.1.0"
  std::string input_name;                                    // file name without folders
  std::string input_sha256;                                  // 64 hexadecimal digits, or empty
  std::vector<std::pair<std::string, std::string>> options;  // as given, sorted by name
  std::vector<std::pair<std::string, double>> achieved;      // errors reached, sorted by name
};

struct Recipe {
  int format_version = kRecipeFormatVersion;
  std::string description;         // for people
  std::string length_unit = "km";  // "m", "km" or "px" (a texture without a physical scale)
  std::string frame = "body-fixed, right-handed, +z spin pole, +x prime meridian";
  std::uint64_t seed = 1;  // below 2^53, so that every JSON reader keeps it exact
  Provenance provenance;
  std::optional<MetaballBody> body;  // absent in what fit_gabor writes
  std::vector<Layer> layers;
  std::optional<Erosion> erosion;  // of a body with its layers
};

}  // namespace astrolith
