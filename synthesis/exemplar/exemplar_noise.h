// An exemplar layer of the recipe on the surface of a body: tiling and blending of its image, at one point,
// over many points at once, and as a bound. The equation stands at ExemplarLayer (recipe/noise_layers.h).
#pragma once

#include <cstdint>
#include <string>

#include "numerics/arrays.h"
#include "numerics/interval.h"
#include "synthesis/body/layer_site.h"
#include "synthesis/exemplar/exemplar_anchors.h"
#include "synthesis/exemplar/exemplar_texture.h"
#include "synthesis/noise/noise_frame.h"
#include "synthesis/noise/noise_traits.h"

namespace astrolith {

struct ExemplarNoise {
  static constexpr NoiseTraits kTraits{.on_surface = true,
                                       .lifts = true,
                                       .has_heights = true,
                                       .bounded_by_box = false,
                                       .local_form = false,
                                       .lists = NoiseLists::kNone};

  Vec3f low, high;  // points outside are moved to the border
  ExemplarTexture texture;
  ExemplarLattice lattice;    // without anchors where the layer is left out
  std::int32_t exponent = 3;  // of the blending weights
  bool lifted = false;        // whether points are lifted to the surface that the layers below make
  double height_bound = 0.0;  // bound of |n(p)|, length units
  NoiseDetail detail;
};

// The noise without a lattice: its height is 0 everywhere. Throws as make_exemplar_texture() does.
ExemplarNoise make_exemplar(const ExemplarLayer& layer, const std::string& place, ArrayStore& arrays);

// The noise `made` by make_exemplar() with the anchors of a site: those of the frame's domain, or where they
// are too many of the box around the surface. Where also these are more than kMostExemplarAnchors, or float
// coordinates cannot tell the pixels apart, the whole layer is left out. With `on_layers` the noise lies on
// the surface that the layers below make. The site's arrays may be `arrays`.
ExemplarNoise placed_exemplar(const ExemplarNoise& made, const ExemplarLayer& layer, std::uint64_t seed,
                              int layer_index, const LayerSite& site, bool on_layers, ArrayStore& arrays);

// What a layer is at every site, and the noise with the anchors of one site (synthesis/field/layer_noise.h).
inline ExemplarNoise prepare(const ExemplarLayer& layer, const LayerSource& source, ArrayStore& arrays) {
  return make_exemplar(layer, source.place, arrays);
}
ExemplarNoise placed(const ExemplarLayer& layer, const ExemplarNoise& prepared, const LayerSource& source,
                     const LayerSite& site, ArrayStore& arrays);

// The weights of the four anchors in z: w^exponent over the root of the sum of the squares.
ASTROLITH_KERNEL void sharpen_weights(std::int32_t exponent, float* weight) {
  float squares = 0.0f;
  ASTROLITH_UNROLL
  for (int c = 0; c < 4; ++c) {
    const float w = weight[c];
    float power = w * w;
    for (std::int32_t e = 2; e < exponent; ++e) power *= w;
    weight[c] = power;
    squares = math::fma(power, power, squares);
  }
  const float scale = 1.0f / math::sqrt(squares);
  ASTROLITH_UNROLL
  for (int c = 0; c < 4; ++c) weight[c] *= scale;
}

// One anchor's part of z at the offset (x, y, z) from the first corner.
ASTROLITH_KERNEL float anchor_value(const ExemplarTexture& t, const std::uint32_t* words,
                                    const ExemplarAnchor& a, float x, float y, float z) {
  const float u = math::fma(a.ux, x, math::fma(a.uy, y, math::fma(a.uz, z, a.offset_u)));
  const float v = math::fma(a.vx, x, math::fma(a.vy, y, math::fma(a.vz, z, a.offset_v)));
  return exemplar_value(t, words, u, v);
}

// The height at a point of the bare surface, or of the one that the layers below make; length units.
ASTROLITH_HD inline float height_at(const ExemplarNoise& n, const ArrayView& arrays, const Vec3f& at) {
  if (n.lattice.anchors.count == 0) return 0.0f;
  const Vec3f p = moved_into(at, n.low, n.high);
  ExemplarPlace place = exemplar_place(n.lattice, p.x, p.y, p.z);
  sharpen_weights(n.exponent, place.weight);
  float z = 0.0f;
  for (int c = 0; c < 4; ++c) {
    const ExemplarAnchor a =
        anchor_at_corner(n.lattice, arrays[n.lattice.anchors], place.anchor, place.order, c);
    z = math::fma(place.weight[c],
                  anchor_value(n.texture, arrays[n.texture.words], a, place.x, place.y, place.z), z);
  }
  return exemplar_height(arrays[n.texture.heights], z);
}

// Writes height[i] = n(p_i) at these points, length units. The loops are vectorised and give the same bits as
// height_at.
void evaluate_heights(const ExemplarNoise& n, const ArrayView& arrays, int count, const float* x,
                      const float* y, const float* z, float* height);
// Writes these heights for anchors that lie outside the arrays of the texture.
void evaluate_heights(const ExemplarNoise& n, const ArrayView& arrays, const ExemplarAnchor* anchors,
                      int count, const float* x, const float* y, const float* z, float* height);

// An interval that holds n(p) for every point, length units. It does not depend on the box.
ASTROLITH_HD inline Interval bound_heights(const ExemplarNoise& n, const ArrayView&, const Box&) {
  return n.lattice.anchors.count == 0
             ? Interval{0.0, 0.0}
             : Interval{std::min(n.texture.least, 0.0), std::max(n.texture.greatest, 0.0)};
}

}  // namespace astrolith
