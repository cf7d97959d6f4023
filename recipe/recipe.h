// The recipe: the contract between fitting and synthesis, and the meaning of the JSON file of the same shape
// (recipe/recipe.schema.json). Plain data; recipe_json.h reads and writes it, and checks every rule stated
// here.
//
// All lengths are in `length_unit`; positions are in the body-fixed frame. No number exceeds kMaxNumber in
// magnitude and "> 0" means at least kMinPositive, which keeps absurd files out; combinations at
// the ends of both ranges can still leave what a float holds.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
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

// m(p) = (sum_i f_i(p)^m)^(1/m),  f_i = exp(a - b |p - c_i|^2 / r_i^2)     (thesis eq. 4.3 to 4.5, per
// sphere) with f_i = 0 beyond cutoff_radii * r_i. The bare body is the set where m(p) >= iso_value. With a =
// b and iso_value = 1 a lone sphere's surface has its own radius.
//
// With a warp, m is taken at p + warp(p) instead of p: low frequencies and high amplitudes make caves,
// tunnels and arches.
struct MetaballBody {
  double a = 1.0;               // tension, > 0
  double b = 1.0;               // tension, > 0
  double blend_exponent = 1.0;  // the thesis's m, > 0; blend_exponent * a <= kMaxKernelExponent
  double iso_value = 1.0;       // the thesis's T, > 0
  double cutoff_radii = 5.0;    // support of each kernel in its own radii, > 1
  std::vector<Sphere> spheres;  // at least one
  std::optional<Warp> warp;
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
  double amplitude = 0.0;     // length units
  double cell_size = 1.0;     // of the first level, length units, > 0
  int levels = 4;             // 1 .. 16
  double probability = 0.05;  // of a cell's value being uniform in [0, 1) instead of zero, [0, 1]
  double threshold = 0.2;     // [0, 1]
  double gain = 0.5;          // [0, 4]
  bool merged = false;        // one image for all levels
};

using Layer = std::variant<FractalLayer, GaborLayer, SpotLayer, CraterLayer, BoulderLayer, SparseLayer>;

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
