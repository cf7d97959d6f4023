// A closed mesh becomes a recipe of metaballs and details: the job of the program fit_shape.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "estimation/shape/details/details_fit.h"
#include "estimation/shape/fit/shape_fit.h"
#include "estimation/shape/packing/sphere_packing.h"
#include "estimation/shape/target/target_body.h"
#include "numerics/progress.h"
#include "tasks/job/albedo_option.h"
#include "tasks/job/device_option.h"
#include "tasks/job/job.h"
#include "tasks/repair/shape_repair.h"

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

struct DetailArguments {
  bool base_only = false;
  int generations = 100;
  // "relief", "thesis", "auto", or a recipe whose layers are taken; "": not settled yet
  std::string details;
  std::string relief_spacing;  // of heights (relief_spacing_words()); "": as the model is fine
  std::string micro;           // a recipe of Gabor layers, "auto", or nothing
  double mm_per_px = 0.0, micro_height_mm = 0.0;  // scale of the micro layers; 0 = as the recipe says
  int variations = 0;
  double delta = 0.2;
  DeviceOption device;  // computes the search

  // Whether heights are kept where the model allows them, and the metaballs alone elsewhere.
  bool chosen_by_job() const { return details == "auto"; }
  bool keeps_relief() const { return details == "relief" || chosen_by_job(); }
  // Whether the recipe gets heights, where the model allows them.
  bool makes_relief() const { return keeps_relief() && !base_only && micro != "auto"; }
  // Whether a spacing of heights was asked for.
  bool gives_spacing() const { return !relief_spacing.empty() && relief_spacing != "auto"; }
  bool searches() const { return details == "thesis"; }
  // Whether the layers of another recipe are taken.
  bool transfers() const { return !details.empty() && !keeps_relief() && !searches(); }
};

// Declares the options that fill in the arguments.
void declare_detail_options(Job& job, DetailArguments& arguments);

// Chooses the details where the command line does not: the relief, or a search where its options are given.
void settle_details(const Job& job, DetailArguments& arguments);

// Throws InputError where options contradict each other or a recipe that they name cannot be used. Programs
// call it before long work.
void check_detail_inputs(const Job& job, const DetailArguments& arguments);

// Adds the layers that the search finds to the recipe (in the file's frame, with its body). The optimiser and
// its population are the base fit's; candidates that the log knows are not measured again.
DetailsFitResult search_details(Job& job, const TargetBody& target, const ShapeFitOptions& options,
                                const DetailArguments& arguments, EvaluationLog& log,
                                const Progress& progress, Recipe& recipe);

// FIT.json becomes FIT_variation_K.json, and FIT.astro becomes FIT_variation_K.astro, K from 1.
std::vector<std::filesystem::path> variation_files(const std::filesystem::path& fit, int count);

// Writes variations of the recipe, each with its measured similarity to the target. Returns the figures of
// each.
nlohmann::ordered_json write_variations(const Job& job, const TargetBody& target, const Recipe& recipe,
                                        const DetailArguments& arguments,
                                        const std::vector<std::filesystem::path>& files);

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
  AlbedoOption albedo;
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
