// Layers of noise in a recipe: heights that follow one rule everywhere. Lengths are in the recipe's
// `length_unit`. Include recipe/recipe.h, which includes this file.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "numerics/vec3.h"
#include "recipe/albedo.h"
#include "recipe/body.h"
#include "recipe/exemplar_image.h"
#include "recipe/layer_traits.h"

namespace astrolith {

// Ties a layer to a group of spheres (thesis 5.1): its heights are multiplied by
//   1/2 - atan((D(p) - E(p)) / width) / pi,
// with D the distance to the nearest surface of the group's spheres and E the distance to the nearest surface
// of all other spheres. The weight is 1/2 where D = E. The weight for a group and the weight for all other
// spheres add up to 1.
struct Locality {
  std::string group;   // a name in MetaballBody::groups
  double width = 1.0;  // length units, > 0: the weight is 3/4 at D - E = -width and 1/4 at D - E = width
};

// How a layer's height h, times its weight w, changes the elevation E that the layers before it made:
//   add      E + w h
//   replace  E + w (h - E)
//   blend    E + w (U - E),  U = max(E, h) + (sqrt((E - h)^2 + width^2) - |E - h|) / 2
//   warp     E: later layers of noise are evaluated at p + w h direction instead of p
//   mask     E: the layer only serves the masks of later layers
// U is the union of thesis 2.2 (an R-function with alpha = 1) of the surfaces at both heights, and its joint
// is rounded over about `width`. An intersection is -U of -E and -h. Gabor layers are bound to the surface
// and cannot stand after a warp.
enum class Combine { kAdd, kReplace, kBlend, kWarp, kMask };
inline constexpr Combine kCombines[] = {Combine::kAdd, Combine::kReplace, Combine::kBlend, Combine::kWarp,
                                        Combine::kMask};
constexpr std::string_view combine_word(Combine combine) {
  constexpr std::string_view kWords[] = {"add", "replace", "blend", "warp", "mask"};
  return kWords[static_cast<int>(combine)];
}
struct Combination {
  Combine kind = Combine::kAdd;
  double width = 0.0;         // blend only: width of the joint, length units, >= 0
  bool intersection = false;  // blend only: instead of a union
  Vec3d direction;            // warp only: displacement per unit of height
};

// Multiplies a layer's weight by t^2 (3 - 2 t), t = (n - from) / (to - from) within [0, 1], where n is the
// height of another layer. With `over`, n is the roughness of those heights over a distance: the root mean
// square of what the height at a place differs from the mean of two opposite heights at that distance
// (synthesis/landforms/ground_roughness.h). Only populations can have it.
struct LayerMask {
  std::string layer;  // name of an earlier layer of noise; if several have the name, the last of them
  double from = 0.0;  // length units
  double to = 1.0;    // length units; may lie below `from`, but differs by more than a millionth
  std::optional<double> over = std::nullopt;  // length units, > 0

  // Multiplies heights, or all lengths, by the ratio.
  void rescale_heights(double ratio) {
    from *= ratio;
    to *= ratio;
  }
  void rescale(double ratio) {
    rescale_heights(ratio);
    if (over) *over *= ratio;
  }
};

// How a layer of noise acts on the surface. Craters and boulders have places of their own instead.
struct LayerUse {
  std::optional<Locality> locality;  // absent: the layer acts everywhere
  std::optional<LayerMask> mask;     // absent: no other layer weights it
  Combination combination;
  std::optional<LayerAlbedo> albedo;  // absent: the ground keeps its own
};

// A seed, 0 .. kMaxLayerSeed, that replaces the layer's place in the list for its random numbers. A layer
// with a seed keeps its shape wherever it stands in the list. Two layers of one kind with one seed draw equal
// numbers.
using LayerSeed = std::optional<int>;
inline constexpr int kMaxLayerSeed = (1 << 30) - 1;

// The number that a layer's random numbers depend on beside the recipe's seed. `index` is that of the
// layer in the list, below kMaxLayerSeed. Layers with and without a seed have different numbers.
constexpr int layer_number(const LayerSeed& seed, int index) {
  return seed ? kMaxLayerSeed + 1 + *seed : index;
}

// The field of a layer that states how high it is, for messages, and its value. Kinds without a
// stated_height() have a field `amplitude` or `height_rms` instead.
struct StatedHeight {
  std::string_view name;
  double height;  // length units
};

// Simplex and Perlin noise lie in [-1, 1]. Worley noise is the distance to the nearest feature point (F1), to
// the second nearest (F2) or the difference of both, less its mean, and spans a range of length 1. Each of
// these has zero mean. Blocks around feature points are 0 outside and 1 in their middle (block_noise.h).
enum class Noise { kSimplex, kPerlin, kWorleyF1, kWorleyF2, kWorleyF2MinusF1, kWorleyBlocks };

inline constexpr bool is_worley(Noise noise) { return noise != Noise::kSimplex && noise != Noise::kPerlin; }

// Fractal sum of noise (thesis algorithms 4 and 5, section 4.3.3):
//   n(p) = amplitude * weight * sum_o gain^o noise_o / (1 + gradient_modulation |D_o|^2),
//   noise_o = noise(lacunarity^o * frequency * q),   q = scale * (p + warp(p)) + bias,
//   D_o = sum_{k <= o} (gain lacunarity)^k grad noise_k, the slope so far over amplitude * frequency.
// n is a height in length units along the outward normal.
struct FractalLayer {
  static constexpr LayerTraits kTraits = kNoiseInSpace;

