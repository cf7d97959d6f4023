// fit_shape: a closed mesh becomes a recipe of metaballs.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <string>

#include "apps/fit_checkpoint.h"
#include "apps/fit_shape_details.h"
#include "apps/known_bodies.h"
#include "apps/option_checks.h"
#include "apps/program.h"
#include "estimation/shape/fit_report.h"
#include "estimation/shape/packing_table.h"
#include "estimation/shape/shape_fit.h"
#include "geometry/mesh_io.h"
#include "numerics/errors.h"
#include "numerics/output_file.h"
#include "numerics/output_folder.h"
#include "recipe/recipe_json.h"
#include "recipe/sha256.h"

namespace astrolith {
namespace {

struct Arguments {
  std::string mesh, output, report, checkpoint;
  std::string optimizer = "pso";
  std::string kernel = "gaussian";
  std::string unit = "km";
  double time_limit = 0.0;  // seconds; 0 = none
  bool packing_only = false;
  double density = 0.0;  // kg / m^3; 0 = no masses
  ShapeFitOptions fit;
  DetailArguments details;
};

Kernel kernel_named(const std::string& word) {
  return *std::find_if(std::begin(kKernels), std::end(kKernels),
                       [&](Kernel kernel) { return kernel_word(kernel) == word; });
}

// Asks a stage to stop when its share of the time, counted from the start of the program's work, is over.
class TimeLimit {
 public:
  explicit TimeLimit(double seconds) : seconds_(seconds) {}

  Progress guard(Progress progress, const std::string& stage) {
    if (seconds_ <= 0.0) return progress;
    const bool last = stage != "pack" && stage != "search";
    const double end = last ? seconds_ - reserve() : seconds_ * (stage == "pack" ? 0.1 : 0.25);
    return [this, last, end, progress = std::move(progress)](double fraction, std::string_view words) {
      const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start_;
      const bool over = spent.count() > end;
      // Of the earlier stages only their shares are over: that is no early stop.
      reached_ = reached_ || (over && last);
      return progress(fraction, words) && !over;
    };
  }
  // What meshing and measuring the result take, at most half of all.
  double reserve() const { return std::min(4.0, 0.5 * seconds_); }
  bool reached() const { return reached_; }

