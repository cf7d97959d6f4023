#include "synthesis/field/listed_landforms.h"

#include <algorithm>
#include <cmath>

namespace astrolith {
namespace {

bool reaches_patch(const Vec3d& center, double radius, const std::optional<PatchCube>& cube) {
  if (!cube) return true;
  Vec3d d = center - cube->center;
  double side = cube->side;
  if (cube->turned) {
    const GroundAxes& axes = cube->turned->axes;
    d = {dot(d, axes.right), dot(d, axes.ahead), dot(d, axes.up)};
    side = cube->turned->side;
  }
  const auto beyond = [&](double x) { return std::max(std::abs(x) - 0.5 * side, 0.0); };
  return norm(Vec3d{beyond(d.x), beyond(d.y), beyond(d.z)}) <= radius;
}

}  // namespace

bool is_resolved(const ListedLandform& landform, double cell) {
  constexpr double kAcross = 2.0, kHigh = 0.1;  // cells
  const PlacedCrater* const crater = landform.crater;
  if (crater != nullptr)
    return crater->diameter >= kAcross * cell && crater->depth + crater->rim_height >= kHigh * cell;
  const PlacedBoulder& boulder = *landform.boulder;
  return boulder.axes.y >= kAcross * cell && (1.0 - boulder.burial) * boulder.axes.z >= kHigh * cell;
}

std::vector<ListedLandform> listed_landforms(const ImplicitField& field,
                                             const std::optional<PatchCube>& patch) {
  std::vector<ListedLandform> listed;
  for (const LayerCraters& layer : field.craters()) {
    for (const PlacedCrater& c : layer.craters) {
      if (reaches_patch(c.position, 0.5 * c.diameter, patch)) listed.push_back({layer.layer, &c, nullptr});
    }
  }
  for (const LayerBoulders& layer : field.boulders()) {
    for (const PlacedBoulder& b : layer.boulders) {
      if (reaches_patch(b.center, 0.5 * std::max({b.axes.x, b.axes.y, b.axes.z}), patch))
        listed.push_back({layer.layer, nullptr, &b});
    }
  }
  return listed;
}

}  // namespace astrolith
