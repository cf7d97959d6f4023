#include "apps/gravity/gravity_body.h"

#include "apps/gravity_table.h"
#include "geometry/io/mesh_io.h"
#include "geometry/mesh_measure.h"
#include "geometry/mesh_topology.h"
#include "numerics/errors.h"
#include "recipe/recipe_json.h"
#include "synthesis/field/field_mesh.h"

namespace astrolith {
namespace {

void require_closed(const std::string& name, const TriangleMesh& mesh) {
  const MeshTopology topology = analyze_topology(mesh);
  if (!topology.closed) {
    throw InputError(name + ": the mesh is open (" + std::to_string(topology.boundary_edges) +
                     " boundary edges) and encloses no mass; close it first");
  }
  if (!topology.oriented) {
    throw InputError(name + ": neighbouring faces wind in opposite senses (" +
                     std::to_string(topology.misoriented_edges) + " edges); orient them first");
  }
  if (!(volume(mesh) > 0.0)) {
    throw InputError(name + ": the volume is not positive; turn the faces counter-clockwise from outside");
  }
}

TriangleMesh mesh_of(const Program& program, const Recipe& recipe, const std::string& name, int resolution) {
  if (!recipe.body) throw InputError(name + ": is a recipe without a body; give one with a body");
  if (recipe.erosion) {
    throw InputError(name + ": erosion: is of synth's mesh; run synth and give gravity the mesh");
  }
  const ImplicitField field(recipe);
  MeshCollector collector;
  mesh_field(field, field.bounds(), resolution, collector, program.progress("mesh"));
  return std::move(collector.mesh);
}

}  // namespace

GravityBody read_gravity_body(const Program& program, const std::filesystem::path& file,
                              const std::string& unit, int resolution) {
  GravityBody body;
  if (file.extension() == ".json") {
    const Recipe recipe = read_recipe(file);
    if (!unit.empty() && unit != recipe.length_unit) {
      throw InputError("--unit: the recipe states " + recipe.length_unit + "; leave the option out");
    }
    body.unit = recipe.length_unit;
    if (body.unit == "px") throw InputError(file.string() + ": length_unit: px is no length; state m or km");
    body.mesh = mesh_of(program, recipe, file.string(), resolution);
  } else {
    body.unit = unit.empty() ? "km" : unit;
    body.mesh = read_mesh(file);
  }
  body.metres = metres_of(body.unit);
  require_closed(file.string(), body.mesh);
  return body;
}

}  // namespace astrolith
