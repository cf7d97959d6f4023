// A sphere packing as a table for spreadsheets and gravity codes. The file is CSV with one line for each
// sphere, the largest first, below comment lines that state title and units.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "estimation/shape/packing/sphere_packing.h"

namespace astrolith {

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
