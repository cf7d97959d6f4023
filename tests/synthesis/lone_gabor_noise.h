// A Gabor layer on a body, without a field.
#pragma once

#include <algorithm>
#include <vector>

#include "synthesis/gabor/gabor_bricks.h"
#include "synthesis/gabor/gabor_surface_noise.h"

namespace astrolith::testing {

class LoneGaborNoise {
 public:
  LoneGaborNoise(const GaborLayer& layer, std::uint64_t seed, int layer_index, const MetaballBody& body,
                 const Box& domain)
      : tables_(make_body(body, 1, arrays_)),
        metaballs_(all_metaballs(tables_, arrays_.view())),
        noise_(make_noise(layer, seed, layer_index, domain,
                          std::max({domain.extent().x, domain.extent().y, domain.extent().z}), arrays_)),
        caches_(noise_.bands.count) {}

  void evaluate(int n, const float* x, const float* y, const float* z, float* height) const {
    evaluate_heights(noise_, ground(), caches_.data(), n, x, y, z, height);
  }
  void evaluate_tetrahedra(int n, const float* x, const float* y, const float* z, float* height) const {
    evaluate_tetrahedron_heights(noise_, ground(), caches_.data(), n, x, y, z, height);
  }

 private:
  BodyGround ground() const { return {tables_, arrays_.view(), metaballs_.lists()}; }

  ArrayStore arrays_;
  BodyTables tables_;
  ReachingMetaballs metaballs_;
  GaborSurfaceNoise noise_;
  std::vector<GaborBrickCache> caches_;  // by band
};

}  // namespace astrolith::testing
