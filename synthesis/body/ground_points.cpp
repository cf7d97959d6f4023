#include "synthesis/body/ground_points.h"

#include <limits>

#include "synthesis/body/metaball_body.h"
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
  Box box;
  for (std::size_t i = 0; i < points.size(); ++i) box.extend({points.x[i], points.y[i], points.z[i]});
  const ReachingMetaballs reaching = metaballs_reaching(ground.body, ground.arrays, ground.metaballs, box);
  evaluate_body(ground.body, ground.arrays, reaching.lists(), static_cast<int>(points.size()),
                points.x.data(), points.y.data(), points.z.data(), points.distance.data(), points.gx.data(),
                points.gy.data(), points.gz.data());
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
