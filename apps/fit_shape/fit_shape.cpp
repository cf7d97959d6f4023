// fit_shape: a closed mesh becomes a recipe of metaballs.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <optional>
#include <string>

#include "apps/counted.h"
#include "apps/fit_shape/fit_shape_details.h"
#include "apps/fit_shape/fit_shape_options.h"
#include "apps/fit_shape/fit_shape_packing.h"
#include "apps/output_names.h"
#include "apps/program.h"
#include "apps/unit_question.h"
#include "estimation/shape/details/imaged_ground.h"
#include "estimation/shape/fit/shape_fit.h"
#include "estimation/shape/report/fit_report.h"
#include "geometry/mesh_topology.h"
#include "numerics/errors.h"
#include "numerics/files/output_file.h"
#include "numerics/files/output_folder.h"
#include "numerics/files/sha256.h"
#include "numerics/length_unit.h"
#include "numerics/version/code_version.h"
#include "recipe/recipe_json.h"
#include "tasks/estimation/detail_layers.h"
#include "tasks/estimation/fit_checkpoint.h"
#include "tasks/estimation/fit_realism.h"
#include "tasks/estimation/fit_time_limit.h"
#include "tasks/estimation/repaired_target.h"
#include "tasks/estimation/shape_recipe.h"
#include "tasks/synthesis/load_recipe.h"

