#include "tasks/repair/shape_repair.h"

#include <utility>

#include "geometry/mesh_topology.h"
#include "numerics/errors.h"
#include "tasks/repair/repair_words.h"

namespace astrolith {

void ShapeRepair::add_to(OptionTable& app, bool of_bodies) {
  const Option refuse =
      app.add_flag("--strict", strict,
                   of_bodies ? "refuse a mesh that is not closed, in place of its repair"
                             : "take a mesh as it is, in place of the repair of its cracks and small holes");
  app.add_flag("--wrap", wrap,
               "where a repair moves the surface by more than 1 % of the diagonal, fills more than 5 % of "
               "it, or fails: wrap the mesh at 1/200 of the diagonal, which takes some ten seconds. Points "
               "without faces (.xyz) are wrapped, too")
      .excludes(refuse);
  if (!of_bodies) return;
  app.add_flag("--all-parts", all_parts,
               "take all bodies of a file that holds several, in place of the largest")
      .excludes(refuse);
}

RepairOptions ShapeRepair::options() const {
  RepairOptions options;
  options.wrap = wrap;
  options.all_parts = all_parts;
  return options;
}

TriangleMesh ShapeRepair::read(const std::filesystem::path& file) const {
  return read_mesh_to_repair(file, wrap);
}

TriangleMesh ShapeRepair::closed_body(const Job& job, TriangleMesh mesh, const std::string& name,
                                      const std::string& unit, const RepairOptions& options,
                                      nlohmann::ordered_json& figures) const {
  if (strict) return mesh;
  MeshRepair repair = repair_mesh(std::move(mesh), name, options, job.progress("repair"));
  if (const std::string words = repair_words(repair, unit); !words.empty()) job.say(name + ": " + words);
  if (repair.changed || repair.bodies > 1) figures = repair_json(repair);
  return std::move(repair.mesh);
}

TriangleMesh ShapeRepair::mended_surface(const Job& job, TriangleMesh mesh, const std::string& name,
                                         nlohmann::ordered_json& figures) const {
  const bool points = mesh.triangles.empty();
  if (strict || (points && !wrap)) return mesh;
  if (!points) {
    const MeshTopology topology = analyze_topology(mesh);
    if (topology.closed && topology.non_manifold_edges == 0) return mesh;
  }
  RepairOptions options = this->options();
  options.all_parts = options.caller_welds = true;
  try {
    MeshRepair repair = repair_mesh(mesh, name, options, job.progress("repair"));
    if (!repair.changed) return mesh;
    job.say(name + ": " + repair_words(repair, ""));
    figures = repair_json(repair);
    return std::move(repair.mesh);
  } catch (const InputError&) {
    if (wrap) throw;
    return mesh;
  }
}

}  // namespace astrolith
