// All spheres of a body and of the bodies that it is combined with.
#pragma once

#include <vector>

#include "recipe/body.h"

namespace astrolith {

template <typename Body, typename Visit>
void for_each_sphere(Body& body, const Visit& visit) {
  for (auto& sphere : body.spheres) visit(sphere);
  for (auto& operation : body.operations) {
    for (auto& operand : operation.operand) for_each_sphere(operand, visit);
  }
}

inline std::vector<Sphere> all_spheres(const MetaballBody& body) {
  std::vector<Sphere> spheres;
  for_each_sphere(body, [&](const Sphere& s) { spheres.push_back(s); });
  return spheres;
}

}  // namespace astrolith
