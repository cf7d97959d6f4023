// What a point takes from the places of a relief around it, in double precision, for those who choose
// heights.
#pragma once

#include <cstdint>
#include <vector>

#include "synthesis/relief/relief_places.h"
#include "synthesis/relief/relief_tiles.h"

namespace astrolith {

// A point of the lattice takes shares[k] of the height at places[k]. The shares sum to 1, as height_at()
// (relief_noise.h) blends heights on smooth ground; at folds it weighs maps by their reach, too.
class ReliefShares {
 public:
  // Expects places in the order of find_relief_places() and their tiles, which must outlive this, and their
  // spacing in length units.
  ReliefShares(const std::vector<ReliefPlace>& places, const ReliefTiles& tiles, double spacing)
      : places_(places), tiles_(tiles), inverse_spacing_(1.0 / spacing) {}

  // Appends what a point, in length units, takes. Appends nothing where no place has a weight.
  void add(const Vec3f& p, std::vector<std::uint32_t>& places, std::vector<float>& shares) const;

 private:
  double add_tile(std::size_t tile, double u, double v, std::vector<std::uint32_t>& places,
                  std::vector<float>& shares) const;

  const std::vector<ReliefPlace>& places_;
  const ReliefTiles& tiles_;
  double inverse_spacing_;
};

}  // namespace astrolith
