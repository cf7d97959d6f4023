#include "tasks/synth/mesh_reports.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "numerics/vec3_json.h"
#include "synthesis/field/surface_colors.h"
#include "tasks/job/words.h"

namespace astrolith {
namespace {

std::string layer_name(const Layer& layer) {
  return std::visit([](const auto& l) { return l.name; }, layer);
}

// The layer in words, such as: layers[2] "grains" (gabor, 63 % of its variance).
std::string in_words(const LayerLeftOut& left, const Recipe& recipe) {
  std::string share = fmt::format("{:.3g} % of its variance", 100.0 * left.variance_share);
  if (left.landforms > 0.0) share = fmt::format("{:.3g} of its landforms, {}", left.landforms, share);
  if (left.layer < 0) return "body.warp (" + share + ")";
  const Layer& layer = recipe.layers[static_cast<std::size_t>(left.layer)];
  const std::string name = layer_name(layer);
  return fmt::format("layers[{}]{} ({}, {})", left.layer, name.empty() ? "" : " \"" + name + "\"",
                     type_word(layer), share);
}

// Whether copies of an image lie on the body, of which a whole body gets some 64 along its side.
bool repeats_an_image(const LayerLeftOut& left, const Recipe& recipe) {
  if (left.layer < 0) return false;
  const Layer& layer = recipe.layers[static_cast<std::size_t>(left.layer)];
  return std::holds_alternative<ExemplarLayer>(layer) || std::holds_alternative<ReliefLayer>(layer);
}

std::string explain(const LayerLeftOut& left, const Recipe& recipe, const ImplicitField& field,
                    bool is_patch) {
  if (left.landforms > 0.0) {
    return is_patch ? "smaller than 8 spacings of float coordinates"
                    : "more than the 2e5 landforms that a whole body gets";
  }
  if (!is_patch && repeats_an_image(left, recipe))
    return "made of images of less than about 1/64 of the body";
  if (!is_patch) return "finer than float coordinates of a body of this size resolve";
  return field.has_local_form() ? "finer than the coordinates of this patch resolve"
                                : "finer than coordinates of a body made by operations resolve";
}

// Heights near the radius tear a body into pieces, which no seed or resolution mends.
void question_pieces(const Job& job, const MeshPart& part, std::int64_t pieces) {
  constexpr std::int64_t kTorn = 10;
  const Vec3d e = part.field.bounds().extent();
  const double height = part.field.height_bound(), thickness = std::min({e.x, e.y, e.z});
  if (pieces < kTorn || height < 0.25 * thickness) return;
  job.say(fmt::format(
      "note: {} pieces: the layers are up to {:.3g} {} high on a body that is {:.3g} thick with them; lower "
      "their heights",
      pieces, height, part.recipe.length_unit, thickness));
}

}  // namespace

void report_layers_left_out(Job& job, const MeshPart& part) {
  const Recipe& recipe = part.recipe;
  const ImplicitField& field = part.field;
  const bool is_patch = part.region.is_patch;
  auto list = nlohmann::ordered_json::array();
  std::map<std::string, std::string> words;  // by reason
  for (const LayerLeftOut& left : field.left_out()) {
    const std::string reason = explain(left, recipe, field, is_patch);
    nlohmann::ordered_json entry;
    if (left.layer < 0) {
      entry = {{"layer", nullptr}, {"name", ""}, {"type", "body warp"}};
    } else {
      const Layer& layer = recipe.layers[static_cast<std::size_t>(left.layer)];
      entry = {{"layer", left.layer}, {"name", layer_name(layer)}, {"type", std::string(type_word(layer))}};
    }
    entry["reason"] = reason;
    entry["finest_length"] = left.finest;
    entry["variance_share"] = left.variance_share;
    if (left.landforms > 0.0) entry["landforms"] = left.landforms;
    list.push_back(std::move(entry));
    std::string& named = words[reason];
    named += (named.empty() ? "" : ", ") + in_words(left, recipe);
  }
  for (const auto& [reason, named] : words) {
    job.say(fmt::format("{}: left out, since {}: {}{}", part.file.string(), reason, named,
                        is_patch || !field.has_local_form() ? "" : "; a --patch shows it"));
  }
  job.summary["layers_left_out"] = std::move(list);
}

void report_erosion(Job& job, const Erosion& erosion, const ErosionStatistics& done, std::size_t vertices) {
  job.summary["erosion"] = {{"settled", done.settled},
                            {"sweeps", done.sweeps},
                            {"steepest_before", done.steepest_before},
                            {"steepest_after", done.steepest_after},
                            {"talus_angle", erosion.talus_angle},
                            {"moved_vertices", done.moved_vertices},
                            {"rock_vertices", done.rock_vertices},
                            {"volume_moved", done.volume_moved}};
  const std::string words = fmt::format(
      "erosion: {} of {} vertices moved, {} are rock; the steepest loose slope is {:.2f} degrees, before "
      "{:.2f}",
      done.moved_vertices, vertices, done.rock_vertices, done.steepest_after, done.steepest_before);
  const std::string remedy = done.sweeps < erosion.iterations ? "no slide lowers it; raise --resolution"
                                                              : "raise erosion.iterations";
  job.say(words + (done.settled ? fmt::format("; settled below {:g}", erosion.talus_angle)
                                : fmt::format("; not settled below {:g}: {}", erosion.talus_angle, remedy)));
}

void report_making(Job& job, const MeshPart& part, const BodyMeshReport& made) {
  if (part.spec.least_component > 0.0) job.summary["dropped_components"] = made.dropped_components;
  if (!made.even || made.manifold.triangles == 0) return;
  const EvenStatistics& done = *made.even;
  job.summary["even"] = {
      {"quality_before", {{"first_percentile", done.before.first_percentile}, {"mean", done.before.mean}}},
      {"quality_after", {{"first_percentile", done.after.first_percentile}, {"mean", done.after.mean}}},
      {"mean_move", done.mean_move},
      {"largest_move", done.largest_move},
      {"largest_value", done.largest_value},
      {"moved_vertices", done.moved},
      {"kept_vertices", done.kept}};
  job.say(fmt::format(
      "even: quality {:.2f} at the first percentile, before {:.2f}, and {:.2f} in the mean, before "
      "{:.2f}; {} vertices moved along the surface, by {:.3g} {} in the mean and {:.3g} at most, "
      "{} stay; |F| <= {:.2g}",
      done.after.first_percentile, done.before.first_percentile, done.after.mean, done.before.mean,
      done.moved, done.mean_move, part.recipe.length_unit, done.largest_move, done.kept, done.largest_value));
}

void report_mesh(Job& job, const MeshJob& mesh, const MeshPart& part, const BodyMeshReport& made) {
  const auto& [spec, sinks, device, max_memory_gb, only_predict] = mesh;
  const Region& region = part.region;
  const ManifoldReport& report = made.manifold;
  job.summary["vertices"] = report.vertices;
  job.summary["triangles"] = report.triangles;
  job.summary["closed"] = report.closed();
  job.summary["manifold"] = report.manifold() || report.triangles == 0;
  if (!region.is_cut()) job.summary["genus"] = report.genus;
  job.summary["components"] = report.components;
  job.summary["evaluations"] = made.statistics.evaluations;
  job.summary["cell"] = made.statistics.step;
  job.summary["active_blocks"] = made.statistics.active_blocks;
  job.summary["total_blocks"] = made.statistics.total_blocks;
  if (region.is_patch || !(part.recipe.origin == Vec3d{})) {
    job.summary["origin"] = to_json(part.recipe.origin + region.center);
  }
  if (region.axes) {
    job.summary["patch_axes"] = {{"right", to_json(region.axes->right)},
                                 {"ahead", to_json(region.axes->ahead)},
                                 {"up", to_json(region.axes->up)}};
  }
  if (!region.is_cut()) question_pieces(job, part, report.components);
  if (!has_colors(part.recipe)) return;
  job.summary["vertex_colors"] = sinks.format().has_colors;
  if (!sinks.format().has_colors && sinks.bake == 0) {
    job.say("note: " + sinks.file.extension().string() +
            " holds no colours, which the recipe's layers have; write a .ply or a .glb");
  }
}

std::string describe(const MeshSpec& spec, const ManifoldReport& report) {
  const std::string triangles = spec.points ? std::to_string(report.vertices) + " points of a mesh that is "
                                            : std::to_string(report.triangles) + " triangles, ";
  if (!report.closed()) {
    return triangles + (spec.patch.empty() ? "tile " + spec.tile : "a patch") + ", open where cut, manifold";
  }
  // Rough noise leaves small separate pieces, which few people want.
  const bool crumbs = report.components > 1 && !(spec.least_component > 0.0);
  return triangles + "closed, manifold, genus " + std::to_string(report.genus) + ", " +
         counted(static_cast<std::size_t>(report.components), "component") +
         (crumbs ? " (--min-component 1e-3 leaves out small ones)" : "");
}

}  // namespace astrolith