  std::string name;
  LayerSeed seed;
  LayerUse use;
  Noise noise = Noise::kSimplex;
  double amplitude = 0.0;      // length units
  double frequency = 1.0;      // cycles per length unit of the first octave, > 0
  int octaves = 8;             // 1 .. 24; the last octave's frequency is at most kMaxNumber
  double gain = 0.5;           // [0, 4]
  double lacunarity = 1.95;    // (1, 16]
  Vec3d scale{1.0, 1.0, 1.0};  // multiplies the coordinates
  Vec3d bias{0.0, 0.0, 0.0};   // added to the scaled coordinates, length units
  double weight = 1.0;
  double gradient_modulation = 0.0;  // >= 0: octaves fade where the sum is steep; 0 for Worley noise
  std::optional<Warp> warp;          // displaces the coordinates before scale and bias

  VariedFields varied() { return {amplitude, frequency}; }
  // Multiplies all lengths by the ratio.
  void rescale(double ratio) {
    amplitude *= ratio;
    frequency /= ratio;
    bias *= ratio;
    if (warp) {
      warp->amplitude *= ratio;
      warp->frequency /= ratio;
    }
  }
};
void visit_fields(FieldVisitor& v, FractalLayer& layer);

// One symmetric pair of Gaussians in the power spectrum of a texture.
struct GaborLobe {
  // Spectral standard deviation 2^-bandwidth / (2 sqrt(2 ln 2)) cycles per pixel: the full width at half
  // maximum is 2^-bandwidth. 1 .. 12.
  int bandwidth = 4;
  double frequency_x = 0.0;  // cycles per pixel along a row, [-1/2, 1/2]
  double frequency_y = 0.0;  // cycles per pixel down a column, [-1/2, 1/2]
  double variance = 0.0;     // what this pair adds to the texture's variance, in squared exemplar units, > 0
};

// The colour that a layer adds to a texture, in RGB values as stored in the exemplar, full scale = 1:
//   color(p) = sum over the coloured layers of (mean + axis * exemplar_rms * (noise of the layer's lobes,
//   unit variance)).
// Colour never moves a surface; only height_rms does.
struct LayerColor {
  Vec3d axis;  // principal axis of the exemplar's colours, components in [-1, 1]; (1, 1, 1) is grey
  Vec3d mean;  // added everywhere; the first of an exemplar's layers holds the mean colour
};

// Bandwidth-quantised Gabor noise (thesis eq. 5.7 to 5.11) fitted to an exemplar.
// Height of the layer = height_rms * (noise of the lobes, scaled to unit variance), along the outward normal.
struct GaborLayer {
  static constexpr std::string_view kType = "gabor";
  static constexpr LayerTraits kTraits{
      .is_noise = true, .on_surface = true, .on_layers = false, .in_plane = true};

  std::string name;
  LayerSeed seed;
  LayerUse use;
  double pixel_size = 1.0;       // length units per exemplar pixel, > 0
  double height_rms = 0.0;       // length units, >= 0; a photo does not show it, so the user states it
  int impulses_per_kernel = 32;  // mean number of impulses under one kernel, for each bandwidth, 1 .. 1024
  double exemplar_mean = 0.0;    // mean grey value, full scale = 1
  double exemplar_rms = 0.0;     // standard deviation of grey values after the fit's preprocessing, >= 0
  std::optional<LayerColor> color;
  std::vector<GaborLobe> lobes;  // at least one

