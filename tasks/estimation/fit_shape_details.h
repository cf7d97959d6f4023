// The steps of fit_shape after the base: the search for details, and measures of the whole recipe.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "estimation/shape/details/detailed_check.h"
#include "estimation/shape/details/details_fit.h"
#include "estimation/shape/fit/shape_fit.h"
#include "tasks/job/device_option.h"
#include "tasks/job/job.h"

namespace astrolith {

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

}  // namespace astrolith
