#include "synthesis/relief/relief_room.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

constexpr double kShare = 1.0 / 3.0;  // of the room that a height may use
// With this share of the wanted room a place keeps its own height. Creases of a neck are so finely balanced
// that changes of a tenth of an edge make parts of a few triangles in them.
constexpr double kNone = 0.3;
constexpr std::size_t kSteps = 12;   // depths that are looked at on each side of the surface
constexpr std::size_t kPlaces = 64;  // looked at together

// The distance s at `kSteps` depths below (sign 1) or heights above (sign -1) some places.
class Depths {
 public:
  Depths(const BodyGround& body, const ReliefPoints& points, std::size_t first, std::size_t count,
         double most, double sign) {
    std::vector<float> x(kSteps * count), y(x), z(x), gx(x), gy(x), gz(x);
    std::size_t n = 0;
    for (std::size_t i = first; i < first + count; ++i) {
      for (std::size_t k = 1; k <= kSteps; ++k, ++n) {
        const double depth = most * static_cast<double>(k) / static_cast<double>(kSteps);
        const Vec3f p = to_float(points.at(i) - sign * depth * points.normal(i));
        x[n] = p.x, y[n] = p.y, z[n] = p.z;
      }
    }
    evaluate_body(body.body, body.arrays, body.metaballs, static_cast<int>(n), x.data(), y.data(), z.data(),
                  s_.data(), gx.data(), gy.data(), gz.data());
    for (std::size_t i = 0; i < n; ++i) s_[i] *= static_cast<float>(sign);
  }

  // The least depth at which the body, or the space above it, is not solid any more: `most` where there is
  // none, and between the steps by the straight line through both.
  double room(std::size_t place, double most) const {
    const double step = most / static_cast<double>(kSteps);
    double before = 0.0;  // how much more s is than it must be
    for (std::size_t k = 0; k < kSteps; ++k) {
      const double depth = step * static_cast<double>(k + 1),
                   more = double{s_[kSteps * place + k]} - 0.5 * depth;
      if (more < 0.0) return depth + step * (before > more ? more / (before - more) : -1.0);
      before = more;
    }
    return most;
  }

 private:
  std::array<float, kSteps * kPlaces> s_;
};

}  // namespace

void keep_room(const BodyGround& body, const ReliefPoints& points, double scale,
               const std::vector<double>& own, std::vector<double>& heights) {
  double change = 0.0;
  for (std::size_t i = 0; i < own.size(); ++i) change = std::max(change, std::fabs(heights[i] - own[i]));
  if (!(change > 0.0)) return;
  const double most = scale * change / kShare;
  const std::size_t blocks = (own.size() + kPlaces - 1) / kPlaces;
  parallel_for(0, static_cast<std::int64_t>(blocks), [&](std::int64_t block) {
    const std::size_t first = kPlaces * static_cast<std::size_t>(block),
                      count = std::min(kPlaces, own.size() - first);
    const Depths below(body, points, first, count, most, 1.0), above(body, points, first, count, most, -1.0);
    for (std::size_t i = 0; i < count; ++i) {
      const double of_place = own[first + i];
      const double room = std::min(below.room(i, most), above.room(i, most)) / most,
                   share = std::max(room - kNone, 0.0) / (1.0 - kNone), free = change * share * share;
      double& height = heights[first + i];
      height = of_place + std::clamp(height - of_place, -free, free);
    }
  });
}

}  // namespace astrolith
