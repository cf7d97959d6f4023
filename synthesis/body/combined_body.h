// The bare body of a recipe, ready for evaluation: metaballs, and what operations do to them with further
// bodies. A body without operations is its metaballs, whose warp is left to the caller.
#pragma once

#include <memory>
#include <vector>

#include "synthesis/body/body_operators.h"
#include "synthesis/body/metaball_body.h"
#include "synthesis/noise/coordinate_warp.h"

namespace astrolith {

struct PreparedOperation;

struct PreparedBody {
  PreparedMetaballs metaballs;
  std::shared_ptr<const CoordinateWarp> warp;  // of the metaballs' coordinates, where there are operations
  std::vector<PreparedOperation> operations;   // in order

  bool plain() const { return operations.empty() && warp == nullptr; }
};

struct PreparedOperation {
  OperatorParameters<double> parameters;
  PreparedBody operand;
};

// As points are evaluated with.
OperatorParameters<float> in_float(const OperatorParameters<double>& o);

// `seed` is the recipe's. Expects what validation accepts.
PreparedBody prepare_body(const MetaballBody& body, std::uint64_t seed);

// The seed of the warp of a body's n-th metaballs, counted as they stand in the recipe.
std::uint32_t body_warp_seed(std::uint64_t seed, std::uint32_t n);

// What of the body reaches the box: the same bits there.
PreparedBody body_reaching(const PreparedBody& body, const Box& box);

// A box that holds every point where the body may be.
Box support_bounds(const PreparedBody& body);

// s(p) and its gradient's direction, as evaluate_metaballs. With operations s is what they make of the
// operands' s, and the gradient has about unit length.
void evaluate_body(const PreparedBody& body, int n, const float* x, const float* y, const float* z,
                   float* distance, float* gradient_x, float* gradient_y, float* gradient_z);

// s at every float point of a box; never wrong. Tighter for what is farther than `height` from a surface.
Interval bound_distance(const PreparedBody& body, const Box& box, double height);

// How much faster than a distance s may change because of operators and warps; at least 1.
double lipschitz_bound_of(const PreparedBody& body);

}  // namespace astrolith
