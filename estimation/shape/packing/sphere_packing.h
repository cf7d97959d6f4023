// Greedy polydisperse packing of a closed body: spheres of different sizes that lie inside and do not
// overlap, the largest first (thesis section 4.3.2, algorithm 3; Weller and Zachmann, "Protosphere", 2010).
//
// In the paper random prototypes climb to the Voronoi nodes of the surface and the spheres placed so far.
// Here nothing is random: a grid holds the clearance of every place
// (estimation/shape/packing/clearance_grid.h). The place of largest clearance climbs to its node, away from
// the nearest obstacle, by exact distances and with steps that grow shorter. The sphere is placed there, and
// the clearance around it is lowered. A packing is written as a table for spreadsheets and gravity codes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "geometry/surface/surface_tree.h"
#include "geometry/triangle_mesh.h"
#include "numerics/progress.h"
#include "recipe/recipe.h"

namespace astrolith {

struct PackingOptions {
  int max_spheres = 200;          // > 0
  double smallest_radius = 1e-4;  // fraction of the bounding-box diagonal, > 0
};

struct Packing {
  std::vector<Sphere> spheres;  // largest first
  double filling_rate = 0.0;    // volume of the spheres over the volume of the body
  bool interrupted = false;     // progress asked to stop; the spheres are the ones placed so far
};

// `body` is closed with positive volume, and `tree` was made of it. The result does not depend on the number
// of threads. Fewer than max_spheres come back if no place of smallest_radius is left, or none that the grid
// resolves. Its cells are about a seventh of the spheres' mean diameter wide, and wider if the body fills
// little of its bounding box.
Packing pack_spheres(const TriangleMesh& body, const SurfaceTree& tree, const PackingOptions& options,
                     const Progress& progress = {});

struct PackingTable {
  std::string title;         // first comment line
  std::string length_unit;   // "m" or "km": the unit of centres and radii
  double body_volume = 0.0;  // length_unit^3
  double density = 0.0;      // kg / m^3, >= 0; 0 leaves the masses out
};

// The mass of each sphere in kg. The spheres share the mass of the whole body in proportion to their volumes,
// so that the mascons (point masses at the centres) weigh as much as the body.
std::vector<double> sphere_masses(const std::vector<Sphere>& spheres, const PackingTable& table);

// Writes the columns x, y, z and radius, and the masses if a density is given. Throws InputError if the file
// cannot be written.
void write_packing_table(const std::vector<Sphere>& spheres, const PackingTable& table,
                         const std::filesystem::path& file);

}  // namespace astrolith
