// How far the surface may move at the places of a relief without meeting itself: where a body is thin,
// heights from elsewhere would cut it or close a gap, and make parts and handles.
#pragma once

#include <vector>

#include "synthesis/body/body_ground.h"
#include "synthesis/relief/relief_smoothing.h"

namespace astrolith {

// Brings heights at places as near to `own` ones as the bare body needs there. A place has room below to the
// depth d if at each depth d' up to d the body is solid and s at least d' / 2, and room above likewise in
// empty space. Rooms are looked for up to R, three times the largest change D of any height. With the room R
// on both sides a height stays; with less, r on one of them, it moves by D u^2 at most, where
// u = max(r / R - .3, 0) / .7. `heights` and `own` are in the order of the points, and `scale` makes them
// lengths in the unit of the points.
void keep_room(const BodyGround& body, const ReliefPoints& points, double scale,
               const std::vector<double>& own, std::vector<double>& heights);

}  // namespace astrolith
