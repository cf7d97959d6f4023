// The spheres of a body and of all operands of its operations.
#pragma once

#include <vector>

#include "recipe/body.h"

namespace astrolith {

// Calls visit(sphere) for all spheres, including subtractive ones.
template <typename Body, typename Visit>
void for_each_sphere(Body& body, const Visit& visit) {
  for (auto& sphere : body.spheres) visit(sphere);
  for (auto& sphere : body.subtract) visit(sphere);
  for (auto& operation : body.operations) {
    for (auto& operand : operation.operand) for_each_sphere(operand, visit);
  }
}

// All spheres except subtractive ones. The operands of differences are included.
inline std::vector<Sphere> adding_spheres(const MetaballBody& body) {
  std::vector<Sphere> spheres = body.spheres;
  for (const BodyOperation& operation : body.operations) {
    for (const MetaballBody& operand : operation.operand) {
      const std::vector<Sphere> operand_spheres = adding_spheres(operand);
      spheres.insert(spheres.end(), operand_spheres.begin(), operand_spheres.end());
    }
  }
  return spheres;
}

}  // namespace astrolith
