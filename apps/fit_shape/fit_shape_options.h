// The command line of fit_shape.
#pragma once

#include <string>

#include "apps/fit_shape/fit_shape_details.h"
#include "apps/program.h"
#include "apps/shape_repair.h"
#include "estimation/shape/fit/shape_fit.h"

namespace astrolith {

struct FitArguments {
  std::string mesh, output, report, checkpoint;
  std::string mesh_sha256;  // of the file as it was read
  std::string optimizer = "pso";
  std::string unit;         // of the mesh, once settled
  double time_limit = 0.0;  // seconds; 0 = none
  int noise_seeds = 3;      // of the verdict on the surface; 0 = no verdict
  bool packing_only = false;
  double density = 0.0;  // kg / m^3; 0 = no masses
  ShapeFitOptions fit;
  DetailArguments details;
  ShapeRepair repair;
};

// Declares the options that fill in the arguments.
void declare_fit_options(Program& program, FitArguments& arguments);

// Turns the words of the options into the fit's settings, and sets its seed.
void settle_fit_options(const Program& program, FitArguments& arguments);

}  // namespace astrolith
