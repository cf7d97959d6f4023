// A closed mesh becomes a recipe of metaballs and details: the job of the program fit_shape.
#pragma once

#include <optional>
#include <string>

#include "estimation/shape/fit/shape_fit.h"
#include "tasks/estimation/body_packing.h"
#include "tasks/estimation/fit_shape_details.h"
#include "tasks/job/job.h"
#include "tasks/repair/shape_repair.h"

namespace astrolith {

struct FitArguments {
  std::string mesh;                        // the file, or what messages call the mesh in memory
  std::optional<TriangleMesh> in_memory;   // in place of the file
  std::string output, report, checkpoint;  // empty: none
  std::string mesh_sha256;                 // of the file as it was read, or of the mesh in memory
  std::string optimizer = "pso";
  std::string unit;  // of the mesh, once settled
  bool unit_assumed = false;
  double time_limit = 0.0;  // seconds; 0 = none
  int noise_seeds = 3;      // of the verdict on the surface; 0 = no verdict
  bool packing_only = false;
  int bytes = 0;         // of the whole compact recipe, at most; 0 = any. fit.bytes are those of its body
  double density = 0.0;  // kg / m^3; 0 = no masses
  ShapeFitOptions fit;
  DetailArguments details;
  ShapeRepair repair;
};

// Declares the options that fill in the arguments.
void declare_fit_options(Job& job, FitArguments& arguments);

struct FittedShape {
  Recipe recipe;
  BodyPacking packing;  // of a job that only packs; it has no recipe
};

// Fits the mesh and writes the files that the arguments name. The summary gets the figures of the fit. A job
// that is stopped, or whose time is over, ends with its best so far. Throws InputError for arguments that
// contradict one another and for a mesh that cannot be fitted, and WorkError where there is nothing to keep.
FittedShape fit_shape(Job& job, FitArguments& arguments);

// Turns the words of the options into the fit's settings, and sets its seed.
void settle_fit_options(const Job& job, FitArguments& arguments);

// Throws InputError for a relief that was asked for and that the target, whatever its metaballs, cannot have.
void check_relief(const TargetBody& target, const FitArguments& arguments);

// Sets the number of the metaballs and their bytes, which the details of this target leave to them.
void settle_metaballs(const Job& job, const TargetBody& target, FitArguments& arguments);

}  // namespace astrolith
