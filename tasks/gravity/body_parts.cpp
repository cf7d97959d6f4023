#include "tasks/gravity/body_parts.h"

#include <array>

#include "numerics/errors.h"

namespace astrolith {
namespace {

// Adds what a body of `weight` times unit density adds to the inertia about a point at -d from its centre.
void add_inertia(const BodyMass& mass, double weight, const Vec3d& d, Matrix3& inertia) {
  const std::array<double, 3> e{d.x, d.y, d.z};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double steiner = (i == k ? squared_norm(d) : 0.0) - e[i] * e[k];
      inertia[i][k] += weight * (mass.inertia[i][k] + mass.volume * steiner);
    }
  }
}

}  // namespace

BodyMass with_parts(const BodyMass& whole, const std::vector<BodyPart>& parts) {
  if (parts.empty()) return whole;
  BodyMass all;
  all.volume = whole.volume;
  all.center = whole.volume * whole.center;
  for (const BodyPart& part : parts) {
    all.volume += part.share * part.mass.volume;
    all.center += part.share * part.mass.volume * part.mass.center;
  }
  if (!(all.volume > 0.0)) throw InputError("--density-of: the parts leave no mass; give higher densities");
  all.center = all.center * (1.0 / all.volume);
  add_inertia(whole, 1.0, whole.center - all.center, all.inertia);
  for (const BodyPart& part : parts) {
    add_inertia(part.mass, part.share, part.mass.center - all.center, all.inertia);
  }
  return all;
}

void add_parts(const std::vector<BodyPart>& parts, const std::vector<Vec3d>& points, double tolerance,
               bool exact, const Progress& progress, std::vector<Attraction>& attractions) {
  for (const BodyPart& part : parts) {
    const PolyhedronGravity gravity(part.body.mesh, {}, progress);
    const std::vector<Attraction> own =
        exact ? gravity.exactly_at(points, progress).values : gravity.at(points, tolerance, progress);
    for (std::size_t i = 0; i < own.size(); ++i) {
      attractions[i].potential += part.share * own[i].potential;
      attractions[i].acceleration += part.share * own[i].acceleration;
    }
  }
}

}  // namespace astrolith
