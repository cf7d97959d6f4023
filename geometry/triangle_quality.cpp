#include "geometry/triangle_quality.h"

#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "numerics/parallel_for.h"
#include "numerics/sample_statistics.h"

namespace astrolith {

float triangle_quality(const Vec3f& a, const Vec3f& b, const Vec3f& c) {
  constexpr float kTwiceRootOfThree = 3.46410162f;
  const Vec3f ab = b - a, ac = c - a;
  const float edges = squared_norm(ab) + squared_norm(ac) + squared_norm(c - b);
  return edges > 0.0f ? kTwiceRootOfThree * norm(cross(ab, ac)) / edges : 0.0f;
}

QualityFigures quality_of(std::span<const MeshVertex> vertices, std::span<const Triangle> triangles) {
  constexpr std::int64_t kGrain = 4096;
  constexpr std::size_t kPercent = 100;
  if (triangles.empty()) return {};
  std::vector<float> quality(triangles.size());
  parallel_for(
      0, static_cast<std::int64_t>(quality.size()),
      [&](std::int64_t i) {
        const Triangle& t = triangles[static_cast<std::size_t>(i)];
        quality[static_cast<std::size_t>(i)] =
            triangle_quality(vertices[t[0]].position, vertices[t[1]].position, vertices[t[2]].position);
      },
      kGrain);
  const double mean = std::accumulate(quality.begin(), quality.end(), 0.0) / double(quality.size());
  const std::size_t first = quality.size() / kPercent;
  return {double{ranked_value(std::move(quality), first)}, mean};
}

}  // namespace astrolith
