#include "tasks/description/description_jobs.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "geometry/io/mesh_format.h"
#include "geometry/io/mesh_io.h"
#include "numerics/files/output_file.h"
#include "numerics/length_unit.h"
#include "tasks/description/comparison.h"
#include "tasks/description/shape_options.h"
#include "tasks/description/surface_report.h"
#include "tasks/job/job.h"
#include "tasks/job/output_names.h"
#include "tasks/job/words.h"
#include "tasks/repair/mesh_unit.h"
#include "tasks/repair/shape_repair.h"

namespace astrolith {
namespace {

struct CompareArguments {
  std::string a, b, output;
  ShapeOptions options;
  ShapeRepair repair;
  std::int64_t samples = 100000;
  bool floor = false, align = false, realism = false, json = false;
  std::string unit;
  SurfaceOptions surface;
};

void add_compare_options(Job& job, CompareArguments& arguments) {
  OptionTable& app = job.options;
  const std::string formats = "mesh (" + read_mesh_words() + ")";
  app.add_option("a", arguments.a, formats).required().placeholder("A").reads();
  app.add_option("b", arguments.b, formats).required().placeholder("B").reads();
  app.add_option("-o,--output", arguments.output, "write the JSON here rather than to stdout")
      .placeholder("FILE.json")
      .writes();
  arguments.options.add_to(app);
  arguments.repair.add_to(app, false);
  app.add_option("--samples", arguments.samples,
                 "samples of each surface, for the distances between the surfaces")
      .check(in_range(std::int64_t{100}, std::int64_t{10000000}));
  app.add_flag("--align", arguments.align,
               "move and turn B onto A before the distances between the surfaces are measured");
  const Option realism = app.add_flag(
      "--realism", arguments.realism,
      "also say whether the surface of B passes for that of A, by what both are like from place to place: "
      "Kolmogorov-Smirnov distances, p by exchange of regions, and in words what B lacks");
  app.add_flag("--json", arguments.json,
               "print all figures as JSON with --realism too, in place of the ten lines that matter");
  app.add_option("--unit", arguments.unit, "unit of both files, in place of what they state")
      .check(one_of({"m", "km"}))
      .default_text("");
  app.add_flag("--floor", arguments.floor,
               "also judge another sampling of A, which is the best that B can reach")
      .needs(realism);
  arguments.surface.add_to(app, realism);
}

SurfaceComparison judge(const Job& job, const CompareArguments& arguments, const TriangleMesh& a,
                        const TriangleMesh& b, const std::string& unit) {
  SurfaceComparison made =
      judge_surfaces({arguments.a, a}, {arguments.b, b}, arguments.surface.of(job), arguments.floor, unit,
                     [&](const std::string& stage) { return job.progress(stage); });
  for (const std::string& remark : made.a.remarks) job.say(arguments.a + ": " + remark);
  for (const std::string& remark : made.b.remarks) job.say(arguments.b + ": " + remark);
  return made;
}

// What a reader of the terminal wants of the comparison.
std::string to_lines(const nlohmann::ordered_json& result, const std::vector<std::string>& surface) {
  std::string text =
      fmt::format("similarity of the shapes {:.3f}; of two samplings of A {:.3f}\n",
                  result["similarity"].get<double>(), result["similarity_floor"]["a"].get<double>());
  text += fmt::format("distance {:.3g} mean, {:.3g} p99, {:.3g} max, of A's diagonal\n",
                      result["mean_distance"].get<double>(), result["p99_distance"].get<double>(),
                      result["max_distance"].get<double>());
  for (const std::string& line : surface) text += line + "\n";
  return text + "--json prints all figures\n";
}

TriangleMesh read_shape(Job& job, const CompareArguments& arguments, const std::string& file,
                        nlohmann::ordered_json& figures) {
  return arguments.repair.mended_surface(job, arguments.repair.read(file), file, figures);
}

// Says so where B is many times larger or smaller than A: distances are then of the sizes alone.
void say_factor(const Job& job, const CompareArguments& arguments, const TriangleMesh& a,
                const TriangleMesh& b) {
  constexpr double kMany = 10.0, kUnits = 1000.0, kNear = 1.1;
  const double factor = b.bounds().diagonal() / a.bounds().diagonal(),
               times = std::fmax(factor, 1.0 / factor);
  if (!(times >= kMany) || !std::isfinite(times)) return;
  const bool as_units = times > kUnits / kNear && times < kUnits * kNear;
  job.say(fmt::format(
      "note: {}: its length is {:.4g} times that of {}{}; scale one where the sizes do not matter",
      arguments.b, factor, arguments.a, as_units ? ", as of meshes in metres and in kilometres" : ""));
}

// The unit of A, "" where it is unknown. Scales B to it, or says that the units differ where the length of
// one is not known.
std::string one_unit(const Job& job, const CompareArguments& arguments, TriangleMesh& b) {
  const UnitChoice choice{arguments.unit, ""};
  const std::string unit_a = resolve_unit(job, arguments.a, choice, {}).name;
  const std::string unit_b = resolve_unit(job, arguments.b, choice, {}).name;
  if (unit_a.empty() || unit_b.empty() || unit_a == unit_b) return unit_a;
  if (!has_known_length(unit_a) || !has_known_length(unit_b)) {
    job.say(fmt::format("note: {}: is in {}, and {} in {}; nothing was scaled", arguments.b, unit_b,
                        arguments.a, unit_a));
    return unit_a;
  }
  const double ratio = metres_per_unit(unit_b) / metres_per_unit(unit_a);
  for (Vec3d& vertex : b.vertices) vertex = ratio * vertex;
  job.say(fmt::format("{}: from {} to {}, the unit of {}", arguments.b, unit_b, unit_a, arguments.a));
  return unit_a;
}

void run_compare(Job& job, const CompareArguments& arguments) {
  if (!arguments.output.empty()) {
    require_extension(arguments.output, {".json"});
    require_writable(arguments.output);
  }
  nlohmann::ordered_json repair_of_a, repair_of_b;
  const TriangleMesh a = read_shape(job, arguments, arguments.a, repair_of_a);
  TriangleMesh b = read_shape(job, arguments, arguments.b, repair_of_b);
  const std::string unit = one_unit(job, arguments, b);
  say_factor(job, arguments, a, b);
  const DescriptionOptions options = arguments.options.with_seed(job.seed);
  nlohmann::ordered_json result{{"a", arguments.a},
                                {"b", arguments.b},
                                {"features", arguments.options.features},
                                {"bins", options.bins},
                                {"points", options.points}};
  if (!unit.empty()) result["length_unit"] = unit;
  const Comparison comparison =
      compare_meshes({arguments.a, a}, {arguments.b, b}, {options, arguments.samples, arguments.align},
                     [&](const std::string& stage) { return job.progress(stage); });
  for (const std::string& remark : comparison.remarks) job.say(remark);
  result.update(comparison.figures);
  std::vector<std::string> lines;
  if (arguments.realism) {
    SurfaceComparison judged = judge(job, arguments, a, b, unit);
    result["realism"] = std::move(judged.figures);
    lines = std::move(judged.lines);
  }
  if (!repair_of_a.is_null()) result["repair_of_a"] = repair_of_a;
  if (!repair_of_b.is_null()) result["repair_of_b"] = repair_of_b;
  job.summary = result;
  if (!arguments.output.empty()) write_file(arguments.output, json_text(result));
  if (arguments.realism && !arguments.json) {
    job.print_result(to_lines(result, lines));
  } else if (arguments.output.empty()) {
    job.print_result(json_text(result));
  }
}

}  // namespace

JobWork declare_compare(Job& job) {
  const auto arguments = std::make_shared<CompareArguments>();
  add_compare_options(job, *arguments);
  return [&job, arguments] { run_compare(job, *arguments); };
}

}  // namespace astrolith