 private:
  double seconds_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::atomic<bool> reached_{false};
};

void add_options(Program& program, Arguments& arguments) {
  CLI::App& app = program.app;
  app.add_option("mesh", arguments.mesh, "closed mesh: obj, ply, stl, off, PDS plate .tab, ICQ, bmf")
      ->required()
      ->option_text("MESH");
  app.add_option("-o,--output", arguments.output, "the recipe to write; with --packing-only a .csv")
      ->required()
      ->option_text("RECIPE.json");
  app.add_option("--spheres", arguments.fit.spheres, "metaballs at most")->check(CLI::Range(1, 10000));
  app.add_option("--kernel", arguments.kernel, "of the metaballs")
      ->check(CLI::IsMember({"gaussian", "metaball", "soft_object", "wyvill", "cauchy"}));
  app.add_option("--points", arguments.fit.points,
                 "samples of the surface that the refinement sees; 0 = 120 a metaball")
      ->check(CLI::Range(std::int64_t{0}, std::int64_t{10000000}));
  app.add_option("--optimizer", arguments.optimizer,
                 "of the global parameters of the base, and of the details")
      ->check(CLI::IsMember({"pso", "crs2", "isres", "esch", "sbplx", "cmaes"}));
  app.add_option("--population", arguments.fit.population, "of the optimizer")->check(CLI::Range(1, 10000));
  declare_detail_options(program, arguments.details);
  app.add_option(
         "--tolerance", arguments.fit.tolerance,
         "no more metaballs once the mean distance is below this fraction of the bounding-box diagonal")
      ->check(zero_or_more());
  app.add_option("--time-limit", arguments.time_limit,
                 "seconds after which the best so far is written, measured figures included; 0 = none. The "
                 "result then "
                 "depends on the machine")
      ->check(zero_or_more());
  app.add_option("--checkpoint", arguments.checkpoint,
                 "keep here what a run that is stopped need not do again; where the file exists, go on from "
                 "there. The result is that of a run without a stop")
      ->option_text("FILE.json");
  app.add_option("--unit", arguments.unit,
                 "length unit of the mesh's coordinates; what a file may say of it in a comment is not read")
      ->check(CLI::IsMember({"km", "m"}));
  CLI::Option* packing_only = app.add_flag(
      "--packing-only", arguments.packing_only,
      "fill the body with --spheres spheres that do not overlap, write their centres and radii as "
      "a table, and stop");
  for (const char* option :
       {"--kernel", "--points", "--optimizer", "--population", "--generations", "--base-only", "--details",
        "--variations", "--tolerance", "--time-limit", "--checkpoint"}) {
    packing_only->excludes(app.get_option(option));
  }
  app.add_option("--density", arguments.density,
                 "of the body in kg/m^3: the table then holds a mass for each sphere (mascons)")
      ->check(above_zero())
      ->needs(packing_only)
      ->default_str("");
  app.add_option("--report", arguments.report,
                 "write a page, index.html, with pictures of target, fit, distances and convergence here")
      ->excludes(packing_only)
      ->option_text("DIR");
}

// Fractions of the bounding-box diagonal, except counts and ratios.
std::vector<std::pair<std::string, double>> achieved(const ShapeFitResult& fit) {
  const SurfaceDistanceReport& d = fit.check.distance;
  return {{"max_distance", d.max},
          {"mean_distance", d.mean},
          {"p99_distance", d.p99},
          {"similarity", fit.similarity},
          {"similarity_floor", fit.similarity_floor},
          {"volume_ratio", fit.check.volume_ratio}};
}

// Without layers, and without what it achieved.
Recipe recipe_of(const Program& program, const Arguments& arguments, const ShapeFitResult& fit) {
  Recipe recipe;
  recipe.length_unit = arguments.unit;
  recipe.seed = program.seed;
  recipe.provenance.tool = program.tool();
  recipe.provenance.input_name = std::filesystem::path(arguments.mesh).filename().string();
  recipe.provenance.input_sha256 = sha256_of_file(arguments.mesh);
  recipe.provenance.options = program.given_options();
  recipe.body = fit.body;
  return recipe;
}

void note_achieved(const ShapeFitResult& fit, Recipe& recipe) {
  recipe.provenance.achieved.clear();
  for (auto [name, value] : achieved(fit)) {
    recipe.provenance.achieved.emplace_back(name, round_to_seven_digits(value));
  }
}

// The finished base from the checkpoint, or a new one.
ShapeFitResult fit_base(const Program& program, const Arguments& arguments, const TargetBody& target,
                        TimeLimit& limit, FitCheckpoint& checkpoint) {
  if (checkpoint.base() != nullptr) {
    ShapeFitResult base = *checkpoint.base();
    measure_fit(target, arguments.fit, base);
    return base;
  }
  const ShapeFitResult fit = fit_shape(target, arguments.fit, [&](const std::string& stage) {
    return limit.guard(program.progress(stage), stage);
  });
  if (!Program::interrupted() && !limit.reached()) checkpoint.keep_base(fit);
  return fit;
}

// Adds details to the recipe, and to the summary; the fit's figures become those of both together.
void add_details(Program& program, const Arguments& arguments, const TargetBody& target, TimeLimit& limit,
                 FitCheckpoint& checkpoint, ShapeFitResult& fit, Recipe& recipe) {
  const SurfaceDistanceReport& d = fit.check.distance;
  program.summary["base"] = {{"mean_distance", d.mean}, {"p99_distance", d.p99}, {"max_distance", d.max}};
  const DetailArguments& wanted = arguments.details;
  if (wanted.micro == "auto") {
    program.say("micro: " +
                add_residual_texture(target, arguments.fit.seed, program.progress("micro"), recipe));
  } else if (!wanted.transfer.empty()) {
    transfer_details(program, wanted.transfer, recipe);
  } else if (!wanted.base_only) {
    const Progress progress = checkpoint.guard(limit.guard(program.progress("details"), "details"));
    const DetailsFitResult details =
        search_details(target, arguments.fit, wanted, checkpoint.log(), progress, recipe);
    checkpoint.save();
    program.summary["details"] = details_json(details);
  }
  if (!wanted.micro.empty() && wanted.micro != "auto") add_micro_layers(wanted, recipe);
  fit.check = check_recipe(target, recipe, arguments.fit);
  measure_similarity(target, arguments.fit, fit);
}

void summarize(Program& program, const ShapeFitResult& fit, bool stopped) {
  nlohmann::ordered_json& summary = program.summary;
  summary["spheres"] = fit.body.spheres.size();
  for (const auto& [name, value] : achieved(fit)) summary[name] = value;
  summary["closed"] = fit.check.topology.closed;
  summary["manifold"] = fit.check.topology.manifold;
  summary["components"] = fit.check.topology.components;
  summary["genus"] = fit.check.topology.genus;
  summary["similarity_features"] = "ahd";
  summary["filling_rate"] = fit.filling_rate;
  summary["base_spheres"] = fit.base_spheres;
  summary["base_similarity"] = fit.base_similarity;
  summary["sharpness"] = fit.body.blend_exponent * fit.body.a;
  summary["evaluations"] = fit.evaluations;
  summary["stopped_early"] = stopped;
}

void say_result(const Program& program, const TargetBody& target, const ShapeFitResult& fit,
                bool with_details) {
  const SurfaceDistanceReport& d = fit.check.distance;
  char line[200];
  std::snprintf(
      line, sizeof line,
      "%zu metaballs%s: mean distance %.4f %%, p99 %.4f %%, max %.4f %% of the diagonal; similarity %.2f %% "
      "(two samplings of the target: %.2f %%)",
      fit.body.spheres.size(), with_details ? " and details" : "", 100 * d.mean, 100 * d.p99, 100 * d.max,
      100 * fit.similarity, 100 * fit.similarity_floor);
  program.say(line);
  if (fit.check.topology.components != target.components) {
    program.say("note: the fit has " + std::to_string(fit.check.topology.components) + " parts, the target " +
                std::to_string(target.components) + "; give it more --spheres");
  }
}

// Centres and radii in the frame and the unit of the file.
std::vector<Sphere> in_file_frame(std::vector<Sphere> spheres, const TargetBody& target) {
  for (Sphere& s : spheres) {
    s = {target.center + target.diagonal * s.center, target.diagonal * s.radius};
  }
  return spheres;
}

// --packing-only
void pack(Program& program, const Arguments& arguments, const TargetBody& target) {
  PackingOptions options;
  options.max_spheres = arguments.fit.spheres;
  const Packing packing = pack_spheres(target.mesh, target.tree, options, program.progress("pack"));
  const std::string name = std::filesystem::path(arguments.mesh).filename().string();
  char filled[80];
  std::snprintf(filled, sizeof filled, "%zu spheres fill %.2f %% of the volume", packing.spheres.size(),
                100.0 * packing.filling_rate);
  const double unit_volume = target.diagonal * target.diagonal * target.diagonal;
  write_packing_table(in_file_frame(packing.spheres, target),
                      {name + " by " + program.tool() + ": " + filled, arguments.unit,
                       target.volume * unit_volume, arguments.density},
                      arguments.output);
  if (packing.interrupted) program.say("stopped by Ctrl-C: these are the spheres so far");
  program.summary["spheres"] = packing.spheres.size();
  program.summary["filling_rate"] = packing.filling_rate;
  program.say(arguments.output + ": " + filled);
}

void say_wrong_unit(const Program& program, const Arguments& arguments, const TargetBody& target) {
  const std::string name = std::filesystem::path(arguments.mesh).filename().string();
  const std::string remark =
      unit_remark(name, target.volume * std::pow(target.diagonal, 3), arguments.unit == "km" ? 1000.0 : 1.0);
  if (!remark.empty()) program.say("note: " + arguments.mesh + ": " + remark);
}

void run(Program& program, Arguments& arguments) {
  // Before minutes of work: can the results be written at all?
  require_writable(arguments.output);
  if (!arguments.checkpoint.empty()) {
    require_writable(arguments.checkpoint);
    require_two_files(arguments.checkpoint, arguments.output);
    require_other_file(arguments.checkpoint, arguments.mesh);
  }
  const auto variations = variation_files(arguments.output, arguments.details.variations);
  check_detail_inputs(arguments.details);
  if (!arguments.report.empty()) require_folder_can_be_made(arguments.report);
  TimeLimit limit(arguments.time_limit);
  arguments.fit.seed = program.seed;
  arguments.fit.kernel = kernel_named(arguments.kernel);
  arguments.fit.optimizer = optimizer_from_name(arguments.optimizer);
  const TargetBody target = prepare_target(read_mesh(arguments.mesh), arguments.mesh);
  for (const std::string& remark : target.remarks) program.say(arguments.mesh + ": " + remark);
  say_wrong_unit(program, arguments, target);
  if (arguments.packing_only) return pack(program, arguments, target);

  FitCheckpoint checkpoint(arguments.checkpoint,
                           {program.tool(), sha256_of_file(arguments.mesh), program.given_options()});
  if (checkpoint.resumed()) program.say(arguments.checkpoint + ": going on from there");
  ShapeFitResult fit = fit_base(program, arguments, target, limit, checkpoint);
  Recipe recipe = recipe_of(program, arguments, fit);
  const bool with_details = !arguments.details.base_only || !arguments.details.micro.empty();
  if (with_details && !Program::interrupted() && !limit.reached()) {
    add_details(program, arguments, target, limit, checkpoint, fit, recipe);
  }
  if (Program::interrupted()) program.say("stopped by Ctrl-C: this is the best so far");
  if (limit.reached()) program.say("stopped at the time limit: this is the best so far");
  note_achieved(fit, recipe);
  write_recipe(recipe, arguments.output);
  if (!arguments.report.empty()) {
    write_fit_report(target, fit, std::filesystem::path(arguments.mesh).filename().string(),
                     arguments.report);
  }
  summarize(program, fit, Program::interrupted() || limit.reached());
  program.summary["diagonal"] = target.diagonal;  // what the distances are fractions of
  program.summary["length_unit"] = arguments.unit;
  if (!variations.empty() && !Program::interrupted()) {
    program.summary["variations"] = write_variations(program, target, recipe, arguments.details, variations);
  }
  say_result(program, target, fit, !recipe.layers.empty());
}

}  // namespace
}  // namespace astrolith

int main(int argc, char** argv) {
  astrolith::Program program("fit_shape", "Fits metaballs to a closed mesh and writes them as a recipe.");
  astrolith::Arguments arguments;
  astrolith::add_options(program, arguments);
  return program.run(argc, argv, [&] { astrolith::run(program, arguments); });
}
