// Layers of noise in a recipe: heights that are the same rule everywhere, not features one by one. Lengths
// are in the recipe's unit. Included by recipe/recipe.h.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "numerics/vec3.h"
#include "recipe/body.h"

namespace astrolith {

// Ties a layer to a group of spheres (thesis 5.1): its heights are multiplied by
//   1/2 - atan((D(p) - E(p)) / width) / pi,
// with D the distance to the nearest surface of the group's spheres, E that to the others'. The weight is 1/2
// where both are equally far, and those of a group and of all other spheres add up to 1.
struct Locality {
  std::string group;  // of the body
  double width =
      1.0;  // length units, > 0: the weight falls from 3/4 to 1/4 where D - E goes from -width to width
};

// How a layer's height h, times its weight w, changes the elevation E that the layers before it made:
//   add      E + w h
//   replace  E + w (h - E)
//   blend    E + w (U - E),  U = max(E, h) + (sqrt((E - h)^2 + width^2) - |E - h|) / 2
//   warp     not at all: layers of noise after it are taken at p + w h direction instead of p
//   mask     not at all: it is there for the masks of layers after it
// U is the union of thesis 2.2 (an R-function with alpha = 1) of the surfaces at both heights, its joint
// rounded over about `width`; an intersection is -U of -E and -h. Gabor layers are bound to the surface: none
// stands after a warp.
enum class Combine { kAdd, kReplace, kBlend, kWarp, kMask };
inline constexpr Combine kCombines[] = {Combine::kAdd, Combine::kReplace, Combine::kBlend, Combine::kWarp,
                                        Combine::kMask};
constexpr std::string_view combine_word(Combine combine) {
  constexpr std::string_view kWords[] = {"add", "replace", "blend", "warp", "mask"};
  return kWords[static_cast<int>(combine)];
}
struct Combination {
  Combine kind = Combine::kAdd;
  double width = 0.0;         // of a blend, length units, >= 0
  bool intersection = false;  // of a blend
  Vec3d direction;            // of a warp: displacement a unit of height
};

// Multiplies a layer's weight by t^2 (3 - 2 t), t = (n - from) / (to - from) within [0, 1], where n is the
// height of another layer.
struct LayerMask {
  std::string layer;  // the last of this name before; not craters or boulders
  double from = 0.0;  // length units
  double to = 1.0;    // length units; may lie below `from`, but not within a millionth of it
};

// What every kind of layer has but explicit craters and boulders, which have places of their own.
struct LayerUse {
  std::optional<Locality> locality;  // absent: the same everywhere
  std::optional<LayerMask> mask;     // absent: none
  Combination combination;
};

// Instead of a layer's place in the list, in what its random numbers depend on: with one of its own a layer
// stays as it is wherever it moves. Layers of one kind and one seed draw the same numbers.
using LayerSeed = std::optional<int>;  // 0 .. kMaxLayerSeed
inline constexpr int kMaxLayerSeed = (1 << 30) - 1;

// What a layer's random numbers depend on beside the recipe's seed: its own, or its place in the list, which
// is below kMaxLayerSeed.
constexpr int layer_number(const LayerSeed& seed, int index) {
  return seed ? kMaxLayerSeed + 1 + *seed : index;
}

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
  LayerSeed seed;
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
  LayerSeed seed;
  LayerUse use;
  double pixel_size = 1.0;       // length units per exemplar pixel, > 0
  double height_rms = 0.0;       // length units, >= 0: brightness is not height, so the user states it
  int impulses_per_kernel = 32;  // expected impulses under one kernel, for each bandwidth, 1 .. 1024
  double exemplar_mean = 0.0;    // of the exemplar's grey values, full scale = 1
  double exemplar_rms = 0.0;     // their standard deviation after the fit's preprocessing
  std::optional<LayerColor> color;
  std::vector<GaborLobe> lobes;  // at least one
};