  bool has_height() const { return height_rms > 0.0; }
  // Multiplies all lengths by the ratio.
  void rescale(double ratio) {
    pixel_size *= ratio;
    height_rms *= ratio;
  }
};
void visit_fields(FieldVisitor& v, GaborLayer& layer);

// How an exemplar goes on beyond its border: as a copy of itself, which needs a periodic image, or mirrored.
enum class ExemplarBorder { kRepeat, kMirror };
inline constexpr ExemplarBorder kExemplarBorders[] = {ExemplarBorder::kRepeat, ExemplarBorder::kMirror};
constexpr std::string_view border_word(ExemplarBorder border) {
  return border == ExemplarBorder::kRepeat ? "repeat" : "mirror";
}

// How the copies of an exemplar are turned about the normal.
enum class ExemplarRotation { kNone, kQuarter, kAny };
inline constexpr ExemplarRotation kExemplarRotations[] = {ExemplarRotation::kNone, ExemplarRotation::kQuarter,
                                                          ExemplarRotation::kAny};
constexpr std::string_view rotation_word(ExemplarRotation rotation) {
  constexpr std::string_view kWords[] = {"none", "quarter", "any"};
  return kWords[static_cast<int>(rotation)];
}

// A texture by example: tiling and blending that preserves the histogram (Heitz and Neyret 2018) on a
// surface. Anchors stand on a body-centred cubic lattice in space. Each anchor has a random offset into the
// exemplar and the tangent frame of the bare surface near it. With the barycentric weights w_k of a point's
// four anchors, its coordinates u_k in their frames, and the Gaussianised exemplar g,
//   z = sum_k w_k^exponent g(u_k + offset_k) / sqrt(sum_k w_k^(2 exponent)),   height = quantile(normal(z)).
// The height has mean 0. Its standard deviation is height_rms, or height_range times that of the image.
//
// With `color` the layer also paints. The image's colours are taken along their principal axes, and each axis
// is Gaussianised and blended as above, with the weights and offsets of the height. The layer's weight (mask,
// locality) blends the colour over that of the layers before it. A layer that combines as a warp or a mask
// paints nothing.
struct ExemplarLayer : NamedImage {
  static constexpr std::string_view kType = "exemplar";
  static constexpr LayerTraits kTraits{
      .is_noise = true, .on_surface = true, .on_layers = true, .in_plane = true};

  std::string name;
  LayerSeed seed;
  LayerUse use;
  double pixel_size = 1.0;      // length units per pixel of the image, > 0
  double height_rms = 0.0;      // length units, >= 0
  double height_range = 0.0;    // height of white above black, length units; at most one of both is not 0
  int exponent = 3;             // 2 .. 8
  double anchor_spacing = 0.5;  // cube root of the volume per anchor, in shorter sides of the image, [0.1, 2]
  ExemplarBorder border = ExemplarBorder::kRepeat;
  ExemplarRotation rotation = ExemplarRotation::kNone;
  bool color = false;  // whether the layer paints the colours of the image

