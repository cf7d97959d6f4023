#include "tasks/gravity/gravity_body.h"

#include <utility>

#include "geometry/mesh_measure.h"
#include "geometry/mesh_topology.h"
#include "numerics/errors.h"
#include "numerics/length_unit.h"
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

}  // namespace

GravityBody make_mesh_body(TriangleMesh mesh, const std::string& unit, const std::string& name) {
  GravityBody body{std::move(mesh), unit, metres_per_unit(unit), {}};
  require_closed(name, body.mesh);
  return body;
}

GravityBody make_recipe_body(const Recipe& recipe, int resolution, const std::string& name,
                             const StageProgress& progress) {
  if (recipe.length_unit == "px") throw InputError(name + ": length_unit: px is no length; state m or km");
  if (!recipe.body) throw InputError(name + ": is a recipe without a body; give one with a body");
  if (recipe.erosion) {
    throw InputError(name + ": erosion: is of synth's mesh; run synth and give gravity the mesh");
  }
  const ImplicitField field(recipe);
  MeshCollector collector;
  mesh_field(field, field.bounds(), resolution, collector, progress("mesh"));
  for (Vec3d& p : collector.mesh.vertices) p += recipe.origin;
  return make_mesh_body(std::move(collector.mesh), recipe.length_unit, name);
}

}  // namespace astrolith
