// The body whose gravity is asked for.
#pragma once

#include <filesystem>
#include <string>

#include "apps/program.h"
#include "geometry/triangle_mesh.h"

namespace astrolith {

struct GravityBody {
  TriangleMesh mesh;    // closed, counter-clockwise from outside
  std::string unit;     // of its coordinates
  double metres = 1.0;  // per unit
};

// Reads a shape model, whose unit the caller states, or a recipe (.json), which states its own and is meshed
// with `resolution` cells along its longest side. An empty unit stands for that of the recipe, or km. Throws
// InputError for files that are no closed body.
GravityBody read_gravity_body(const Program& program, const std::filesystem::path& file,
                              const std::string& unit, int resolution);

}  // namespace astrolith
