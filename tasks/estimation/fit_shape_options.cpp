#include "tasks/estimation/fit_shape.h"

#include <fmt/format.h>

#include <algorithm>

#include "estimation/shape/report/fit_report.h"
#include "geometry/io/mesh_format.h"
#include "geometry/mesh_measure.h"
#include "numerics/errors.h"
#include "tasks/estimation/relief_size.h"
#include "tasks/job/density_question.h"
#include "tasks/job/load_recipe.h"
#include "tasks/repair/mesh_unit.h"

namespace astrolith {
namespace {

// Heights over 200 are hardly nearer and take more bytes (docs/accuracy.md#relief).
constexpr int kMetaballsUnderRelief = 80;
// With fewer bytes metaballs alone come nearer (docs/accuracy.md#relief).
constexpr int kFewestBytesForRelief = 6000;
constexpr int kFewestBytesForBoth = 400;
constexpr double kFewestSpacings = 8.0;  // of heights along the diagonal of a body

// The input, the output and the fit of the metaballs.
void declare_base_options(OptionTable& app, FitArguments& arguments) {
  app.add_option("mesh", arguments.mesh,
                 "mesh of a closed body (" + read_mesh_words() + "); takes some 750 bytes of memory a facet")
      .required()
      .placeholder("MESH")
      .reads();
  app.add_option("-o,--output", arguments.output,
                 "the recipe to write, as JSON or compact (.astro); with --packing-only a .csv")
      .required()
      .placeholder("RECIPE.json")
      .writes([&arguments](const auto& words) {
        std::vector<std::string> recipes = words;
        for (const auto& file : variation_files(words.front(), arguments.details.variations))
          recipes.push_back(file.string());
        return recipe_and_relief(recipes);
      });
  app.add_option("--spheres", arguments.fit.spheres, "largest number of metaballs")
      .check(in_range(1, 10000))
      .default_text("80 under a relief, else 200, or as --bytes allow");
  app.add_option(
         "--bytes", arguments.bytes,
         "the most bytes of the result as a compact recipe (RECIPE.astro), for the least error: the numbers "
         "of the metaballs are rounded, and heights are as many as fit. Without --spheres the number of "
         "metaballs follows from the bytes, some 4 each, and there are no heights below 6,000 bytes unless "
         "--details relief asks for them. The recipe has no provenance then")
      .check(in_range(100, 10000000))
      .default_text("");
  app.add_option(
         "--subtract", arguments.fit.subtract,
         "largest share of the metaballs that may be subtractive; 0: none, for mascons or other programs")
      .check(in_range(0.0, 0.9));
  app.add_option("--points", arguments.fit.points,
                 "samples of the surface that the refinement sees; 0 = 120 a metaball")
      .check(in_range(std::int64_t{0}, std::int64_t{10000000}));
  app.add_option("--optimizer", arguments.optimizer,
                 "optimizer of the base's global parameters and of the details")
      .check(one_of({"pso", "crs2", "isres", "esch", "sbplx"}));
  app.add_option("--population", arguments.fit.population, "population of the optimizer")
      .check(in_range(1, 10000));
}

// The end of a fit, its checkpoint and its unit.
void declare_run_options(OptionTable& app, FitArguments& arguments) {
  app.add_option(
         "--tolerance", arguments.fit.tolerance,
         "no more metaballs once the mean distance is below this fraction of the bounding-box diagonal")
      .check(zero_or_more());
  app.add_option("--time-limit", arguments.time_limit,
                 "seconds after which the best so far is written, measured figures included; 0 = none. The "
                 "result then depends on the machine. A step that has begun is ended first, such as the "
                 "sampling of the surface or the mesh of the result, some seconds each. Where reading and "
                 "checking the mesh takes longer than the limit, there is nothing to write, and the program "
                 "ends with a line that says how long they need")
      .check(zero_or_more());
  app.add_option(
         "--noise-seeds", arguments.noise_seeds,
         "meshes of the result, each with another seed of its noise, that are compared with the target's "
         "surface: whether it passes, and what it lacks, as compare --realism says it; medians over the "
         "seeds, some five processor seconds each. 0: no verdict")
      .check(in_range(0, 100));
  app.add_option(
         "--checkpoint", arguments.checkpoint,
         "keep the progress of the fit in this file; where the file exists, go on from there. The result is "
         "the result of a run without a stop")
      .placeholder("FILE.json")
      .writes();
  app.add_option(
         "--unit", arguments.unit,
         "length unit of the mesh's coordinates, in place of what its file states; km where neither says one")
      .check(one_of({"km", "m"}))
      .default_text("");
  arguments.repair.add_to(app);
}

// The packing of spheres, and the report, which a packing does not have.
void declare_packing_options(OptionTable& app, FitArguments& arguments) {
  Option packing_only = app.add_flag(
      "--packing-only", arguments.packing_only,
      "fill the body with --spheres spheres that do not overlap, write their centres and radii as "
      "a table, and stop");
  for (const char* option :
       {"--subtract", "--points", "--optimizer", "--population", "--generations", "--base-only", "--details",
        "--relief-spacing", "--variations", "--tolerance", "--time-limit", "--noise-seeds", "--checkpoint"}) {
    packing_only.excludes(app.option(option));
  }
  app.add_option("--density", arguments.density,
                 "density of the body in kg/m^3: the table then holds a mass for each sphere (mascons)")
      .check(above_zero())
      .needs(packing_only)
      .default_text("");
  app.add_option(
         "--report", arguments.report,
         "write a page, index.html, with target and fit to turn, and pictures of both, of distances and "
         "convergence here")
      .excludes(packing_only)
      .placeholder("DIR")
      .writes(fit_report_files);
}

}  // namespace

void declare_fit_options(Job& job, FitArguments& arguments) {
  declare_base_options(job.options, arguments);
  declare_detail_options(job, arguments.details);
  declare_run_options(job.options, arguments);
  declare_packing_options(job.options, arguments);
  arguments.albedo.add_to(job.options);
  Option bytes = job.options.option("--bytes");
  for (const char* option : {"--packing-only", "--variations", "--micro", "--relief-spacing", "--albedo"}) {
    bytes.excludes(job.options.option(option));
  }
}

void settle_fit_options(const Job& job, FitArguments& arguments) {
  arguments.fit.seed = job.seed;
  if (!arguments.in_memory) {
    const MeshUnit unit = resolve_unit(job, arguments.mesh, {arguments.unit}, {"km", "m"});
    arguments.unit = unit.name;
    arguments.unit_assumed = unit.assumed;
  }
  arguments.fit.length_unit = arguments.unit;
  if (arguments.bytes > 0 && !arguments.details.base_only && !arguments.details.keeps_relief()) {
    throw InputError(
        "--bytes: counts those of metaballs and heights, to which other details would add; add "
        "--base-only or --details relief");
  }
  question_density(job, arguments.density);
  arguments.fit.optimizer = optimizer_from_name(arguments.optimizer);
}

void check_relief(const TargetBody& target, const FitArguments& arguments) {
  const DetailArguments& details = arguments.details;
  if (!details.makes_relief()) return;
  if (!details.chosen_by_job() || details.gives_spacing()) expect_relief(target);
  if (!details.chosen_by_job() && arguments.bytes > 0 && arguments.bytes < kFewestBytesForBoth) {
    throw InputError(
        fmt::format("--bytes: {} hold no heights beside metaballs; give {} or more, or --base-only",
                    arguments.bytes, kFewestBytesForBoth));
  }
  if (!details.gives_spacing()) return;
  const double edge = target.diagonal * mean_edge(target.surface), least = edge / kMostReliefEdge;
  const double most = target.diagonal * norm(target.surface.bounds().extent()) / kFewestSpacings;
  const double spacing = parse_relief_spacing(details.relief_spacing, arguments.unit, edge);
  if (spacing >= least && spacing <= most) return;
  throw InputError(
      fmt::format("--relief-spacing: is {:.4g} {}, and this model bears {:.4g} to {:.4g}; take one of these",
                  spacing, arguments.unit, least, most));
}

void settle_metaballs(const Job& job, const TargetBody& target, FitArguments& arguments) {
  DetailArguments& details = arguments.details;
  if (details.chosen_by_job() && arguments.bytes > 0 && arguments.bytes < kFewestBytesForRelief)
    details.base_only = true;
  const bool relief = details.makes_relief() && can_have_relief(target);
  ShapeFitOptions& fit = arguments.fit;
  fit.bytes = arguments.bytes;
  if (job.options.option("--spheres").count() == 0) {
    // Under a relief half of few bytes are the heights'.
    if (arguments.bytes > 0) fit.spheres = spheres_for_bytes(relief ? arguments.bytes / 2 : arguments.bytes);
    if (relief) fit.spheres = std::min(fit.spheres, kMetaballsUnderRelief);
  }
  if (relief && arguments.bytes > 0) fit.bytes = std::min(fit.bytes, bytes_for_spheres(fit.spheres));
}

}  // namespace astrolith
