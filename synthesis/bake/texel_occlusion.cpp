#include "synthesis/bake/texel_occlusion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "numerics/parallel_for.h"
#include "numerics/portable_angles.h"
#include "numerics/tangent_frame.h"

namespace astrolith {
namespace {

// Directions about +z with the density of the cosine: points of Hammersley's set on the disk, lifted to the
// sphere (Malley).
std::vector<Vec3f> cosine_directions(int count) {
  std::vector<Vec3f> directions;
  for (int i = 0; i < count; ++i) {
    double radical = 0.0, share = 0.5;  // base 2
    for (int bits = i; bits > 0; bits >>= 1, share *= 0.5) radical += (bits & 1) * share;
    const double r = std::sqrt((i + 0.5) / count);
    const auto [sine, cosine] = portable::sine_and_cosine(2.0 * std::numbers::pi * radical);
    directions.push_back(to_float({r * cosine, r * sine, std::sqrt(1.0 - r * r)}));
  }
  return directions;
}

}  // namespace

TexelOcclusion::TexelOcclusion(const TriangleMesh& mesh, double cell)
    : scene_(mesh),
      offset_(static_cast<float>(0.75 * cell)),
      directions_(cosine_directions(kPattern * kPattern)) {}

bool TexelOcclusion::is_open(int x, int y, const Vec3f& place, const Vec3f& normal) const {
  const auto number = static_cast<std::size_t>((y % kPattern) * kPattern + x % kPattern);
  const Vec3f above = place + normal * offset_, &d = directions_[number];
  const Vec3f origin = to_float(scene_.to_unit({double{above.x}, double{above.y}, double{above.z}}));
  const Tangents<float> frame = duff_tangents<SumRounding::kTwice>(normal, std::copysign(1.0f, normal.z));
  return !scene_.occluded(origin, frame.first * d.x + frame.second * d.y + normal * d.z);
}

std::vector<std::uint8_t> blurred_occlusion(std::span<const std::uint8_t> open, int side) {
  // Half weights at both ends give each place of the pattern the weight 1 along a row.
  constexpr int kReach = TexelOcclusion::kPattern / 2;
  constexpr std::array<int, 2 * kReach + 1> kWeights{1, 2, 2, 2, 2, 2, 2, 2, 1};
  std::vector<std::uint8_t> shares(open.size(), 255);
  const auto at = [side](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(side) + static_cast<std::size_t>(x);
  };
  parallel_for(0, side, [&](std::int64_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < side; ++x) {
      if (open[at(x, y)] == kNotCovered) continue;
      int sum = 0, weights = 0;
      for (int j = std::max(y - kReach, 0); j <= std::min(y + kReach, side - 1); ++j) {
        for (int i = std::max(x - kReach, 0); i <= std::min(x + kReach, side - 1); ++i) {
          const int value = open[at(i, j)];
          if (value == kNotCovered) continue;
          const int weight = kWeights[static_cast<std::size_t>(i - x + kReach)] *
                             kWeights[static_cast<std::size_t>(j - y + kReach)];
          sum += weight * value, weights += weight;
        }
      }
      shares[at(x, y)] = static_cast<std::uint8_t>((255 * sum + weights / 2) / std::max(weights, 1));
    }
  });
  return shares;
}

}  // namespace astrolith
