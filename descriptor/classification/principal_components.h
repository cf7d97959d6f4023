// Principal components: the few directions along which feature vectors vary most.
#pragma once

#include <span>
#include <vector>

namespace astrolith {

using FeatureRows = std::vector<std::vector<float>>;  // (#shapes x #features)

struct PrincipalComponents {
  std::vector<float> mean;  // (#features)
  FeatureRows axes;         // (#components x #features) orthonormal, sorted by falling variance

  // (#components) the coordinates of a vector (#features) along the axes.
  std::vector<float> apply(std::span<const float> features) const;
};

// Computes principal components with OpenCV. Throws InputError unless 1 <= components <= min(#shapes - 1,
// #features).
PrincipalComponents principal_components(const FeatureRows& rows, int components);

}  // namespace astrolith
