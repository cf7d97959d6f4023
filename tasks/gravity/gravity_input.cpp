#include "tasks/gravity/gravity_input.h"

#include <fmt/format.h>

#include <charconv>
#include <sstream>
#include <utility>

#include "geometry/mesh_measure.h"
#include "geometry/mesh_topology.h"
#include "geometry/wound_surface.h"
#include "numerics/errors.h"
#include "recipe/recipe_json.h"
#include "tasks/job/body_library.h"
#include "tasks/job/density_question.h"
#include "tasks/job/load_recipe.h"
#include "tasks/job/words.h"
#include "tasks/repair/mesh_unit.h"

namespace astrolith {
namespace {

struct PartWord {
  std::string file;
  double density;
};

PartWord parse(const std::string& word) {
  const std::size_t sign = word.rfind('=');
  if (sign == std::string::npos || sign == 0) {
    throw InputError("--density-of " + word + ": names no density; write FILE=KG_M3, such as lobe.ply=2400");
  }
  PartWord part{word.substr(0, sign), 0.0};
  const char *begin = word.data() + sign + 1, *end = word.data() + word.size();
  const auto read = std::from_chars(begin, end, part.density);
  if (read.ec != std::errc{} || read.ptr != end || !(part.density >= 0.0 && part.density < 1e6)) {
    throw InputError("--density-of " + word + ": the density must be 0 to 1e6 kg/m3; give another");
  }
  return part;
}

bool holds(const Box& outer, const Box& inner) {
  const Box wide = widened(outer, 1e-3 * outer.diagonal());
  return inner.min.x >= wide.min.x && inner.min.y >= wide.min.y && inner.min.z >= wide.min.z &&
         inner.max.x <= wide.max.x && inner.max.y <= wide.max.y && inner.max.z <= wide.max.z;
}

}  // namespace

std::vector<std::filesystem::path> part_files(const std::vector<std::string>& words) {
  std::vector<std::filesystem::path> files;
  for (const std::string& list : words) {
    std::istringstream all(list);
    for (std::string word; std::getline(all, word, ',');) files.emplace_back(word.substr(0, word.rfind('=')));
  }
  return files;
}

std::vector<BodyPart> read_parts(const Job& job, const std::string& words, const std::string& unit,
                                 const GravityBody& whole, double density, int resolution,
                                 ShapeRepair repair) {
  repair.all_parts = true;
  std::vector<BodyPart> parts;
  std::istringstream all(words);
  for (std::string word; std::getline(all, word, ',');) {
    const PartWord read = parse(word);
    question_density(job, read.density);
    const bool recipe = is_recipe_name(find_body(read.file));
    nlohmann::ordered_json figures;  // the body's are those of the summary
    BodyPart part{
        read.file,
        read_gravity_body(job, read.file, {recipe ? "" : unit, whole.unit}, resolution, repair, figures),
        read.density,
        (read.density - density) / density,
        {}};
    if (part.body.unit != whole.unit) {
      throw InputError("--density-of " + read.file + ": is in " + part.body.unit + ", the body in " +
                       whole.unit + "; give it the same unit");
    }
    if (!holds(whole.mesh.bounds(), part.body.mesh.bounds())) {
      throw InputError("--density-of " + read.file +
                       ": leaves the body; give a part inside, in the body's unit and frame");
    }
    part.mass = body_mass(part.body.mesh);
    parts.push_back(std::move(part));
  }
  return parts;
}

GravityBody read_gravity_body(const Job& job, const std::filesystem::path& name, const UnitChoice& unit,
                              int resolution, const ShapeRepair& repair, nlohmann::ordered_json& figures) {
  const std::filesystem::path file = find_body(name);
  if (!is_recipe_name(file)) {
    const MeshUnit length_unit = resolve_unit(job, file, unit, {"m", "km", "cm", "mm"});
    TriangleMesh mesh = repair.read(file);
    // Edges of four facets, two each way, are no trouble for gravity, once facets that are there twice count
    // once.
    TriangleMesh clean = drop_degenerate_and_repeated_faces(mesh);
    const MeshTopology topology = analyze_topology(clean);
    const bool touches = topology.closed && topology.oriented && topology.non_manifold_edges > 0 &&
                         !repair.unite && !repair.wrap;
    if (touches) {
      if (const std::size_t dropped = mesh.triangles.size() - clean.triangles.size(); dropped > 0)
        job.say(fmt::format("{}: {} without area or there twice left out", file.string(),
                            counted(dropped, "facet")));
      WoundSurface wound = wound_surface(std::move(clean));
      if (wound.changed()) job.say(file.string() + ": " + wound.words());
      mesh = std::move(wound.mesh);
    } else {
      mesh = repair.closed_body(job, std::move(mesh), file.string(), length_unit.name, repair.options(),
                                figures);
    }
    GravityBody body = make_mesh_body(std::move(mesh), length_unit.name, file.string());
    const std::string asked = unit_question(file, volume(body.mesh), length_unit);
    if (!asked.empty()) job.say(asked);
    if (asked.empty() && length_unit.assumed)
      body.unit_words = assumed_unit_words(file.string(), length_unit.name);
    return body;
  }
  const Recipe recipe = load_recipe(file);
  if (!unit.given.empty() && unit.given != recipe.length_unit) {
    throw InputError("--unit: the recipe states " + recipe.length_unit + "; leave the option out");
  }
  return make_recipe_body(recipe, resolution, file.string(),
                          [&](const std::string& stage) { return job.progress(stage); });
}

}  // namespace astrolith
