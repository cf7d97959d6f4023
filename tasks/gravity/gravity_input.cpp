#include "tasks/gravity/gravity_input.h"

#include <fmt/format.h>

#include <utility>

#include "geometry/mesh_measure.h"
#include "geometry/mesh_topology.h"
#include "geometry/weld.h"
#include "geometry/wound_surface.h"
#include "numerics/errors.h"
#include "recipe/recipe_json.h"
#include "tasks/job/body_library.h"
#include "tasks/job/load_recipe.h"
#include "tasks/job/words.h"
#include "tasks/repair/unit_question.h"

namespace astrolith {

GravityBody read_gravity_body(const Job& job, const std::filesystem::path& name, const UnitChoice& unit,
                              int resolution, const ShapeRepair& repair, nlohmann::ordered_json& figures) {
  const std::filesystem::path file = find_body(name);
  if (!is_recipe_name(file)) {
    const MeshUnit length_unit = unit_of_mesh(job, file, unit, {"m", "km", "cm", "mm"});
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
    GravityBody body = body_of_mesh(std::move(mesh), length_unit.name, file.string());
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
  return body_of_recipe(recipe, resolution, file.string(),
                        [&](const std::string& stage) { return job.progress(stage); });
}

}  // namespace astrolith
