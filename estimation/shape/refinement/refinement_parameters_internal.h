// The parameters of a model while it is refined.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "estimation/shape/model/block_kernels.h"
#include "estimation/shape/model/metaball_model.h"

namespace astrolith {

// The parameters are the centre and the log radius of each sphere, and t for the sharpness kappa:
//   log kappa = middle + half tanh(t / half).
// This keeps kappa between limits. A lone sphere has the same surface at every kappa, so its residuals alone
// would leave kappa undetermined.
struct RefinementParameters {
  explicit RefinementParameters(const MetaballModel& model)
      : middle(0.5 * std::log(kSoftest * kSharpest)), half(0.5 * std::log(kSharpest / kSoftest)) {
    const double part = (std::log(model.sharpness) - middle) / half;
    sharpness = half * std::atanh(std::clamp(part, -0.99, 0.99));
    for (const ModelSphere& s : model.spheres) {
      spheres.push_back({s.center.x, s.center.y, s.center.z, std::log(s.radius)});
      subtractive.push_back(s.subtractive);
    }
  }
  MetaballModel model() const {
    MetaballModel m{std::exp(middle + half * std::tanh(sharpness / half)), {}};
    for (std::size_t i = 0; i < spheres.size(); ++i) {
      const SphereDerivatives& s = spheres[i];
      m.spheres.emplace_back(Vec3d{s[0], s[1], s[2]}, std::exp(s[3]), subtractive[i]);
    }
    return m;
  }
  // Adds a step: four numbers for each sphere, then one for the sharpness.
  void add(const double* step) {
    for (SphereDerivatives& s : spheres) {
      for (double& value : s) value += *step++;
    }
    sharpness += *step;
  }
  // d log kappa / dt
  double sharpness_slope() const { return 1.0 - std::pow(std::tanh(sharpness / half), 2); }

  static constexpr double kSoftest = 0.3, kSharpest = 30.0;  // limits of kappa

  double middle, half;
  std::vector<SphereDerivatives> spheres;
  std::vector<bool> subtractive;  // (#spheres) does not change
  double sharpness = 0.0;         // t
};

}  // namespace astrolith
