// A body of a recipe by itself, with arrays of its own.
#pragma once

#include <vector>

#include "synthesis/body/body_bounds.h"

namespace astrolith::testing {

class LoneBody {
 public:
  LoneBody(const MetaballBody& body, std::uint64_t seed)
      : tables_(make_body(body, seed, arrays_)), metaballs_(all_metaballs(tables_, arrays_.view())) {}

  // s and its gradient's direction at n points, as evaluate_body.
  void evaluate(int n, const float* x, const float* y, const float* z, float* s, float* gx, float* gy,
                float* gz) const {
    evaluate_body(tables_, arrays_.view(), metaballs_.lists(), n, x, y, z, s, gx, gy, gz);
  }
  // s over a box; of a body with operations.
  Interval bound(const Box& box, double height) const {
    std::vector<KernelInterval> scratch(metaballs_.spheres.size());
    return bound_distance(tables_, arrays_.view(), Lists{metaballs_}, box, height, scratch.data());
  }

  const BodyTables& tables() const { return tables_; }
  ArrayView arrays() const { return arrays_.view(); }
  LeafLists metaballs() const { return metaballs_.lists(); }

 private:
  struct Lists {
    const ReachingMetaballs& all;
    MetaballList metaballs(std::uint32_t leaf) const {
      return {all.spheres.data() + all.first[leaf], nullptr, all.first[leaf + 1] - all.first[leaf]};
    }
  };

  ArrayStore arrays_;
  BodyTables tables_;
  ReachingMetaballs metaballs_;
};

}  // namespace astrolith::testing
