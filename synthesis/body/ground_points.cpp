#include "synthesis/body/ground_points.h"

#include <limits>

#include "numerics/scalar_math.h"
#include "synthesis/body/local_metaballs.h"
#include "synthesis/body/surface_projection.h"

namespace astrolith {

GroundPoints::GroundPoints(const std::vector<Vec3d>& points) : GroundPoints(points.size()) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    x[i] = static_cast<float>(points[i].x);
    y[i] = static_cast<float>(points[i].y);
    z[i] = static_cast<float>(points[i].z);
  }
}

void evaluate(const BodyGround& ground, GroundPoints& points) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Vec3f low{kInfinity, kInfinity, kInfinity}, high = low * -1.0f;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3f p = points.at(i);
    low = {math::min(low.x, p.x), math::min(low.y, p.y), math::min(low.z, p.z)};
    high = {math::max(high.x, p.x), math::max(high.y, p.y), math::max(high.z, p.z)};
  }
  const Vec3d origin = ground.origin != nullptr ? *ground.origin : Vec3d{};
  const Box box{Vec3d{low.x, low.y, low.z} + origin, Vec3d{high.x, high.y, high.z} + origin};
  const ReachingMetaballs reaching = metaballs_reaching(ground.body, ground.arrays, ground.metaballs, box);
  const int n = static_cast<int>(points.size());
  auto& [x, y, z, distance, gx, gy, gz] = points;
  if (ground.origin != nullptr) {
    evaluate_local_metaballs(plain_metaballs(ground.body, ground.arrays, reaching.lists()), origin, n,
                             x.data(), y.data(), z.data(), distance.data(), gx.data(), gy.data(), gz.data());
  } else {
    evaluate_body(ground.body, ground.arrays, reaching.lists(), n, x.data(), y.data(), z.data(),
                  distance.data(), gx.data(), gy.data(), gz.data());
  }
}

void project(const BodyGround& ground, GroundPoints& points) {
  const float floor = ground.arrays[ground.body.leaves][0].metaballs.gradient_floor;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const float length = gradient_length(points.gx[i], points.gy[i], points.gz[i], floor);
    const auto along = [&](float p, float g) {
      return projected_coordinate(p, g, length, points.distance[i], std::numeric_limits<float>::max());
    };
    points.x[i] = along(points.x[i], points.gx[i]);
    points.y[i] = along(points.y[i], points.gy[i]);
    points.z[i] = along(points.z[i], points.gz[i]);
  }
}

}  // namespace astrolith
