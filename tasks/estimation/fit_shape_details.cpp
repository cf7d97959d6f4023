#include "tasks/estimation/fit_shape.h"

#include <fmt/format.h>

#include "cuda/candidate_evaluator.h"
#include "cuda/candidates_on_gpu.h"
#include "numerics/errors.h"
#include "numerics/files/output_file.h"
#include "recipe/recipe_json.h"
#include "tasks/description/variation_reference.h"
#include "tasks/estimation/detail_layers.h"
#include "tasks/estimation/relief_size.h"
#include "tasks/estimation/shape_recipe.h"
#include "tasks/job/load_recipe.h"

namespace astrolith {
namespace {

void declare_micro_options(Job& job, DetailArguments& arguments) {
  Option micro =
      job.options
          .add_option(
              "--micro", arguments.micro,
              "the finest detail: the Gabor layers of this recipe of fit_gabor; or auto: instead of a "
              "relief, a Gabor layer learnt from what the metaballs leave of the mesh, down to the edges of "
              "50,000 triangles where it has more")
          .placeholder("ROCK.json|auto")
          .reads(recipe_and_images);
  job.options
      .add_option("--mm-per-px", arguments.mm_per_px,
                  "size of a pixel of the photo on the rock, with --micro")
      .check(above_zero())
      .default_text("")
      .needs(micro);
  job.options
      .add_option("--micro-height", arguments.micro_height_mm,
                  "root mean square height of the first layer of --micro in mm, the others in proportion: a "
                  "photo does not say it")
      .check(above_zero())
      .default_text("")
      .needs(micro);
}

}  // namespace

void declare_detail_options(Job& job, DetailArguments& arguments) {
  arguments.device.add_to(job.options);
  Option base_only =
      job.options.add_flag("--base-only", arguments.base_only, "metaballs alone, without details");
  job.options
      .add_option(
          "--generations", arguments.generations,
          "generations of the search for details, which makes population x generations evaluations; a "
          "mesh of more than 50,000 triangles is measured on about so many, and details narrower than "
          "two of their edges are not searched for")
      .check(in_range(1, 100000));
  job.options
      .add_option(
          "--details", arguments.details,
          "relief: the measured surface itself, as heights over the metaballs that a picture or a compact "
          "recipe holds. thesis: the search for the 34 parameters of three noises. Or the layers of this "
          "recipe, scaled by the ratio of the two bodies' sizes. auto: the relief where the mesh is fine "
          "enough, "
          "else the metaballs alone")
      .default_text("auto; thesis with --generations")
      .placeholder("auto|relief|thesis|OTHER.json")
      .reads(recipe_and_images)
      .excludes(base_only);
  job.options
      .add_option(
          "--relief-spacing", arguments.relief_spacing,
          "of the heights of a relief, in the mesh's unit, or with a unit behind the number: m, km, or "
          "edges, the mean edges of the mesh; larger ones make smaller recipes. auto: as fine as the mesh")
      .check(relief_spacing_words())
      .placeholder("L[m|km|edges]|auto")
      .default_text("auto")
      .excludes(base_only);
  declare_micro_options(job, arguments);
  Option variations =
      job.options
          .add_option("--variations", arguments.variations,
                      "also write this many other bodies of the same kind beside the recipe, as "
                      "RECIPE_variation_1.json ...")
          .check(in_range(0, 1000));
  job.options
      .add_option(
          "--delta", arguments.delta,
          "variations have a similarity with the mesh of at least 1 less this, as `compare` measures it")
      .check(in_range(1e-3, 1.0))
      .needs(variations);
}

void settle_details(const Job& job, DetailArguments& arguments) {
  if (!arguments.details.empty()) return;
  arguments.details = job.options.option("--generations").count() > 0 ? "thesis" : "auto";
}

void check_detail_inputs(const Job& job, const DetailArguments& arguments) {
  if (job.options.option("--generations").count() > 0 && !arguments.searches()) {
    throw InputError("--generations: are those of --details thesis; give that too, or leave them out");
  }
  if (arguments.gives_spacing() && !arguments.makes_relief())
    throw InputError("--relief-spacing: is about --details relief; give that, or leave it out");
  Recipe unused;
  if (arguments.transfers()) unused.layers = read_details(arguments.details).layers;
  if (!arguments.micro.empty() && arguments.micro != "auto") {
    add_micro_layers(arguments.micro, arguments.mm_per_px, arguments.micro_height_mm, unused);
  }
}

DetailsFitResult search_details(Job& job, const TargetBody& target, const ShapeFitOptions& options,
                                const DetailArguments& arguments, EvaluationLog& log,
                                const Progress& progress, Recipe& recipe) {
  const ChosenDevice chosen = arguments.device.choose(job);
  const std::unique_ptr<CandidateEvaluator> evaluator =
      chosen ? candidates_on_gpu() : std::unique_ptr<CandidateEvaluator>();
  DetailsFitResult result =
      add_searched_details(target, options, arguments.generations, log, evaluator.get(), progress, recipe);
  job.say(fmt::format("details: {} candidates tried{}", result.optimization.evaluations, chosen.remark()));
  return result;
}

std::vector<std::filesystem::path> variation_files(const std::filesystem::path& fit, int count) {
  const std::string extension = is_compact_name(fit) ? std::string(kCompactExtension) : ".json";
  std::vector<std::filesystem::path> files;
  for (int k = 1; k <= count; ++k) {
    files.push_back(fit.parent_path() /
                    (fit.stem().string() + "_variation_" + std::to_string(k) + extension));
  }
  return files;
}

nlohmann::ordered_json write_variations(const Job& job, const TargetBody& target, const Recipe& recipe,
                                        const DetailArguments& arguments,
                                        const std::vector<std::filesystem::path>& files) {
  const SimilarityMeasure similarity = similarity_with(target.surface);
  nlohmann::ordered_json figures = nlohmann::ordered_json::array();
  for (std::size_t k = 0; k < files.size(); ++k) {
    const Variation variation =
        find_variation(recipe, similarity, arguments.delta, k + 1, job.progress("variation"));
    write_loaded_recipe(variation.recipe, files[k]);
    figures.push_back(to_json(variation));
    job.say(fmt::format("{}: similarity {:.4f} with the mesh; {}", files[k].string(), variation.similarity,
                        describe(variation)));
    if (job.stopped()) break;
  }
  return figures;
}

}  // namespace astrolith
