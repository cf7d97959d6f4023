#include "synthesis/field/surface_crossing.h"

#include <array>
#include <cmath>
#include <cstddef>

namespace astrolith {
namespace {

constexpr std::size_t kPoints = 65;

struct Stretch {
  double low, high;

  double at(std::size_t k) const { return low + (high - low) * (static_cast<double>(k) / (kPoints - 1)); }
};

using Values = std::array<float, kPoints>;

Values values_along(const ImplicitField& field, const Vec3d& from, const Vec3d& direction, const Stretch& t) {
  Values x, y, z, values;
  Box box;
  for (std::size_t k = 0; k < kPoints; ++k) {
    const Vec3d p = from + t.at(k) * direction;
    x[k] = static_cast<float>(p.x);
    y[k] = static_cast<float>(p.y);
    z[k] = static_cast<float>(p.z);
    box.extend({x[k], y[k], z[k]});
  }
  field.gather(box).evaluate(x, y, z, values);
  return values;
}

// The part of the stretch between two neighbours on different sides, those that lie nearest to t = 0.
std::optional<Stretch> narrowed(const Values& values, const Stretch& t) {
  std::optional<Stretch> nearest;
  for (std::size_t k = 0; k + 1 < kPoints; ++k) {
    if ((values[k] > 0.0f) == (values[k + 1] > 0.0f)) continue;
    const Stretch part{t.at(k), t.at(k + 1)};
    if (!nearest || std::abs(part.low + part.high) < std::abs(nearest->low + nearest->high)) nearest = part;
  }
  return nearest;
}

}  // namespace

std::optional<Vec3d> nearest_crossing(const ImplicitField& field, const Vec3d& from, const Vec3d& direction,
                                      double reach) {
  std::optional<Stretch> t = Stretch{-reach, reach};
  for (int round = 0; t && round < 3; ++round) {
    t = narrowed(values_along(field, from, direction, *t), *t);
  }
  if (!t) return std::nullopt;
  return from + 0.5 * (t->low + t->high) * direction;
}

}  // namespace astrolith
