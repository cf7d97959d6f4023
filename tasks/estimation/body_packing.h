// A body filled with spheres that do not overlap, in the frame and the unit of its file.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "estimation/shape/packing/sphere_packing.h"
#include "estimation/shape/target/target_body.h"
#include "numerics/progress.h"

namespace astrolith {

struct BodyPackingOptions {
  int spheres = 200;         // at most, > 0
  std::string unit = "km";   // of the file: "m" or "km"
  double density = 0.0;      // kg / m^3, >= 0; 0 = no masses
  std::string name, tool;    // of the file and of the program, for the title of the table
  std::filesystem::path to;  // the table to write (.csv); empty: none
};

struct BodyPacking {
  std::vector<Sphere> spheres;  // in the frame and the unit of the file, the largest first
  std::vector<double> masses;   // kg, one for each sphere; empty without a density
  double filling_rate = 0.0;    // volume of the spheres over the volume of the body
  bool interrupted = false;     // progress asked to stop; the spheres are the ones placed so far
};

// Throws InputError if the table cannot be written.
BodyPacking pack_body(const TargetBody& target, const BodyPackingOptions& options, const Progress& progress);

// "12 spheres fill 61.03 % of the volume"
std::string packing_words(const BodyPacking& packing);

}  // namespace astrolith
