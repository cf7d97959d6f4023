// What fit_shape does after the base: details by search, and measures of the whole recipe.
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
  std::string transfer;                           // a recipe whose layers are taken instead of a search
  std::string micro;                              // a recipe of Gabor layers, "auto", or nothing
  double mm_per_px = 0.0, micro_height_mm = 0.0;  // of the recipe's layers; 0 = as the recipe says
  int variations = 0;
  double delta = 0.2;
  DeviceOption device;  // of the search
};

// Declares the options that fill these in.
void declare_detail_options(Program& program, DetailArguments& arguments);

// Throws InputError where a recipe that the options name cannot be used: better before long work than after.
void check_detail_inputs(const DetailArguments& arguments);

// Adds the layers that the search finds to the recipe (in the file's frame, with its body). The optimiser and
// its population are the base fit's; candidates that the log knows are not measured again.
DetailsFitResult search_details(Program& program, const TargetBody& target, const ShapeFitOptions& options,
                                const DetailArguments& arguments, EvaluationLog& log,
                                const Progress& progress, Recipe& recipe);

// Adds the layers of another recipe, scaled by the ratio of the two bodies' bounding-box diagonals.
void transfer_details(const Program& program, const std::string& file, Recipe& recipe);

// Of a whole recipe, in the target's frame, as fit_shape checks its base.
FitCheck check_recipe(const TargetBody& target, const Recipe& recipe, const ShapeFitOptions& options);

// Sets the fit's similarity, of the mesh in its check, and its floor: by the descriptor that `compare` uses
// by default (ahd), 5,000 points each.
void measure_similarity(const TargetBody& target, const ShapeFitOptions& options, ShapeFitResult& fit);

// Adds the Gabor layers of --micro RECIPE to the recipe, as its finest detail.
void add_micro_layers(const DetailArguments& arguments, Recipe& recipe);

// --micro auto: a Gabor layer of what the base leaves of the target. Returns a sentence about it.
std::string add_residual_texture(const TargetBody& target, std::uint64_t seed, const Progress& progress,
                                 Recipe& recipe);

// FIT.json becomes FIT_variation_K.json, K from 1. Throws InputError for the first that cannot be written.
std::vector<std::filesystem::path> variation_files(const std::filesystem::path& fit, int count);

// Writes variations of the recipe, each with its measured similarity to the target; returns these.
std::vector<double> write_variations(const Program& program, const TargetBody& target, const Recipe& recipe,
                                     const DetailArguments& arguments,
                                     const std::vector<std::filesystem::path>& files);

// For the summary: what the search did, and how rough target and details are at each lag.
nlohmann::ordered_json details_json(const DetailsFitResult& details);

}  // namespace astrolith