namespace astrolith {
namespace {

// The recipe of a fitted body, without layers and without the figures that the fit achieved. With --bytes it
// has no provenance either.
Recipe recipe_of(const Program& program, const FitArguments& arguments, const ShapeFitResult& fit) {
  Recipe recipe;
  recipe.length_unit = arguments.unit;
  recipe.body = fit.body;
  if (arguments.fit.bytes > 0) return recipe;
  recipe.seed = program.seed;
  recipe.provenance.tool = program.tool();
  recipe.provenance.input_name = std::filesystem::path(arguments.mesh).filename().string();
  recipe.provenance.input_sha256 = arguments.mesh_sha256;
  recipe.provenance.options = program.given_options();
  return recipe;
}

// Adds the measured surface as a relief, and says how much nearer it brings the model.
void keep_relief(Program& program, const FitArguments& arguments, const TargetBody& target,
                 const Progress& progress, Recipe& recipe) try {
  const ReliefFit relief = add_relief(target, progress, recipe);
  program.say(fmt::format("relief: {} heights, {:.3g} {} apart, in steps of {:.2g} {}", relief.heights,
                          relief.layer.spacing, arguments.unit, relief.layer.step(), arguments.unit));
  program.summary["relief"] = relief_json(relief);
} catch (const InputError& e) {
  program.say(std::string("no relief: ") + e.what());
}

// Adds details to the recipe, and to the summary; the fit's figures become those of both together.
void add_details(Program& program, const FitArguments& arguments, const TargetBody& target, TimeLimit& limit,
                 FitCheckpoint& checkpoint, ShapeFitResult& fit, Recipe& recipe) {
  const SurfaceDistanceReport& d = fit.check.distance;
  program.summary["base"] = {{"mean_distance", d.mean}, {"p99_distance", d.p99}, {"max_distance", d.max}};
  const DetailArguments& wanted = arguments.details;
  if (wanted.micro == "auto") {
    program.say("micro: " + add_residual_texture(target, arguments.fit.seed,
                                                 limit.guard(program.progress("micro"), "micro"), recipe));
  } else if (wanted.base_only) {
    // The micro layers alone.
  } else if (wanted.transfers()) {
    const Recipe other = read_details(wanted.details);
    const double ratio = transfer_details(other, recipe);
    program.say(
        fmt::format("{}: {} layers, lengths times {:.4g}", wanted.details, other.layers.size(), ratio));
  } else if (const Progress progress = checkpoint.guard(limit.guard(program.progress("details"), "details"));
             wanted.keeps_relief()) {
    keep_relief(program, arguments, target, progress, recipe);
  } else {
    const DetailsFitResult details =
        search_details(program, target, arguments.fit, wanted, checkpoint.log(), progress, recipe);
    checkpoint.save();
    program.summary["details"] = details_json(details);
  }
  if (!wanted.micro.empty() && wanted.micro != "auto") {
    add_micro_layers(wanted.micro, wanted.mm_per_px, wanted.micro_height_mm, recipe);
  }
  if (Program::interrupted()) return;
  if (!recipe.layers.empty()) fit.base_mesh = std::move(fit.check.mesh);
  measure_recipe(target, recipe, arguments.fit, fit);
}

void say_result(const Program& program, const TargetBody& target, const ShapeFitResult& fit,
                bool with_details) {
  const SurfaceDistanceReport& d = fit.check.distance;
  // Details make a body as rough as the target, and not closer to it.
  const std::string without = with_details && program.summary.contains("base")
                                  ? fmt::format(" (mean {:.4f} % without details)",
                                                100 * program.summary["base"]["mean_distance"].get<double>())
                                  : "";
  program.say(
      fmt::format("{} ({} subtractive){}: mean distance {:.4f} %, p99 {:.4f} %, max {:.4f} % of the "
                  "diagonal{}; similarity "
                  "{:.2f} % (two samplings of the target: {:.2f} %)",
                  counted(fit.body.num_metaballs(), "metaball"), fit.body.subtract.size(),
                  with_details ? " and details" : "", 100 * d.mean, 100 * d.p99, 100 * d.max, without,
                  100 * fit.similarity, 100 * fit.similarity_floor));
  const MeshTopology& made = fit.check.topology;
  const std::int64_t handles = analyze_topology(target.mesh).genus;
  if (made.components != target.components || made.genus != handles) {
    program.say(fmt::format(
        "note: the fit has {} and {}, the target {} and {}; give it more --spheres, or another --seed",
        counted(made.components, "part"), counted(made.genus, "handle"), counted(target.components, "part"),
        counted(handles, "handle")));
  }
}

// States the size, by which a wrong --unit is seen.
void say_size(const Program& program, const FitArguments& arguments, const TargetBody& target) {
  Box box;
  for (const Vec3d& vertex : target.mesh.vertices) box.extend(target.diagonal * vertex);
  program.say(arguments.mesh + ": " + size_words(box.extent(), arguments.unit));
}

void question_unit(const Program& program, const FitArguments& arguments, const TargetBody& target) {
  const double volume = target.volume * std::pow(target.diagonal, 3);
  const std::string asked = unit_question(arguments.mesh, volume, metres_of(arguments.unit));
  if (!asked.empty()) program.say(asked);
}

// Says and sums up whether the surface of the fit passes for the target's.
std::optional<FitRealism> judge_surface(Program& program, const FitArguments& arguments,
                                        const TargetBody& target, const Recipe& recipe, TimeLimit& limit) {
  if (arguments.noise_seeds == 0 || Program::interrupted() || !limit.has_time_left()) return std::nullopt;
  const Progress progress = [&limit, shown = program.progress("surface")](double fraction,
                                                                          std::string_view words) {
    return shown(fraction, words) && limit.has_time_left();
  };
  const int seeds = arguments.details.keeps_relief() ? 1 : arguments.noise_seeds;  // a relief has no noise
  JudgedFit judged = judge_fit(target, recipe, seeds, program.seed, progress);
  if (!judged.remark.empty()) program.say("the surface is not judged: " + judged.remark);
  if (!judged.realism) return std::nullopt;
  const nlohmann::ordered_json figures = fit_realism_json(*judged.realism, target, arguments.unit);
  for (const auto& words : figures["words"]) program.say("surface: " + words.get<std::string>());
  program.summary["realism"] = figures;
  const double unseen = unseen_share(judged.realism->target);
  program.summary["unseen_share"] = unseen;
  if (unseen > 0.0) {
    program.say(
        fmt::format("{:.0f} % of the target's surface is smooth in one piece, which no camera may have "
                    "seen; the fit has it as the model has it",
                    100.0 * unseen));
  }
  return std::move(judged.realism);
}

// Writes what Ctrl-C left. Nobody waits for figures after it, which may take longer than the fit took.
void keep_best_so_far(Program& program, const FitArguments& arguments, const FitCheckpoint& checkpoint,
                      const TargetBody& target, const ShapeFitResult& fit, const Recipe& recipe) {
  write_loaded_recipe(recipe, arguments.output);
  std::string line = fmt::format(
      "stopped by {}: {} holds the best so far, {}{}, not measured", Program::stopped_by(), arguments.output,
      counted(fit.body.num_metaballs(), "metaball"), recipe.layers.empty() ? "" : " and details");
  if (!arguments.checkpoint.empty()) {
    line += checkpoint.has_base() ? "; the same command goes on from " + arguments.checkpoint
                                  : "; no checkpoint yet, since the metaballs were not finished";
  }
  program.say(line);
  program.summary["spheres"] = fit.body.num_metaballs();
  program.summary["subtracting_spheres"] = fit.body.subtract.size();
  program.summary["stopped_early"] = true;
  program.summary["diagonal"] = target.diagonal;
  program.summary["length_unit"] = arguments.unit;
}

// Without a checked mesh there is nothing to keep.
Progress heeding_ctrl_c(Progress progress) {
  return [progress = std::move(progress)](double fraction, std::string_view words) {
    if (Program::interrupted()) throw WorkError("stopped while the mesh was checked; nothing was fitted yet");
    return report(progress, fraction, words);
  };
}

// The target of a mesh. Says what was mended.
TargetBody target_of(Program& program, const FitArguments& arguments, TriangleMesh mesh,
                     const Progress& preparing) {
  const ShapeRepair& repair = arguments.repair;
  RepairedTarget made = repaired_target(std::move(mesh), arguments.mesh, arguments.unit, repair.strict,
                                        repair.options(), program.progress("repair"), preparing);
  for (const std::string& words : made.words) program.say(arguments.mesh + ": " + words);
  for (const std::string& remark : made.target.remarks) program.say(arguments.mesh + ": " + remark);
  if (!made.figures.is_null()) program.summary["repair"] = made.figures;
  return std::move(made.target);
}

void run(Program& program, FitArguments& arguments) {
  // A result that cannot be written should be refused before minutes of work.
  if (arguments.packing_only) {
    require_extension(arguments.output, {".csv"});
  } else {
    require_extension(arguments.output, {".json", ".astro"});
  }
  require_writable(arguments.output);
  if (!arguments.checkpoint.empty()) {
    require_writable(arguments.checkpoint);
    require_two_files(arguments.checkpoint, arguments.output);
    require_other_file(arguments.checkpoint, arguments.mesh);
  }
  const auto variations = variation_files(arguments.output, arguments.details.variations);
  const bool asks_for_relief = arguments.details.keeps_relief();
  settle_details(program, arguments.details);
  check_detail_inputs(program, arguments.details);
  if (!arguments.report.empty()) require_folder_can_be_made(arguments.report);
  TimeLimit limit(arguments.time_limit);
  settle_fit_options(program, arguments);
  // Reading takes about as long as a quarter of the checks.
  constexpr double kReadShare = 0.2;
  arguments.mesh_sha256 = sha256_of_file(arguments.mesh);
  TriangleMesh mesh = arguments.repair.read(arguments.mesh);
  if (sha256_of_file(arguments.mesh) != arguments.mesh_sha256) {
    throw InputError(arguments.mesh + ": changed while it was read; run again when it is whole");
  }
  report(heeding_ctrl_c(limit.preparation(0.0)), kReadShare, "read");
  const TargetBody target =
      target_of(program, arguments, std::move(mesh), heeding_ctrl_c(limit.preparation(kReadShare)));
  question_unit(program, arguments, target);
  if (arguments.packing_only) return write_packing(program, arguments, target);
  if (asks_for_relief) expect_relief(target);

  FitCheckpoint checkpoint(arguments.checkpoint, {program.tool(), kCodeVersion.changes, arguments.mesh_sha256,
                                                  program.given_options()});
  say_size(program, arguments, target);
  if (checkpoint.resumed()) program.say(arguments.checkpoint + ": going on from there");
  ShapeFitResult fit = fit_base(
      target, arguments.fit, checkpoint,
      [&](const std::string& stage) { return limit.guard(program.progress(stage), stage); },
      Program::interrupted);
  Recipe recipe = recipe_of(program, arguments, fit);
  const bool with_details = !arguments.details.base_only || !arguments.details.micro.empty();
  if (with_details && !Program::interrupted() && limit.allows_more()) {
    add_details(program, arguments, target, limit, checkpoint, fit, recipe);
  }
  if (Program::interrupted()) return keep_best_so_far(program, arguments, checkpoint, target, fit, recipe);
  if (limit.reached()) program.say("stopped at the time limit: this is the best so far");
  if (arguments.fit.bytes == 0) note_achieved(fit, recipe);
  write_loaded_recipe(recipe, arguments.output);
  const std::optional<FitRealism> realism = judge_surface(program, arguments, target, recipe, limit);
  if (!arguments.report.empty()) {
    std::optional<ReportedRealism> shown;
    if (realism) {
      shown.emplace(reported(*realism, target, arguments.unit));
    }
    const TriangleMesh likeness = likeness_for_report(recipe);
    write_fit_report(target, fit, std::filesystem::path(arguments.mesh).filename().string(), arguments.report,
                     shown ? &*shown : nullptr, likeness.triangles.empty() ? nullptr : &likeness);
  }
  program.summary.update(fit_figures(fit));
  program.summary["stopped_early"] = limit.reached();
  program.summary["diagonal"] = target.diagonal;  // distances are fractions of it
  program.summary["length_unit"] = arguments.unit;
  if (!variations.empty() && !Program::interrupted() && !limit.allows_more()) {
    program.say("no variations: the time is over");
  } else if (!variations.empty() && !Program::interrupted()) {
    program.summary["variations"] = write_variations(program, target, recipe, arguments.details, variations);
  }
  say_result(program, target, fit, !recipe.layers.empty());
}

}  // namespace
}  // namespace astrolith

int main(int argc, char** argv) {
  astrolith::Program program("fit_shape", "Fits metaballs to a closed mesh and writes them as a recipe.");
  astrolith::FitArguments arguments;
  astrolith::declare_fit_options(program, arguments);
  return program.run(argc, argv, [&] { astrolith::run(program, arguments); });
}
