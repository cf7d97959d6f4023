// The steps of fit_shape after the base: the search for details, and measures of the whole recipe.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/device_option.h"
#include "apps/program.h"
#include "estimation/shape/details/detailed_check.h"
#include "estimation/shape/details/details_fit.h"
#include "estimation/shape/fit/shape_fit.h"

namespace astrolith {

struct DetailArguments {
  bool base_only = false;
  int generations = 100;
  std::string details;  // "relief", "thesis", or a recipe whose layers are taken; "": not settled yet
  std::string micro;    // a recipe of Gabor layers, "auto", or nothing
  double mm_per_px = 0.0, micro_height_mm = 0.0;  // scale of the micro layers; 0 = as the recipe says
  int variations = 0;
  double delta = 0.2;
  DeviceOption device;  // computes the search

  bool keeps_relief() const { return details == "relief"; }
  bool searches() const { return details == "thesis"; }
  // Whether the layers of another recipe are taken.
  bool transfers() const { return !details.empty() && !keeps_relief() && !searches(); }
};

// Declares the options that fill in the arguments.
void declare_detail_options(Program& program, DetailArguments& arguments);

// Chooses the details where the command line does not: the relief, or a search where its options are given.
void settle_details(const Program& program, DetailArguments& arguments);

// Throws InputError where options contradict each other or a recipe that they name cannot be used. Programs
// call it before long work.
void check_detail_inputs(const Program& program, const DetailArguments& arguments);

// Adds the layers that the search finds to the recipe (in the file's frame, with its body). The optimiser and
// its population are the base fit's; candidates that the log knows are not measured again.
DetailsFitResult search_details(Program& program, const TargetBody& target, const ShapeFitOptions& options,
                                const DetailArguments& arguments, EvaluationLog& log,
                                const Progress& progress, Recipe& recipe);

// FIT.json becomes FIT_variation_K.json, and FIT.astro becomes FIT_variation_K.astro, K from 1. Throws
// InputError for the first that cannot be written.
std::vector<std::filesystem::path> variation_files(const std::filesystem::path& fit, int count);

// Writes variations of the recipe, each with its measured similarity to the target. Returns the figures of
// each.
nlohmann::ordered_json write_variations(const Program& program, const TargetBody& target,
                                        const Recipe& recipe, const DetailArguments& arguments,
                                        const std::vector<std::filesystem::path>& files);

}  // namespace astrolith
