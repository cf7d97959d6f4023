// The craters and boulders of a body in the order in which the feature list has them.
#pragma once

#include <optional>
#include <vector>

#include "synthesis/field/implicit_field.h"
#include "synthesis/landforms/boulder_field.h"
#include "synthesis/landforms/crater_relief.h"

namespace astrolith {

// A crater or a boulder. The other pointer is null. Both point into the field's tables.
struct ListedLandform {
  int layer = 0;  // number in the recipe
  const PlacedCrater* crater = nullptr;
  const PlacedBoulder* boulder = nullptr;
};

// Whether a mesh whose cells have this side, in length units, shows the landform: two cells or more lie
// across the rim of a crater, or across the second axis of a boulder, and the landform rises or sinks by a
// tenth of a cell or more. A crater's floor lies depth + rim_height below its rim; a boulder stands (1 -
// burial) axis_c above the ground, as if it lay flat.
bool is_resolved(const ListedLandform& landform, double cell);

// All craters, in the order in which they fell, and then all boulders. For a patch those whose rim or rock
// reaches into the cube. The result lives as long as the field.
std::vector<ListedLandform> listed_landforms(const ImplicitField& field,
                                             const std::optional<PatchCube>& patch);

}  // namespace astrolith