  bool has_height() const { return height_rms != 0.0 || height_range != 0.0; }
  StatedHeight stated_height() const {
    return height_range != 0.0 ? StatedHeight{"height_range", height_range}
                               : StatedHeight{"height_rms", height_rms};
  }
  // Whether the layer paints the surface of a body.
  bool paints() const {
    return color && use.combination.kind != Combine::kWarp && use.combination.kind != Combine::kMask;
  }
  // Multiplies all lengths by the ratio.
  void rescale(double ratio) {
    pixel_size *= ratio;
    height_rms *= ratio;
    height_range *= ratio;
  }
};
void visit_fields(FieldVisitor& v, ExemplarLayer& layer);

// An ellipsoid of a spot (thesis eq. 5.3). It adds
//   weight K(diag(axes)^-1 R^-1 (q - center)),   R the turns about x, then y, then z.
struct SpotPart {
  Vec3d center;         // units of q
  Vec3d axes{1, 1, 1};  // kLeastSpotAxis .. 1 / kLeastSpotAxis
  Vec3d turn;           // degrees, [-360, 360]
  double weight = 1.0;  // [-1000, 1000]
};
inline constexpr double kLeastSpotAxis = 0.01;
inline constexpr int kMaxSpotParts = 16;

// The edges of a lattice's cells, in sides of a cube. An edge is kLeastCellHeight to kLongestCellEdge long,
// and opposite faces are at least kLeastCellHeight apart.
struct CellEdges {
  Vec3d a{1, 0, 0}, b{0, 1, 0}, c{0, 0, 1};
};
inline constexpr double kLeastCellHeight = 0.4, kLongestCellEdge = 2.0;
// The least distance between two opposite faces of a cell; 0 for a flat cell.
inline double least_height(const CellEdges& e) {
  const double volume = std::fabs(dot(e.a, cross(e.b, e.c)));
  return volume > 0.0
             ? volume / std::max({norm(cross(e.b, e.c)), norm(cross(e.c, e.a)), norm(cross(e.a, e.b))})
             : 0.0;
}

// Locally controlled spot noise (thesis eq. 5.3 to 5.6): craters, or boulders when inverted.
//   n(p) = -amplitude sum_j gain^j sum_l w_l K(lacunarity^j (p - p_l) / size),      j = 0 .. layers - 1
//   K(q) = gaussian exp(-alpha q.q) + kappa exp(-beta (log(gamma q.q))^2) where q.V^-1 q <= sigma, else 0
// with V diagonal. If the spot has parts, the sum of the parts replaces K. Impulses p_l lie in a lattice of
// cells, cell_size / lacunarity^j wide. A cell is occupied with `probability`. An occupied cell holds a
// Poisson number of impulses, density_j on average, or with `even` an equal number in each. Impulses are
// uniform within `reach` cells of their cell. Weights w_l are uniform in [least_weight, 1]. On a surface the
// number of spots above a size falls as the size to the power -exponent, since density_j = density *
// lacunarity^(j (exponent - 2)).
struct SpotLayer {
  static constexpr std::string_view kType = "spots";
  static constexpr LayerTraits kTraits = kNoiseInSpace;

  std::string name;
  LayerSeed seed;
  LayerUse use;
  double amplitude = 0.0;  // length units
  bool inverted = false;   // n without the minus
  double size = 1.0;       // length units per unit of q, > 0
  double cell_size = 4.0;  // length units, > 0; a spot reaches at most kMaxSpotCells heights of a cell
  CellEdges lattice;
  double density = 1.0;       // impulses per occupied cell; each density_j is in [0, kMaxSpotDensity]
  double probability = 1.0;   // [0, 1]
  bool even = false;          // an occupied cell has density_j impulses; a fraction is the chance of one more
  double reach = 0.5;         // cells, [-1/2, 1]; at -1/2 impulses lie in the middle of their cells
  double least_weight = 0.5;  // [0, 1]
  double gaussian = 1.0;      // weight of the Gaussian, [-1e6, 1e6]
  double alpha = 1.0;         // decay of the Gaussian, [0, 1e6]
  double kappa = 0.0;         // weight of the ring, [-1e6, 1e6]
  double beta = 10.0;         // sharpness of the ring, [0, 1e6]
  double gamma = 1.0;         // [1e-6, 1e6]; the ring lies at |q| = gamma^(-1/2)
  Vec3d variances{1, 1, 1};   // diagonal of V, [1e-6, 1e6]
  double sigma = 4.0;         // cut of the kernel, [1e-6, 1e6]
  int layers = 1;             // 1 .. 12
  double lacunarity = 2.0;    // (1, 16]
  double gain = 0.5;          // [0, 4]
  double exponent = 2.0;      // [0, 6]
  std::vector<SpotPart> parts;  // at most kMaxSpotParts; without parts a spot is K itself

  // Multiplies all lengths by the ratio.
  void rescale(double ratio) {
    amplitude *= ratio;
    size *= ratio;
    cell_size *= ratio;
  }
};
void visit_fields(FieldVisitor& v, SpotLayer& layer);

// How far a spot reaches from its impulse, in units of q.
inline double spot_extent(const SpotLayer& layer, const SpotPart& part) {
  const Vec3d &v = layer.variances, &a = part.axes;
  const Vec3d half{a.x * std::sqrt(v.x), a.y * std::sqrt(v.y), a.z * std::sqrt(v.z)};
  return norm(part.center) + std::sqrt(layer.sigma) * std::max({half.x, half.y, half.z});
}

inline constexpr double kMaxSpotDensity = 64.0;
inline constexpr double kMaxSpotCells = 4.0;

// White noise that is zero in most cells, upscaled from level to level by quadratic interpolation. Cells that
// are not zero become round pits. The pits of a level are half as wide as those of the level before.
//   N_l(p) = upscaled noise of cells cell_size / 2^l wide; a lone value v has its peak v
//   n(p) = -amplitude sum_l gain^l max(N_l - threshold, 0),    l = 0 .. levels - 1
// or, merged, n(p) = -amplitude max(sum_l gain^l N_l - threshold, 0). The threshold cuts a crisp border.
struct SparseLayer {
  static constexpr std::string_view kType = "sparse";
  static constexpr LayerTraits kTraits = kNoiseInSpace;

