#include "synthesis/relief/relief_shares.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace astrolith {
namespace {

// The weights of the four places next to a point, which lies t in [0, 1] beyond the second.
std::array<double, 4> spline_weights(double t) {
  const double s = 1.0 - t;
  return {s * s * s / 6.0, 2.0 / 3.0 + t * t * (0.5 * t - 1.0), 2.0 / 3.0 + s * s * (0.5 * s - 1.0),
          t * t * t / 6.0};
}

}  // namespace

void ReliefShares::add(const Vec3f& p, std::vector<std::uint32_t>& places, std::vector<float>& shares) const {
  TiledPoint point;
  if (!find_in_tiles(tiles_, {p.x * inverse_spacing_, p.y * inverse_spacing_, p.z * inverse_spacing_}, point))
    return;
  const std::size_t begin = shares.size();
  double total = 0.0;
  for (std::size_t a = 0; a < 3; ++a) {
    if (point.tiles[a] == 0) continue;
    total += add_tile(static_cast<std::size_t>(point.tiles[a]), point.u(a), point.v(a), places, shares);
  }
  if (!(total > 0.0)) {
    places.resize(begin), shares.resize(begin);
    return;
  }
  for (std::size_t i = begin; i < shares.size(); ++i) shares[i] = static_cast<float>(shares[i] / total);
}

double ReliefShares::add_tile(std::size_t tile, double u, double v, std::vector<std::uint32_t>& places,
                              std::vector<float>& shares) const {
  const int i = std::min(static_cast<int>(u), kReliefCell - 1),
            j = std::min(static_cast<int>(v), kReliefCell - 1);
  const std::array<double, 4> wu = spline_weights(u - i), wv = spline_weights(v - j);
  double total = 0.0;
  for (std::size_t row = 0; row < 4; ++row) {
    for (std::size_t column = 0; column < 4; ++column) {
      const std::size_t at =
          (static_cast<std::size_t>(j) + row) * kReliefTileSide + static_cast<std::size_t>(i) + column;
      const std::uint32_t number = tiles_.places[tile * kReliefTileSize + at];
      if (number == kNoPlace) continue;
      const double share = wu[column] * wv[row] * places_[number].weight;
      places.push_back(number);
      shares.push_back(static_cast<float>(share));
      total += share;
    }
  }
  return total;
}

}  // namespace astrolith
