// Where the spots of one size lie: hashes of the cells of a lattice (thesis 5.3.1, figure 5.5).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "numerics/hash_random.h"
#include "numerics/scalar_math.h"
#include "numerics/vec3.h"
#include "recipe/recipe.h"
#include "synthesis/spot_kernel.h"

namespace astrolith {

class SpotLattice {
 public:
  // Cells of `cell_size` length units to an edge of 1, `density` impulses in an occupied one.
  SpotLattice(const SpotLayer& layer, double cell_size, double density, std::uint32_t seed);

  struct Cells {
    std::array<int, 3> first, last;
    double count() const;
  };
  // All cells whose impulses may lie in the box.
  Cells around(const Box& box) const;

  // Calls visit(impulse) for those of one cell.
  template <typename Visit>
  void draw_cell(int a, int b, int c, const Visit& visit) const {
    const std::uint32_t cell = hash_cell(seed_, a, b, c);
    if (!(static_cast<double>(unit_float(hash_append(cell, kOccupiedStream))) < probability_)) return;
    const std::uint32_t number = hash_append(cell, kCountStream);
    for (std::uint32_t l = 0; l < least_.size() && number >= least_[l]; ++l) {
      const auto random = [&](std::uint32_t k) { return unit_float(hash_append(cell, 4 * l + k)); };
      const auto along = [&](int index, std::uint32_t k) {
        return static_cast<float>(index) + math::fma(width_, random(k) - 0.5f, 0.5f);
      };
      const Vec3f p = position(along(a, 0), along(b, 1), along(c, 2));
      visit(SpotImpulse{p.x, p.y, p.z, math::fma(1.0f - least_weight_, random(3), least_weight_)});
    }
  }

 private:
  static constexpr std::uint32_t kCountStream = 0x636f756eu, kOccupiedStream = 0x6f636375u;

  Vec3f position(float a, float b, float c) const {
    const auto along = [&](float ea, float eb, float ec) {
      return math::fma(a, ea, math::fma(b, eb, c * ec));
    };
    return {along(a_.x, b_.x, c_.x), along(a_.y, b_.y, c_.y), along(a_.z, b_.z, c_.z)};
  }

  Vec3f a_, b_, c_;                 // edges of a cell, length units
  std::array<Vec3d, 3> cells_per_;  // their inverse: position to cells, per length unit
  std::uint32_t seed_;
  double probability_, reach_;
  float width_, least_weight_;
  std::vector<std::uint32_t> least_;  // a cell whose hash is at least the l-th of these has l + 1 impulses
};

}  // namespace astrolith
