#include "tasks/estimation/fit_shape.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "estimation/shape/details/imaged_ground.h"
#include "estimation/shape/details/realism_check.h"
#include "estimation/shape/fit/shape_fit.h"
#include "estimation/shape/report/fit_report.h"
#include "estimation/shape/target/surface_components.h"
#include "geometry/mesh_topology.h"
#include "numerics/errors.h"
#include "numerics/files/output_file.h"
#include "numerics/length_unit.h"
#include "numerics/version/code_version.h"
#include "recipe/recipe_json.h"
#include "tasks/description/surface_report.h"
#include "tasks/estimation/detail_layers.h"
#include "tasks/estimation/fit_checkpoint.h"
#include "tasks/estimation/fit_time_limit.h"
#include "tasks/estimation/relief_mending.h"
#include "tasks/estimation/relief_size.h"
#include "tasks/estimation/repaired_target.h"
#include "tasks/estimation/shape_recipe.h"
#include "tasks/job/job.h"
#include "tasks/job/load_recipe.h"
#include "tasks/job/output_names.h"
#include "tasks/job/words.h"
#include "tasks/repair/mesh_unit.h"

namespace astrolith {
namespace {

struct JudgedFit {
  std::optional<FitRealism> realism;  // none where progress asked to stop, or with the remark
  std::string remark;                 // why the surface could not be judged
};

LengthWords length_words(const FitRealism& realism, const TargetBody& target, const std::string& unit) {
  LengthWords lengths = words_for_lengths(unit, 3.0 * realism.verdict.edge * target.diagonal);
  lengths.scale *= target.diagonal;
  return lengths;
}

// check_realism() for a whole fit, of which the verdict is only a part: what hinders it is no error.
JudgedFit judge_fit(const TargetBody& target, const Recipe& recipe, int seeds, std::uint64_t seed,
                    const Progress& progress) {
  try {
    return {check_realism(target, recipe, seeds, seed, progress), ""};
  } catch (const InputError& e) {
    return {std::nullopt, e.what()};
  } catch (const WorkError&) {
    return {};
  }
}

// The verdict in the unit of the target's file, "m" or "km", with the p and the largest distance of each
// seed.
nlohmann::ordered_json fit_realism_json(const FitRealism& realism, const TargetBody& target,
                                        const std::string& unit) {
  RealismVerdict verdict = realism.verdict;
  verdict.edge *= target.diagonal;
  nlohmann::ordered_json json = realism_json(verdict, words_for_lengths(unit, 3.0 * verdict.edge));
  nlohmann::ordered_json seeds = nlohmann::ordered_json::array();
  for (const RealismVerdict& seed : realism.seed_verdicts) {
    seeds.push_back({{"p", seed.p}, {"largest_distance", seed.largest_distance}});
  }
  json["noise_seeds"] = seeds;
  return json;
}

// The verdict for a report, which refers to `realism`.
ReportedRealism reported(const FitRealism& realism, const TargetBody& target, const std::string& unit) {
  return {realism.verdict, realism.target, realism.mesh, realism.fit, length_words(realism, target, unit)};
}

// The recipe of a fitted body, without layers and without the figures that the fit achieved. With --bytes it
// has no provenance either.
Recipe make_recipe(const Job& job, const FitArguments& arguments, const Vec3d& origin,
                   const ShapeFitResult& fit) {
  Recipe recipe;
  recipe.origin = origin;
  recipe.length_unit = arguments.unit;
  recipe.body = fit.body;
  if (arguments.bytes > 0) return recipe;
  recipe.seed = job.seed;
  recipe.provenance.tool = job.tool();
  if (!arguments.in_memory) {
    recipe.provenance.input_name = std::filesystem::path(arguments.mesh).filename().string();
    recipe.provenance.input_sha256 = arguments.mesh_sha256;
  }
  recipe.provenance.options = job.options.given();
  return recipe;
}

// Adds the measured surface as a relief, and says how much nearer it brings the model.
void keep_relief(Job& job, const FitArguments& arguments, const TargetBody& target, const Progress& progress,
                 Recipe& recipe) try {
  const ReliefFit relief =
      arguments.bytes > 0
          ? add_relief_within(target, static_cast<std::size_t>(arguments.bytes), progress, recipe)
          : add_relief(target, arguments.details.relief_spacing, progress, recipe);
  if (relief.layer.pixels == nullptr) {
    job.say("no relief: the fit was stopped before it had heights");
    job.summary["relief"] = {{"remark", "stopped before it had heights"}};
    return;
  }
  job.say(fmt::format("relief: {} heights, {:.3g} {} apart, in steps of {:.2g} {}", relief.heights,
                      relief.layer.spacing, arguments.unit, relief.layer.step(), arguments.unit));
  job.summary["relief"] = relief_json(relief);
} catch (const InputError& e) {
  if (arguments.details.gives_spacing()) throw InputError("--relief-spacing: " + std::string(e.what()));
  if (!arguments.details.chosen_by_job()) throw;
  job.say(std::string("no relief: ") + e.what());
  job.summary["relief"] = {{"remark", e.what()}};
}

// Adds details to the recipe, and to the summary; the fit's figures become those of both together.
void add_details(Job& job, const FitArguments& arguments, const TargetBody& target, TimeLimit& limit,
                 FitCheckpoint& checkpoint, ShapeFitResult& fit, Recipe& recipe) {
  const SurfaceDistanceReport& d = fit.check.distance;
  job.summary["base"] = {{"mean_distance", d.mean}, {"p99_distance", d.p99}, {"max_distance", d.max}};
  const DetailArguments& wanted = arguments.details;
  if (wanted.micro == "auto") {
    job.say("micro: " + add_residual_texture(target, arguments.fit.seed,
                                             limit.guard(job.progress("micro"), "micro"), recipe));
  } else if (wanted.base_only) {
    // The micro layers alone.
  } else if (wanted.transfers()) {
    const Recipe other = read_details(wanted.details);
    const double ratio = transfer_details(other, recipe);
    job.say(fmt::format("{}: {} layers, lengths times {:.4g}", wanted.details, other.layers.size(), ratio));
  } else if (const Progress progress = checkpoint.guard(limit.guard(job.progress("details"), "details"));
             wanted.keeps_relief()) {
    keep_relief(job, arguments, target, progress, recipe);
  } else {
    const DetailsFitResult details =
        search_details(job, target, arguments.fit, wanted, checkpoint.log(), progress, recipe);
    checkpoint.save();
    job.summary["details"] = details_json(details);
  }
  if (!wanted.micro.empty() && wanted.micro != "auto") {
    add_micro_layers(wanted.micro, wanted.mm_per_px, wanted.micro_height_mm, recipe);
  }
  if (job.stopped()) return;
  if (!recipe.layers.empty()) fit.base_mesh = std::move(fit.check.mesh);
  measure_recipe(target, recipe, arguments.fit, fit);
  if (!job.summary.contains("relief") || !job.summary["relief"].contains("heights")) return;
  const std::size_t halved = mend_relief(target, arguments.fit, static_cast<std::size_t>(arguments.bytes),
                                         limit.guard(job.progress("topology"), "topology"), recipe, fit);
  job.summary["relief"]["halved_heights"] = halved;
  if (halved > 0)
    job.say(fmt::format("relief: {} halved where it made parts or handles that the target lacks",
                        counted(halved, "height")));
}

// A fit is no worse for a surface that cannot be sampled evenly, or where a stop comes meanwhile.
void add_similarity(const Job& job, const TargetBody& target, std::uint64_t seed, ShapeFitResult& fit) try {
  fit.similarity = measure_similarity(target.surface, fit.check.mesh, seed,
                                      [&](const std::string& stage) { return job.progress(stage); });
} catch (const InputError& e) {
  job.say(std::string("the similarity is not measured: ") + e.what());
} catch (const WorkError&) {
  // Stopped: the caller keeps the best so far.
}

// What to do about a topology that is not the target's. `base` is the mesh of the metaballs alone, where
// there are details too.
std::string suggest_remedy(const PartsAndHandles& wanted, const TriangleMesh& base) {
  if (!base.triangles.empty() && parts_and_handles(analyze_topology(base)) == wanted)
    return "the metaballs alone, --base-only, have the target's";
  return "try another --seed, or another number of --spheres";
}

void say_result(const Job& job, const TargetBody& target, const ShapeFitResult& fit, bool with_details) {
  const SurfaceDistanceReport& d = fit.check.distance;
  // Details make a body as rough as the target, and not closer to it.
  const std::string without = with_details && job.summary.contains("base")
                                  ? fmt::format(" (mean {:.4f} % without details)",
                                                100 * job.summary["base"]["mean_distance"].get<double>())
                                  : "";
  const std::string similarity =
      fit.similarity ? fmt::format("; similarity {:.2f} % (two samplings of the target: {:.2f} %)",
                                   100 * fit.similarity->value, 100 * fit.similarity->floor)
                     : "";
  job.say(fmt::format(
      "{} ({} subtractive){}: mean distance {:.4f} %, p99 {:.4f} %, max {:.4f} % of the "
      "diagonal{}{}",
      counted(fit.body.num_metaballs(), "metaball"), fit.body.subtract.size(),
      with_details ? " and details" : "", 100 * d.mean, 100 * d.p99, 100 * d.max, without, similarity));
  const PartsAndHandles made = parts_and_handles(fit.check.topology), wanted = parts_and_handles(target);
  if (made != wanted) {
    job.say(fmt::format("note: the fit has {}, the target {}; {}", made.words(), wanted.words(),
                        suggest_remedy(wanted, fit.base_mesh)));
  }
}

// States the size, by which a wrong --unit is seen.
void say_size(const Job& job, const FitArguments& arguments, const TargetBody& target) {
  Box box;
  for (const Vec3d& vertex : target.mesh.vertices) box.extend(target.diagonal * vertex);
  job.say(arguments.mesh + ": " + size_words(box.extent(), arguments.unit) +
          (arguments.unit_assumed ? ", where no unit is stated; --unit says another" : ""));
}

void question_unit(const Job& job, const FitArguments& arguments, const TargetBody& target) {
  const double volume = target.volume * std::pow(target.diagonal, 3);
  const std::string asked = unit_question(arguments.mesh, volume, {arguments.unit, arguments.unit_assumed});
  if (!asked.empty()) job.say(asked);
}

// Says and sums up whether the surface of the fit passes for the target's.
std::optional<FitRealism> judge_surface(Job& job, const FitArguments& arguments, const TargetBody& target,
                                        const Recipe& recipe, TimeLimit& limit) {
  if (arguments.noise_seeds == 0 || job.stopped() || !limit.has_time_left()) return std::nullopt;
  const Progress progress = [&limit, shown = job.progress("surface")](double fraction,
                                                                      std::string_view words) {
    return shown(fraction, words) && limit.has_time_left();
  };
  const int seeds = arguments.details.keeps_relief() ? 1 : arguments.noise_seeds;  // a relief has no noise
  JudgedFit judged = judge_fit(target, recipe, seeds, job.seed, progress);
  if (!judged.remark.empty()) job.say("the surface is not judged: " + judged.remark);
  if (!judged.realism) return std::nullopt;
  const nlohmann::ordered_json figures = fit_realism_json(*judged.realism, target, arguments.unit);
  for (const auto& words : figures["words"]) job.say("surface: " + words.get<std::string>());
  job.summary["realism"] = figures;
  const double unseen = unseen_share(judged.realism->target);
  job.summary["unseen_share"] = unseen;
  if (unseen > 0.0) {
    job.say(
        fmt::format("{:.0f} % of the target's surface is smooth in one piece, which no camera may have "
                    "seen; the fit has it as the model has it",
                    100.0 * unseen));
  }
  return std::move(judged.realism);
}

// Keeps what a stop left. Nobody waits for figures after it, which may take longer than the fit took.
void keep_best_so_far(Job& job, const FitArguments& arguments, const FitCheckpoint& checkpoint,
                      const ShapeFitResult& fit, const Recipe& recipe) {
  if (!arguments.output.empty()) write_loaded_recipe(recipe, arguments.output);
  std::string line =
      fmt::format("stopped by {}: {} holds the best so far, {}{}, not measured", job.stopped_by(),
                  arguments.output.empty() ? "the recipe" : arguments.output,
                  counted(fit.body.num_metaballs(), "metaball"), recipe.layers.empty() ? "" : " and details");
  if (!arguments.checkpoint.empty()) {
    line += checkpoint.has_base() ? "; the same command goes on from " + arguments.checkpoint
                                  : "; no checkpoint yet, since the metaballs were not finished";
  }
  job.say(line);
  job.summary["spheres"] = fit.body.num_metaballs();
  job.summary["subtracting_spheres"] = fit.body.subtract.size();
  job.summary["stopped_early"] = true;
}

void write_report(const FitArguments& arguments, const TargetBody& target, const ShapeFitResult& fit,
                  const Recipe& recipe, const std::optional<FitRealism>& realism) {
  std::optional<ReportedRealism> shown;
  if (realism) shown.emplace(reported(*realism, target, arguments.unit));
  const TriangleMesh likeness = likeness_for_report(recipe);
  write_fit_report(target, fit, std::filesystem::path(arguments.mesh).filename().string(), arguments.report,
                   shown ? &*shown : nullptr, likeness.triangles.empty() ? nullptr : &likeness);
}

void add_variations(Job& job, const FitArguments& arguments, const TargetBody& target, const Recipe& recipe,
                    TimeLimit& limit) {
  if (job.stopped()) return;
  if (!limit.allows_more()) return job.say("no variations: the time is over");
  job.summary["variations"] =
      write_variations(job, target, recipe, arguments.details,
                       variation_files(arguments.output, arguments.details.variations));
}

BodyPacking pack_target(Job& job, const FitArguments& arguments, const TargetBody& target) {
  const std::string title = std::filesystem::path(arguments.mesh).filename().string();
  BodyPacking packing = pack_body(
      target, {arguments.fit.spheres, arguments.unit, arguments.density, title, job.tool(), arguments.output},
      job.progress("pack"));
  if (packing.interrupted)
    job.say(std::string("stopped by ") + job.stopped_by() + ": these are the spheres so far");
  job.summary["spheres"] = packing.spheres.size();
  job.summary["filling_rate"] = packing.filling_rate;
  if (!arguments.output.empty()) job.say(arguments.output + ": " + packing_words(packing));
  return packing;
}

// Without a checked mesh there is nothing to keep.
Progress heeding_a_stop(const Job& job, Progress progress) {
  return [&job, progress = std::move(progress)](double fraction, std::string_view words) {
    if (job.stopped()) throw WorkError("stopped while the mesh was checked; nothing was fitted yet");
    return report(progress, fraction, words);
  };
}

// A result that cannot be written should be refused before minutes of work.
void require_outputs(const FitArguments& arguments) {
  if (!arguments.output.empty()) {
    if (arguments.packing_only) {
      require_extension(arguments.output, {".csv"});
    } else {
      require_extension(arguments.output, {".json", ".astro"});
    }
    require_writable(arguments.output);
    for (const auto& file : variation_files(arguments.output, arguments.details.variations))
      require_writable(file);
  }
  if (!arguments.checkpoint.empty()) require_writable(arguments.checkpoint);
  if (!arguments.report.empty()) require_folder_can_be_made(arguments.report);
}

}  // namespace

FittedShape fit_shape(Job& job, FitArguments& arguments) {
  job.keep_best_so_far();
  require_outputs(arguments);
  settle_details(job, arguments.details);
  check_detail_inputs(job, arguments.details);
  TimeLimit limit(arguments.time_limit);
  settle_fit_options(job, arguments);
  // Reading takes about as long as a quarter of the checks.
  constexpr double kReadShare = 0.2;
  TriangleMesh mesh = read_target_mesh(arguments);
  report(heeding_a_stop(job, limit.preparation(0.0)), kReadShare, "read");
  const Vec3d origin = arguments.packing_only ? Vec3d{} : local_origin(mesh);
  if (!(origin == Vec3d{})) {
    for (Vec3d& p : mesh.vertices) p = p - origin;
    job.say(fmt::format(
        "{}: lies far from the origin of its frame; the recipe has an origin of its own, {} {} {} {}",
        arguments.mesh, origin.x, origin.y, origin.z, arguments.unit));
    job.summary["origin"] = {origin.x, origin.y, origin.z};
  }
  const TargetBody target =
      repaired_target(job, arguments, std::move(mesh), heeding_a_stop(job, limit.preparation(kReadShare)));
  question_unit(job, arguments, target);
  FittedShape result;
  job.summary["length_unit"] = arguments.unit;
  if (arguments.packing_only) {
    result.packing = pack_target(job, arguments, target);
    return result;
  }
  check_relief(target, arguments);
  settle_metaballs(job, target, arguments);

  FitCheckpoint checkpoint(arguments.checkpoint,
                           {job.tool(), kCodeVersion.changes, arguments.mesh_sha256, job.options.given()});
  say_size(job, arguments, target);
  if (checkpoint.resumed()) job.say(arguments.checkpoint + ": going on from there");
  ShapeFitResult fit = fit_base(
      target, arguments.fit, checkpoint,
      [&](const std::string& stage) { return limit.guard(job.progress(stage), stage); },
      [&] { return job.stopped(); });
  Recipe& recipe = result.recipe = make_recipe(job, arguments, origin, fit);
  const bool with_details = !arguments.details.base_only || !arguments.details.micro.empty();
  if (with_details && !job.stopped() && limit.allows_more()) {
    add_details(job, arguments, target, limit, checkpoint, fit, recipe);
  }
  arguments.albedo.apply(job, recipe);
  job.summary["diagonal"] = target.diagonal;  // distances are fractions of it
  if (!job.stopped()) add_similarity(job, target, arguments.fit.seed, fit);
  if (job.stopped()) {
    keep_best_so_far(job, arguments, checkpoint, fit, recipe);
    return result;
  }
  if (limit.reached()) job.say("stopped at the time limit: this is the best so far");
  if (arguments.bytes == 0) note_achieved(fit, recipe);
  if (!arguments.output.empty()) write_loaded_recipe(recipe, arguments.output);
  const std::optional<FitRealism> realism = judge_surface(job, arguments, target, recipe, limit);
  if (!arguments.report.empty()) write_report(arguments, target, fit, recipe, realism);
  job.summary.update(fit_figures(fit));
  const PartsAndHandles wanted = parts_and_handles(target);
  job.summary["target_components"] = wanted.parts;
  job.summary["target_genus"] = wanted.handles;
  job.summary["stopped_early"] = limit.reached();
  if (arguments.details.variations > 0) add_variations(job, arguments, target, recipe, limit);
  say_result(job, target, fit, !recipe.layers.empty());
  return result;
}

}  // namespace astrolith
