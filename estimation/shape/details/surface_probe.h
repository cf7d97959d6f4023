// Heights of surfaces over a base body at fixed points, without meshing the surfaces. The surface is that of
// the measured target, of the base itself, or of a candidate for the base's details.
//
// A point v moves along its direction n, a unit vector that points out of the base, until it meets the
// surface:
//   t <- t + F(v + t n),
// where F is a distance to first order, positive inside. All surfaces are met by these steps, so that their
// heights over the same points can be compared point by point.
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

// The heights of the target at the points. They are clipped to [-reach, reach], in length units.  (#points)
std::vector<double> target_heights(const SurfaceTree& target, std::span<const ProbePoint> points,
                                   double reach);

class SurfaceProbe {
 public:
  // Heights are clipped to [-reach, reach], in length units.
  SurfaceProbe(const MetaballBody& base, const std::vector<ProbePoint>& points, double reach);

  // The height of every point, for the base with these layers as synthesis makes them from a recipe with this
  // seed. Runs in parallel, and may be called from many threads.  (#points)
  std::vector<double> heights(std::span<const FractalLayer> layers, std::uint64_t seed) const;

  // The heights for each candidate, computed by the evaluator. They have the bits of the function above.
  // (#candidates x #points)
  std::vector<std::vector<double>> heights(CandidateEvaluator& evaluator,
                                           std::span<const std::vector<FractalLayer>> candidates,
                                           std::uint64_t seed) const;

 private:
  // A group of points that lie close together, and the metaballs that reach them.
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
  ProbeLines lines_;  // the points of all blocks, one block after the other
};

}  // namespace astrolith
