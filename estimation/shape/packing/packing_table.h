// A sphere packing as a table that spreadsheets and gravity codes read: CSV with a line for each sphere,
// largest first, under comment lines that state what it holds.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "estimation/shape/packing/sphere_packing.h"

namespace astrolith {

struct PackingTable {
  std::string title;         // first comment line
  std::string length_unit;   // "m" or "km", of centres and radii
  double body_volume = 0.0;  // length_unit^3
  double density = 0.0;      // kg / m^3; 0 = no masses
};

// Columns x, y, z, radius and, where a density is given, mass in kg: spheres share the mass of the whole body
// by their volumes, so that the mascons (point masses at the centres) weigh what the body weighs. Throws
// InputError when the file cannot be written.
void write_packing_table(const std::vector<Sphere>& spheres, const PackingTable& table,
                         const std::filesystem::path& file);

}  // namespace astrolith
