// Heights over a base body at fixed places: of the measured target, of the base itself, and of candidates for
// its details, all by the same steps, without meshing any of them.
//
// A point v moves along its direction n, a unit vector that leads out of the base, until the surface is met:
// t <- t + F(v + t n), where F is a distance to first order, positive inside. Heights of two surfaces over
// the same points can be compared point by point.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "cuda/candidate_evaluator.h"
#include "geometry/surface/surface_tree.h"
#include "recipe/recipe.h"
#include "synthesis/body/metaball_body.h"

namespace astrolith {

struct ProbePoint {
  Vec3d start, direction;
};

// No height is looked for beyond +- `reach`, length units.  (#points)
std::vector<double> target_heights(const SurfaceTree& target, std::span<const ProbePoint> points,
                                   double reach);

class SurfaceProbe {
 public:
  SurfaceProbe(const MetaballBody& base, const std::vector<ProbePoint>& points, double reach);

  // t of every point, in the order given, for the base with these layers as synthesis makes them of a recipe
  // with the seed. Runs in parallel; may be called from many threads.  (#points)
  std::vector<double> heights(std::span<const FractalLayer> layers, std::uint64_t seed) const;

  // The same of each candidate, by another machine: the same bits.
  std::vector<std::vector<double>> heights(CandidateEvaluator& evaluator,
                                           std::span<const std::vector<FractalLayer>> candidates,
                                           std::uint64_t seed) const;

 private:
  // Points near one another, and the spheres that reach them.
  struct Block {
    std::vector<std::int32_t> points;                    // indices
    std::array<std::vector<float>, 3> start, direction;  // (#points of the block)
    PreparedMetaballs metaballs;
  };
  void add_block(const PreparedMetaballs& base, const std::vector<ProbePoint>& points,
                 std::vector<std::int32_t> indices);

  void add_lines(const Block& block);

  std::size_t size_;
  double reach_;
  Box domain_;
  std::vector<Block> blocks_;
  ProbeLines lines_;  // of all blocks, one after the other
};

}  // namespace astrolith
