// Level and first-order signed distance of a metaball model at many points. Both run in parallel, and the
// results do not depend on the number of threads. The equations are those of metaball_model.h and
// block_kernels.h.
#pragma once

#include <span>
#include <vector>

#include "estimation/shape/model/metaball_model.h"

namespace astrolith {

// The level L of every point: 0 on the surface, positive inside, without unit.  (#points)
std::vector<double> model_levels(const MetaballModel& model, std::span<const Vec3d> points);

// The first-order signed distance s of every point: positive inside, in length units.  (#points)
std::vector<double> model_distances(const MetaballModel& model, std::span<const Vec3d> points);

}  // namespace astrolith
