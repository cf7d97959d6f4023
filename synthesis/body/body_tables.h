// The bare body of a recipe as plain tables, for CPU and GPU: leaves of metaballs, and the steps that combine
// them. body_at_point.h evaluates the tables at one point, body_bounds.h bounds them over boxes.
#pragma once

#include <cstdint>
#include <memory>

#include "numerics/arrays.h"
#include "recipe/recipe.h"
#include "synthesis/body/body_operators.h"
#include "synthesis/body/metaball_body.h"
#include "synthesis/body/spline_grid.h"
#include "synthesis/noise/coordinate_warp.h"

namespace astrolith {

// Metaballs with one set of parameters, and the warp of their coordinates; or the grid of a morph, which has
// no metaballs.
struct BodyLeaf {
  MetaballParameters<float> metaballs;
  bool warped = false;
  CoordinateWarp warp;
  ArrayRange<MetaballSphere<float>> spheres;  // subtractive spheres last, as in every list of spheres
  SplineGrid grid;
};

// A step of the evaluation on a stack: it pushes the distance of a leaf, or replaces the upper two distances
// by their combination.
struct BodyStep {
  bool is_leaf = true;
  std::uint32_t leaf = 0;
  OperatorParameters<float> combine;
  OperatorParameters<double> bounds;  // the same operator in double, for bounds
};

struct BodyTables {
  ArrayRange<BodyLeaf> leaves;
  ArrayRange<BodyStep> steps;
  Box supports;                  // holds the supports of all kernels that add, and so every surface
  double lipschitz_bound = 1.0;  // bound of |grad s|; above 1 with operators and warps
  bool gridded = false;          // whether a leaf is a grid: heights then move the surface beyond `supports`

  // Whether the body is one leaf of metaballs, without operations: it has no steps. If that leaf is warped,
  // the caller maps points through warp_points() and boxes through body_box() before the evaluation, since
  // layers on the surface use warped coordinates too.
  ASTROLITH_HD bool plain() const { return steps.count == 0; }
};

// The tables of a body. `seed` is the seed of the recipe. Expects a body that validation accepts. `kept`,
// where it is given, holds the grids of the body's morphs from one call to the next; all calls have the same
// body.
BodyTables make_body(const MetaballBody& body, std::uint64_t seed, ArrayStore& arrays,
                     std::shared_ptr<void>* kept = nullptr);

// A box that holds the points at which the body is evaluated for the points of `box`: their warped images if
// the body is plain and warped, else the points themselves.
ASTROLITH_HD inline Box body_box(const BodyTables& body, const ArrayView& arrays, const Box& box) {
  const BodyLeaf& first = *arrays[body.leaves];
  return body.plain() && first.warped ? warped_box(first.warp, arrays, box) : box;
}

// A box that holds the points at which the metaballs of leaf `number` are evaluated. `at` is the body_box()
// of the original box.
ASTROLITH_HD inline Box leaf_box(const BodyTables& body, const ArrayView& arrays, std::uint32_t number,
                                 const Box& at) {
  const BodyLeaf& leaf = arrays[body.leaves][number];
  return !body.plain() && leaf.warped ? warped_box(leaf.warp, arrays, at) : at;
}

// Lists of metaballs, one for each leaf: leaf l has spheres[first[l]] to spheres[first[l + 1] - 1].
struct LeafLists {
  const MetaballSphere<float>* spheres;
  const std::uint32_t* first;
};

// The metaballs of each leaf that reach a box, copied into one array.
struct ReachingMetaballs {
  std::vector<MetaballSphere<float>> spheres;
  std::vector<std::uint32_t> first{0};  // one offset per leaf into `spheres`, and the total

  void add(std::span<const MetaballSphere<float>> leaf_spheres) {
    spheres.insert(spheres.end(), leaf_spheres.begin(), leaf_spheres.end());
    first.push_back(static_cast<std::uint32_t>(spheres.size()));
  }
  LeafLists lists() const { return {spheres.data(), first.data()}; }
};

ReachingMetaballs all_metaballs(const BodyTables& body, const ArrayView& arrays);

// The metaballs of the lists that reach points of a box. They give the same bits there. `at` is the
// body_box() of the box.
ReachingMetaballs metaballs_reaching(const BodyTables& body, const ArrayView& arrays, const LeafLists& lists,
                                     const Box& at);

// Writes s(p), length units, and a vector along its gradient at n points. For a plain body the results are
// those of evaluate_metaballs(), and the points are already warped. For a body with operations s is the
// combined distance, and the gradient has about unit length.
void evaluate_body(const BodyTables& body, const ArrayView& arrays, const LeafLists& lists, int n,
                   const float* x, const float* y, const float* z, float* distance, float* gradient_x,
                   float* gradient_y, float* gradient_z);

}  // namespace astrolith
