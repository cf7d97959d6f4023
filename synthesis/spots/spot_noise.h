// A spot layer of the recipe, ready for evaluation over many points (thesis eq. 5.3 to 5.6).
//
// Impulses are hashes of their cells: whoever needs some points' heights draws those whose spots reach them,
// in the order of cells, and a spot adds exactly nothing beyond its support. The bits of a height do not
// depend on what else was drawn.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "numerics/interval.h"
#include "recipe/recipe.h"
#include "synthesis/spots/spot_kernel.h"
#include "synthesis/spots/spot_lattice.h"

namespace astrolith {

// Drawn ones, by kind.
using SpotImpulses = std::vector<std::vector<SpotImpulse>>;

class SpotNoise {
 public:
  // `layer_index` is the layer's number in the recipe: layers of one seed are independent. Points outside
  // `domain`, where no surface is, are moved to its border; sizes so fine that float coordinates within it
  // could not tell neighbouring cells apart (above 2^20 cells from the origin) are left out.
  SpotNoise(const SpotLayer& layer, std::uint64_t seed, int layer_index, const Box& domain);

  // The impulses that reach a box, chosen from those of a larger one where these are given; null where there
  // are too many to be drawn at once.
  std::shared_ptr<const SpotImpulses> gather(const Box& box, const SpotImpulses* of_larger) const;

  // height[i] = n(p_i), length units. `impulses`, unless null, must hold all that reach the points.
  void evaluate(int n, const float* x, const float* y, const float* z, float* height,
                const SpotImpulses* impulses = nullptr) const;

  // |n(p)| never exceeds this.
  double height_bound() const { return height_bound_; }

  // n(p) at every float point of a box; `impulses` as above.
  Interval bound_heights(const Box& box, const SpotImpulses* impulses = nullptr) const;

  // Points outside are moved to the border.
  const Vec3f& domain_min() const { return domain_min_; }
  const Vec3f& domain_max() const { return domain_max_; }
  // What it is made of; the kinds' lattices point into the thresholds.
  const std::vector<SpotKind>& kinds() const { return kinds_; }
  const std::vector<std::uint32_t>& thresholds() const { return thresholds_; }
  // All that reach a box, however many.
  SpotImpulses draw(const Box& box) const;

  int num_kinds() const { return static_cast<int>(kinds_.size()); }
  // The impulses of kind k whose spots may reach the box, in the order of their cells (z, then y, then x).
  std::vector<SpotImpulse> impulses_reaching(int k, const Box& box) const;

 private:
  void add_kind(const SpotLayer& layer, const SpotPart& part, const SpotLattice& lattice, double unit,
                double amplitude);
  void add_sum(const SpotKind& kind, int n, const float* x, const float* y, const float* z,
               float* height) const;

  std::vector<SpotKind> kinds_;
  std::vector<std::uint32_t> thresholds_;
  Vec3f domain_min_, domain_max_;
  double height_bound_ = 0.0;
};

}  // namespace astrolith
