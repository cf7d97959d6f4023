// A recipe's field as plain arrays, for CPU and GPU alike. Made by flat_field_data.h from an ImplicitField
// and evaluated, with its bits, by flat_value.h, one point at a time; the vectorised loops of ImplicitField
// are faster on a CPU.
#pragma once

#include <cstdint>

#include "synthesis/body/body_operators.h"
#include "synthesis/body/metaball_body.h"
#include "synthesis/field/join_bounds.h"
#include "synthesis/field/local_weight.h"
#include "synthesis/gabor/gabor_surface_noise.h"
#include "synthesis/landforms/boulder_shape.h"
#include "synthesis/landforms/crater_profile.h"
#include "synthesis/noise/fractal_noise.h"
#include "synthesis/noise/phasor_noise.h"
#include "synthesis/noise/random_phase_noise.h"
#include "synthesis/noise/sparse_noise.h"
#include "synthesis/spots/spot_draw.h"

namespace astrolith {

// Elements first .. first + count - 1 of an array.
struct FlatRange {
  std::uint32_t first = 0, count = 0;
};

// CoordinateWarp.
struct FlatWarp {
  FlatRange octaves[3];  // along x, y, z
  Vec3f low, high;       // points outside are displaced as the nearest one inside
  double bound = 0.0;    // of a displacement, length units
};

// LocalWeight.
struct FlatWeight {
  FlatRange near, others;  // spheres
  float inverse_width = 0.0f;
};

// The spots of one kind. Their impulses are a block's list.
struct FlatSpots {
  SpotKind kind;
  std::uint32_t list, layer;
};

// LayerJoin.
struct FlatJoin {
  float change_bound = 0.0f;  // by which this layer and those after it change an elevation at most
  bool changes_elevation = true, warps = false, blends = false, is_change = true;
  float sign = 1.0f, width = 0.0f;  // of a blend
  Vec3f direction;                  // of a warp
  bool local = false;
  FlatWeight locality;
  int keeps = -1, mask = -1;  // slots
  float mask_from = 0.0f, mask_to = 1.0f, mask_inverse_range = 0.0f;
  // For bounds.
  JoinKind how;
  Vec3d displaced;            // of the layer's coordinates, at most, by axis
  double height_bound = 0.0;  // of its heights, times what they weigh
};

// Heights that masks ask for.
inline constexpr int kFlatSlots = 4;

enum class FlatNoise { kFractal, kSparse, kSpots, kPhasor, kRandomPhase, kCraters, kGabor };

// A bandwidth of Gabor noise. Its impulses are a block's list.
struct FlatBand {
  GaborDraw draw;
  FlatRange lobes;
  std::uint32_t layer;
};

// A layer; which members count depends on its noise. But for craters points are moved into the box low ..
// high first.
struct FlatLayer {
  FlatNoise kind = FlatNoise::kFractal;
  FlatJoin join;
  Vec3f low, high;
  FlatRange parts;  // octaves, sparse levels, kinds of spots, waves, bands or craters; as many impulses of
                    // phasor noise
  std::uint32_t seed = 0;
  // Fractal noise.
  Noise noise = Noise::kSimplex;
  bool warped = false;
  FlatWarp warp;
  Vec3f scale, bias;
  float gradient_modulation = 0.0f;
  // Sparse noise; the amplitude also of phasor noise.
  float amplitude = 0.0f, level_cut = 0.0f, sum_cut = 0.0f, probability = 0.0f, inverse_probability = 0.0f;
  // Phasor and random-phase noise.
  float inverse_cell = 0.0f;
  PhasorKernels kernels{};
  PhasorProfile profile = PhasorProfile::kSine;
  float randomness = 0.0f, coherence = 0.0f;
  float clip = 0.0f;          // of random-phase and Gabor noise; of the elevation after craters
  std::uint32_t list = 0;     // of craters that reach a block
  double height_bound = 0.0;  // of the heights; of the elevation after craters
};

// Metaballs, and how a body is made of them: each step puts a leaf's distance on a stack, or combines the
// upper two. A body of one leaf is plain: it has no steps.
struct FlatLeaf {
  MetaballParameters<float> body;
  bool warped = false;
  FlatWarp warp;      // of the leaf's coordinates
  FlatRange spheres;  // those that take away last, as in every list of a leaf's spheres
};
struct FlatStep {
  bool is_leaf = true;
  std::uint32_t leaf = 0;
  OperatorParameters<float> combine;
  OperatorParameters<double> bounds;
};

// A boulder, and the box that it reaches.
struct FlatBoulder {
  BoulderKernel kernel;
  Vec3d low, high;
};

// Pointers to the arrays, which lie on the host or on a device, and what stands once.
struct FlatField {
  const FlatLayer* layers;
  const FlatLeaf* leaves;
  const MetaballSphere<float>* spheres;  // of all leaves
  const FlatStep* steps;
  const NoiseOctave* octaves;
  const WeightSphere* weight_spheres;
  const SparseLevel* sparse_levels;
  const FlatSpots* spots;
  const std::uint32_t* spot_thresholds;
  const Wave* waves;
  const FlatBand* bands;
  const GaborLobeShare* lobes;
  const CraterKernel* craters;
  const std::uint32_t* crater_layers;  // by list
  const FlatBoulder* boulders;
  std::uint32_t num_layers, num_leaves, num_steps;
  std::uint32_t boulder_list;  // of boulders that reach a block
  float lipschitz_bound;       // s changes so much faster than a distance
  float height_reach;          // no elevation exceeds it
  float longest_step;          // on the way to the bare surface
  double height_bound;         // of the |elevation| that all layers make
};

// What of the field reaches a box; of list l: first[l] .. first[l + 1] - 1.
struct FlatBlock {
  const MetaballSphere<float>* spheres;
  const std::uint32_t* first_sphere;  // by leaf
  const SpotImpulse* impulses;
  const std::uint32_t* first_impulse;  // by kind of spots
  const GaborImpulse* gabor;
  const std::uint32_t* first_gabor;     // by band
  const std::uint32_t* landforms;       // numbers of craters and boulders
  const std::uint32_t* first_landform;  // by list
};

// Of many boxes, as arrays.
struct FlatBlocks {
  const MetaballSphere<float>* spheres;
  const std::uint32_t* first_sphere;  // (blocks * leaves + 1)
  const SpotImpulse* impulses;
  const std::uint32_t* first_impulse;  // (blocks * sizes + 1)
  const GaborImpulse* gabor;
  const std::uint32_t* first_gabor;  // (blocks * bands + 1)
  const std::uint32_t* landforms;
  const std::uint32_t* first_landform;  // (blocks * lists + 1)
  std::uint32_t leaves, sizes, bands, lists;

  ASTROLITH_HD FlatBlock block(std::size_t i) const {
    return {spheres, first_sphere + i * leaves, impulses,  first_impulse + i * sizes,
            gabor,   first_gabor + i * bands,   landforms, first_landform + i * lists};
  }
};

}  // namespace astrolith
