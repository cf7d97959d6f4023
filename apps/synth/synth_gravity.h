// Gravity with synth's mesh.
#pragma once

#include <vector>

#include "apps/program.h"
#include "geometry/io/ply_values.h"
#include "geometry/triangle_mesh.h"
#include "recipe/recipe.h"

namespace astrolith {

struct GravityRequest {
  std::vector<double> density_and_period;  // kg/m3 and hours, 0 hours = at rest; empty = no gravity

  bool wanted() const { return !density_and_period.empty(); }
};

// Throws InputError for a density that is not above 0, a period below 0, and a recipe without a length unit.
void check_gravity(const GravityRequest& request, const Recipe& recipe);

// Potentials, accelerations, slopes and elevations at the vertices of a whole mesh, to 1e-6 of the
// acceleration. The summary states their ranges and the error of a random sample.
std::vector<VertexValues> vertex_gravity(Program& program, const GravityRequest& request,
                                         const Recipe& recipe, const TriangleMesh& mesh);

}  // namespace astrolith
