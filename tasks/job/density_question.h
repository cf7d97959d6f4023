// The question that a density far below that of any body raises.
#pragma once

#include <fmt/format.h>

#include "tasks/job/job.h"

namespace astrolith {

// Says so where a density in kg/m^3 looks like one in g/cm^3: comets have some 500 kg/m^3, fresh snow 100.
inline void question_density(const Job& job, double density) {
  if (!(density > 0.0 && density < 50.0)) return;
  job.say(fmt::format("note: a density of {:g} kg/m^3 is that of no solid; for {:g} g/cm^3 give {:g}",
                      density, density, 1000.0 * density));
}

}  // namespace astrolith
