#include "apps/fit_shape/fit_shape_details.h"

#include <fmt/format.h>

#include "cuda/candidate_evaluator.h"
#include "cuda/candidates_on_gpu.h"
#include "estimation/shape/details/residual_texture.h"
#include "numerics/errors.h"
#include "numerics/files/output_file.h"
#include "recipe/recipe_json.h"
#include "synthesis/field/implicit_field.h"
#include "synthesis/finish/lay_on_base.h"
#include "tasks/estimation/shape_recipe.h"
#include "tasks/synthesis/load_recipe.h"
#include "tasks/synthesis/variation_reference.h"

namespace astrolith {
namespace {

// Diagonal of the bare body's box, in the recipe's unit.
double size_of(const Recipe& recipe) {
  Recipe bare;
  bare.body = recipe.body;
  const Box box = ImplicitField(bare).bounds();
  if (box.empty()) throw InputError("body.iso_value: no point of the body reaches it; lower it");
  return box.diagonal();
}

// Reads a recipe whose layers can be scaled to another body.
Recipe read_details(const std::string& file) {
  Recipe other = load_recipe(file);
  if (!other.body) {
    throw InputError(file +
                     ": body: absent, so nobody knows how large its layers are; lay them on a body with "
                     "synth --base");
  }
  if (other.layers.empty()) throw InputError(file + ": layers: none; give a recipe with details");
  return other;
}

void declare_micro_options(Program& program, DetailArguments& arguments) {
  Option micro =
      program.app
          .add_option(
              "--micro", arguments.micro,
              "the finest detail: the Gabor layers of this recipe of fit_gabor; or auto: instead of the "
              "search, a Gabor layer learnt from what the metaballs leave of the mesh, down to the edges of "
              "50,000 triangles where it has more")
          .placeholder("ROCK.json|auto");
  program.app
      .add_option("--mm-per-px", arguments.mm_per_px,
                  "size of a pixel of the photo on the rock, with --micro")
      .check(above_zero())
      .default_text("")
      .needs(micro);
  program.app
      .add_option("--micro-height", arguments.micro_height_mm,
                  "root mean square height of the first layer of --micro in mm, the others in proportion: a "
                  "photo does not say it")
      .check(above_zero())
      .default_text("")
      .needs(micro);
}

}  // namespace

void declare_detail_options(Program& program, DetailArguments& arguments) {
  arguments.device.add_to(program.app);
  Option base_only = program.app.add_flag("--base-only", arguments.base_only,
                                          "metaballs alone, without a search for details");
  Option generations =
      program.app
          .add_option(
              "--generations", arguments.generations,
              "generations of the search for details, which makes population x generations evaluations; a "
              "mesh of more than 50,000 triangles is measured on about so many, and details narrower than "
              "two of their edges are not searched for")
          .check(in_range(1, 100000));
  program.app
      .add_option("--details", arguments.transfer,
                  "no search: the layers of this recipe, scaled by the ratio of the two bodies' sizes")
      .placeholder("OTHER.json")
      .excludes(base_only)
      .excludes(generations);
  declare_micro_options(program, arguments);
  Option variations =
      program.app
          .add_option("--variations", arguments.variations,
                      "also write this many other bodies of the same kind beside the recipe, as "
                      "RECIPE_variation_1.json ...")
          .check(in_range(0, 1000));
  program.app
      .add_option(
          "--delta", arguments.delta,
          "variations have a similarity with the mesh of at least 1 less this, as `compare` measures it")
      .check(in_range(1e-3, 1.0))
      .needs(variations);
}

void check_detail_inputs(const DetailArguments& arguments) {
  if (!arguments.transfer.empty()) read_details(arguments.transfer);
  if (!arguments.micro.empty() && arguments.micro != "auto") {
    Recipe unused;
    add_micro_layers(arguments, unused);
  }
}

DetailsFitResult search_details(Program& program, const TargetBody& target, const ShapeFitOptions& options,
                                const DetailArguments& arguments, EvaluationLog& log,
                                const Progress& progress, Recipe& recipe) {
  const ChosenDevice chosen = arguments.device.choose(program);
  const std::unique_ptr<CandidateEvaluator> evaluator =
      chosen ? candidates_on_gpu() : std::unique_ptr<CandidateEvaluator>();
  DetailsFitResult result =
      add_searched_details(target, options, arguments.generations, log, evaluator.get(), progress, recipe);
  program.say(fmt::format("details: {} candidates {}", result.optimization.evaluations, chosen.words));
  return result;
}

void transfer_details(const Program& program, const std::string& file, Recipe& recipe) {
  const Recipe other = read_details(file);
  const double ratio = size_of(recipe) / size_of(other);
  for (const Layer& layer : other.layers) recipe.layers.push_back(rescaled(layer, ratio));
  program.say(file + ": " + std::to_string(other.layers.size()) + " layers, lengths times " +
              fmt::format("{:.4g}", ratio));
}

void add_micro_layers(const DetailArguments& arguments, Recipe& recipe) {
  Recipe rock = load_recipe(arguments.micro);
  const double mm = recipe.length_unit == "km" ? 1e-6 : 1e-3;
  const GaborLayer* first = nullptr;
  for (const Layer& layer : rock.layers) {
    const auto* gabor = std::get_if<GaborLayer>(&layer);
    if (gabor == nullptr || !(gabor->height_rms > 0.0)) continue;
    if (first == nullptr) first = gabor;
  }
  if (first == nullptr) {
    throw InputError(arguments.micro +
                     ": layers: none is a Gabor layer with a height; give a recipe of fit_gabor");
  }
  if (rock.length_unit == "px" && !(arguments.mm_per_px > 0.0 && arguments.micro_height_mm > 0.0)) {
    throw InputError(arguments.micro + ": lengths are pixels; give --mm-per-px and --micro-height");
  }
  const double unit = rock.length_unit == recipe.length_unit ? 1.0 : rock.length_unit == "km" ? 1e3 : 1e-3;
  const double height =
      arguments.micro_height_mm > 0.0 ? mm * arguments.micro_height_mm / first->height_rms : unit;
  for (const Layer& layer : rock.layers) {
    if (const auto* gabor = std::get_if<GaborLayer>(&layer)) {
      GaborLayer micro = *gabor;
      micro.pixel_size = arguments.mm_per_px > 0.0 ? mm * arguments.mm_per_px : unit * gabor->pixel_size;
      micro.height_rms *= height;
      recipe.layers.push_back(micro);
    }
  }
}

std::string add_residual_texture(const TargetBody& target, std::uint64_t seed, const Progress& progress,
                                 Recipe& recipe) {
  ResidualTextureOptions options;
  options.seed = seed;
  const ResidualTexture texture =
      fit_residual_texture(target, in_target_frame(target, *recipe.body), options, progress);
  GaborLayer layer = texture.layer;
  layer.pixel_size = round_to_seven_digits(target.diagonal * layer.pixel_size);
  layer.height_rms = round_to_seven_digits(target.diagonal * layer.height_rms);
  recipe.layers.push_back(layer);
  return fmt::format("{} lobes from {} patches, height {:.3g} {} rms", layer.lobes.size(), texture.patches,
                     layer.height_rms, recipe.length_unit);
}

std::vector<std::filesystem::path> variation_files(const std::filesystem::path& fit, int count) {
  const std::string extension = is_compact_name(fit) ? std::string(kCompactExtension) : ".json";
  std::vector<std::filesystem::path> files;
  for (int k = 1; k <= count; ++k) {
    files.push_back(fit.parent_path() /
                    (fit.stem().string() + "_variation_" + std::to_string(k) + extension));
    require_writable(files.back());
  }
  return files;
}

nlohmann::ordered_json write_variations(const Program& program, const TargetBody& target,
                                        const Recipe& recipe, const DetailArguments& arguments,
                                        const std::vector<std::filesystem::path>& files) {
  const SimilarityMeasure similarity = similarity_with(target.surface);
  nlohmann::ordered_json figures = nlohmann::ordered_json::array();
  for (std::size_t k = 0; k < files.size(); ++k) {
    const Variation variation =
        find_variation(recipe, similarity, arguments.delta, k + 1, program.progress("variation"));
    write_loaded_recipe(variation.recipe, files[k]);
    figures.push_back(figures_of(variation));
    program.say(fmt::format("{}: similarity {:.4f} with the mesh; {}", files[k].string(),
                            variation.similarity, words_of(variation)));
    if (Program::interrupted()) break;
  }
  return figures;
}

}  // namespace astrolith
