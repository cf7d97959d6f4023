// The bare body of a recipe as plain tables, for CPU and GPU: metaballs, and what operations do to them with
// further bodies. body_at_point.h evaluates them at one point, body_bounds.h over boxes.
#pragma once

#include <cstdint>

#include "numerics/arrays.h"
#include "recipe/recipe.h"
#include "synthesis/body/body_operators.h"
#include "synthesis/body/metaball_body.h"
#include "synthesis/noise/coordinate_warp.h"

namespace astrolith {

// Metaballs under one set of parameters, and the warp of their coordinates.
struct BodyLeaf {
  MetaballParameters<float> metaballs;
  bool warped = false;
  CoordinateWarp warp;
  ArrayRange<MetaballSphere<float>> spheres;  // subtractive ones last, as in every list of a leaf's spheres
};

// A step puts a leaf's distance on a stack, or combines the upper two.
struct BodyStep {
  bool is_leaf = true;
  std::uint32_t leaf = 0;
  OperatorParameters<float> combine;
  OperatorParameters<double> bounds;  // the same operator, for bounds
};

struct BodyTables {
  ArrayRange<BodyLeaf> leaves;
  ArrayRange<BodyStep> steps;
  Box supports;  // holds the supports of all kernels that add, and so every surface
  double lipschitz_bound =
      1.0;  // s changes at most so much faster than a distance, because of operators and warps

  // A body of one leaf has no steps. Its metaballs may be warped; whoever evaluates it takes points through
  // body_box() and warp_points() first, since layers on the surface live on the metaballs' own side of the
  // warp.
  ASTROLITH_HD bool plain() const { return steps.count == 0; }
};

// `seed` is the recipe's. Expects what validation accepts.
BodyTables make_body(const MetaballBody& body, std::uint64_t seed, ArrayStore& arrays);

// Lists of the metaballs that reach a box: leaf l has spheres[first[l]] to spheres[first[l + 1] - 1].
struct LeafLists {
  const MetaballSphere<float>* spheres;
  const std::uint32_t* first;
};

// The metaballs of each leaf that reach a box, copied so that they lie side by side.
struct ReachingMetaballs {
  std::vector<MetaballSphere<float>> spheres;
  std::vector<std::uint32_t> first{0};  // (leaves + 1)

  void add(std::span<const MetaballSphere<float>> of_leaf) {
    spheres.insert(spheres.end(), of_leaf.begin(), of_leaf.end());
    first.push_back(static_cast<std::uint32_t>(spheres.size()));
  }
  LeafLists lists() const { return {spheres.data(), first.data()}; }
};

ReachingMetaballs all_metaballs(const BodyTables& body, const ArrayView& arrays);

// Those of the lists that reach points of a box; they give the same bits there. `at` is the body_box() of the
// box.
ReachingMetaballs metaballs_reaching(const BodyTables& body, const ArrayView& arrays, const LeafLists& lists,
                                     const Box& at);

// s(p) and its gradient's direction at n points, as evaluate_metaballs. With operations s is what they make
// of the operands' s, and the gradient has about unit length. The points of a plain body lie on the
// metaballs' side of its warp.
void evaluate_body(const BodyTables& body, const ArrayView& arrays, const LeafLists& lists, int n,
                   const float* x, const float* y, const float* z, float* distance, float* gradient_x,
                   float* gradient_y, float* gradient_z);

}  // namespace astrolith
