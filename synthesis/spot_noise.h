// A spot layer of the recipe, ready for evaluation over many points (thesis eq. 5.4 to 5.6).
//
// Impulses are hashes of their cells: whoever needs some points' heights draws those whose spots reach them,
// in the order of cells, and a spot adds exactly nothing beyond its support. The bits of a height do not
// depend on what else was drawn.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "recipe/recipe.h"
#include "synthesis/noise_octaves.h"
#include "synthesis/spot_kernel.h"

namespace astrolith {

// Drawn ones, by size.
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
  // Of size j: the kernel, and where the |sum| of its spots is cut, length units.
  const SpotKernel& kernel(int j) const { return sizes_[static_cast<std::size_t>(j)].kernel; }
  float clip(int j) const { return sizes_[static_cast<std::size_t>(j)].clip; }
  // All that reach a box, however many.
  SpotImpulses draw(const Box& box) const;

  int num_sizes() const { return static_cast<int>(sizes_.size()); }
  // The impulses of size j whose spots may reach the box, in the order of their cells (z, then y, then x).
  std::vector<SpotImpulse> impulses_reaching(int j, const Box& box) const;

 private:
  // The spots of one j.
  struct Size {
    SpotKernel kernel;
    std::uint32_t seed;
    float cell;                        // side, length units
    float clip;                        // of |sum|, length units
    Vec3d support;                     // half axes, length units
    std::vector<std::uint32_t> least;  // a cell whose hash is at least the l-th of these has l + 1 impulses
  };
  struct Cells {
    int first[3], last[3];
    double count() const;
  };

  Cells cells_around(const Size& size, const Box& box) const;
  void draw_cell(const Size& size, int cx, int cy, int cz, const Box& box,
                 std::vector<SpotImpulse>& out) const;
  void add_size(const Size& size, int n, const float* x, const float* y, const float* z, float* height) const;
  Interval bound_size(const Size& size, const Box& box, const std::vector<SpotImpulse>& impulses) const;
  Box moved_into_domain(const Box& box) const;

  SpotLayer layer_;
  std::vector<Size> sizes_;
  Vec3f domain_min_, domain_max_;
  double height_bound_ = 0.0;
};

}  // namespace astrolith
