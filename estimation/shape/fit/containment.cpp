#include "estimation/shape/fit/containment.h"

#include <algorithm>

namespace astrolith {
namespace {

// Points on each side of the surface: their number and their least distance from the surface.
constexpr int kContainmentPoints = 2000;
constexpr double kContainmentDepth = 0.015;  // fraction of the diagonal

// Shells of points on both sides of the surface, at these distances from it (fractions of the diagonal). No
// island with a size of a few hundredths fits between two shells.
constexpr double kShells[] = {0.008, 0.016, 0.032};
constexpr double kShellShare = 0.25;  // points in a shell, as a share of the surface samples

}  // namespace

FitPoints containment_points(const TargetBody& target, const ContainmentOptions& options) {
  FitPoints points;
  add_containment_points(target, std::min(kContainmentDepth, 0.5 * options.deepest), kContainmentPoints,
                         options.seed, points);
  const auto in_shell = static_cast<int>(kShellShare * static_cast<double>(options.samples));
  for (const double distance : kShells) {
    add_shell_points(target, distance, in_shell, options.shell_seed, points);
  }
  add_middle_points(target, kShells[0], in_shell, options.shell_seed, points);
  return points;
}

}  // namespace astrolith