// One of the ellipsoids that a spot is made of (thesis eq. 5.3): adds
//   weight K(diag(axes)^-1 R^-1 (q - center)),   R the turns about x, then y, then z.
struct SpotPart {
  Vec3d center;         // units of q
  Vec3d axes{1, 1, 1};  // kLeastSpotAxis .. 1 / kLeastSpotAxis
  Vec3d turn;           // degrees
  double weight = 1.0;
};
inline constexpr double kLeastSpotAxis = 0.01;
inline constexpr int kMaxSpotParts = 16;

// The edges of a lattice's cells, in sides of a cube: each of length kLeastCellHeight to kLongestCellEdge, no
// two opposite faces nearer than kLeastCellHeight.
struct CellEdges {
  Vec3d a{1, 0, 0}, b{0, 1, 0}, c{0, 0, 1};
};
inline constexpr double kLeastCellHeight = 0.4, kLongestCellEdge = 2.0;
// The least distance of two opposite faces of a cell; 0 of a flat one.
inline double least_height(const CellEdges& e) {
  const double volume = std::fabs(dot(e.a, cross(e.b, e.c)));
  return volume > 0.0
             ? volume / std::max({norm(cross(e.b, e.c)), norm(cross(e.c, e.a)), norm(cross(e.a, e.b))})
             : 0.0;
}

// Locally controlled spot noise (thesis eq. 5.3 to 5.6): craters, or boulders when inverted.
//   n(p) = -amplitude sum_j gain^j sum_l w_l K(lacunarity^j (p - p_l) / size),      j = 0 .. layers - 1
//   K(q) = gaussian exp(-alpha q.q) + kappa exp(-beta (log(gamma q.q))^2) where q.V^-1 q <= sigma, else 0
// with V diagonal; where there are parts, the sum of what they make of K stands for it. Impulses p_l lie in a
// lattice of cells, cell_size / lacunarity^j wide: a cell is occupied with `probability`, and then holds a
// Poisson number of impulses, density_j on average, or with `even` as many in each, uniform within `reach`
// cells of it. Weights w_l are uniform in [least_weight, 1]. On a surface the number of spots above a
// size falls as the size to the power -exponent, by density_j = density * lacunarity^(j (exponent - 2)).
struct SpotLayer {
  std::string name;
  LayerSeed seed;
  LayerUse use;
  double amplitude = 0.0;  // length units
  bool inverted = false;   // without the minus
  double size = 1.0;       // length units to a unit of q, > 0
  double cell_size = 4.0;  // length units, > 0; no spot reaches further than kMaxSpotCells heights of a cell
  CellEdges lattice;
  double density = 1.0;       // [0, kMaxSpotDensity]; so is that of every j
  double probability = 1.0;   // [0, 1]
  bool even = false;          // an occupied cell has density_j impulses; a fraction is the chance of one more
  double reach = 0.5;         // cells, [-1/2, 1]; at -1/2 impulses lie in the middle of their cells
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
  std::vector<SpotPart> parts;  // none: K itself
};

// How far a spot reaches from its impulse, in units of q.
inline double spot_extent(const SpotLayer& layer, const SpotPart& part) {
  const Vec3d &v = layer.variances, &a = part.axes;
  const Vec3d half{a.x * std::sqrt(v.x), a.y * std::sqrt(v.y), a.z * std::sqrt(v.z)};
  return norm(part.center) + std::sqrt(layer.sigma) * std::max({half.x, half.y, half.z});
}

inline constexpr double kMaxSpotDensity = 64.0;
inline constexpr double kMaxSpotCells = 4.0;

// White noise of cells that is mostly zero, upscaled from level to level by quadratic interpolation: round
// pits where cells are not zero, each level's half as wide as the last one's.
//   N_l(p) = upscaled noise of cells cell_size / 2^l wide; a lone value v has its peak v
//   n(p) = -amplitude sum_l gain^l max(N_l - threshold, 0),    l = 0 .. levels - 1
// or, merged, n(p) = -amplitude max(sum_l gain^l N_l - threshold, 0). The threshold cuts a crisp border.
struct SparseLayer {
  std::string name;
  LayerSeed seed;
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
  LayerSeed seed;
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
  LayerSeed seed;
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

}  // namespace astrolith