  std::string name;
  LayerSeed seed;
  LayerUse use;
  double amplitude = 0.0;     // length units
  double cell_size = 1.0;     // width of the first level's cells, length units, > 0
  int levels = 4;             // 1 .. 16
  double probability = 0.05;  // chance that a cell is uniform in [0, 1) instead of zero, [0, 1]
  double threshold = 0.2;     // [0, 1]
  double gain = 0.5;          // [0, 4]
  bool merged = false;        // one image for all levels

  // Multiplies all lengths by the ratio.
  void rescale(double ratio) {
    amplitude *= ratio;
    cell_size *= ratio;
  }
};
void visit_fields(FieldVisitor& v, SparseLayer& layer);

// Local random phase noise (Gilet et al. 2014; thesis eq. 2.25): each cell of a lattice holds a sum of plane
// waves with phases of its own, and windows fade the sums of neighbouring cells into each other. Frequencies
// are spread evenly from frequency_min to frequency_max. The power of a wave goes as its frequency to the
// power -exponent. A cell adds up to half a turn times `randomness` to the phase of each wave. With a
// randomness of 0 the waves run through all cells in a regular pattern; with 1 only the spectrum of that
// pattern is left.
struct RandomPhaseLayer {
  static constexpr std::string_view kType = "random_phase";
  static constexpr LayerTraits kTraits = kNoiseInSpace;

  std::string name;
  LayerSeed seed;
  LayerUse use;
  double height_rms = 0.0;     // standard deviation, length units, >= 0
  double cell_size = 1.0;      // length units, > 0
  int waves = 16;              // 1 .. 128
  double frequency_min = 1.0;  // cycles per length unit, > 0
  double frequency_max = 4.0;  // cycles per length unit, >= frequency_min
  double exponent = 0.0;       // [-8, 8]
  Vec3d direction{0, 0, 1};    // mean direction of the waves; not zero
  double spread = 1.0;         // [0, 1]: the cosine of a wave with `direction` is at least 1 - spread
  double randomness = 1.0;     // [0, 1]

  // Multiplies all lengths by the ratio.
  void rescale(double ratio) {
    height_rms *= ratio;
    cell_size *= ratio;
    frequency_min /= ratio;
    frequency_max /= ratio;
  }
};
void visit_fields(FieldVisitor& v, RandomPhaseLayer& layer);

// The height that a phasor layer draws over a turn of the phase, between -1 and 1.
enum class PhasorProfile { kSine, kTriangle, kSawtooth, kSquare };
inline constexpr PhasorProfile kPhasorProfiles[] = {PhasorProfile::kSine, PhasorProfile::kTriangle,
                                                    PhasorProfile::kSawtooth, PhasorProfile::kSquare};
constexpr std::string_view profile_word(PhasorProfile profile) {
  constexpr std::string_view kWords[] = {"sine", "triangle", "sawtooth", "square"};
  return kWords[static_cast<int>(profile)];
}

// Phasor noise (Tricard et al. 2019; thesis eq. 2.27 to 2.30): a profile drawn over the phase of a sum of
// Gabor kernels. It makes stripes, ridges, hatches and ripples whose contrast never fades.
struct PhasorLayer {
  static constexpr std::string_view kType = "phasor";
  static constexpr LayerTraits kTraits = kNoiseInSpace;

  std::string name;
  LayerSeed seed;
  LayerUse use;
  double amplitude = 0.0;     // length units
  double frequency = 1.0;     // cycles per length unit, > 0
  double cell_size = 1.0;     // reach of a kernel, length units, > 0; frequency * cell_size is at most 1024
  int impulses_per_cell = 2;  // 1 .. 16
  Vec3d direction{1, 0, 0};   // across the stripes; not zero
  double spread = 0.1;        // [0, 1]: the cosine of a kernel with `direction` is at least 1 - spread
  PhasorProfile profile = PhasorProfile::kSine;

  // Multiplies all lengths by the ratio.
  void rescale(double ratio) {
    amplitude *= ratio;
    cell_size *= ratio;
    frequency /= ratio;
  }
};
void visit_fields(FieldVisitor& v, PhasorLayer& layer);
inline constexpr double kMaxPhasorTurns = 1024.0;

}  // namespace astrolith
