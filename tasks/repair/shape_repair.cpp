#include "tasks/repair/shape_repair.h"

#include <utility>

#include "tasks/repair/mesh_repair.h"

namespace astrolith {
namespace {

// The repaired mesh, of which the job says what was done.
TriangleMesh told(const Job& job, MeshRepair repair, const std::string& name, const std::string& unit,
                  const RepairOptions& options, nlohmann::ordered_json& figures) {
  if (const std::string words = repair_words(repair, unit, options); !words.empty()) {
    job.say(name + ": " + words);
  }
  if (repair.changed || mentions_parts(repair)) figures = repair_json(repair);
  return std::move(repair.mesh);
}

}  // namespace

void ShapeRepair::add_to(OptionTable& app, bool for_bodies) {
  const Option refuse =
      app.add_flag("--strict", strict,
                   for_bodies ? "refuse a mesh that is not closed, in place of its repair"
                              : "take a mesh as it is, in place of the repair of its cracks and small holes");
  const Option wrapping =
      app.add_flag(
             "--wrap", wrap,
             "where a repair moves the surface by more than 1 % of the diagonal, fills more than 5 % of "
             "it, or fails: wrap the mesh at 1/200 of the diagonal, which takes some ten seconds. Points "
             "without faces (.xyz, .pts, .asc, .ply and others) get a Poisson surface, which averages their "
             "noise")
          .excludes(refuse);
  app.add_flag("--fill-unseen", fill_unseen,
               "take the surface through points also where they saw less than two thirds of the ground")
      .needs(wrapping);
  app.add_flag("--union", unite,
               "make one surface of parts that overlap or lie inside one another, so that no rock counts "
               "twice and no wall is buried; cavities stay")
      .excludes(refuse);
  if (!for_bodies) return;
  app.add_flag("--all-parts", all_parts,
               "take all bodies of a file that holds several, in place of the largest")
      .excludes(refuse);
}

RepairOptions ShapeRepair::options() const {
  RepairOptions options;
  options.wrap = wrap;
  options.fill_unseen = fill_unseen;
  options.all_parts = all_parts;
  options.unite = unite;
  return options;
}

TriangleMesh ShapeRepair::read(const std::filesystem::path& file) const {
  return read_mesh_to_repair(file, wrap);
}

TriangleMesh ShapeRepair::closed_body(const Job& job, TriangleMesh mesh, const std::string& name,
                                      const std::string& unit, const RepairOptions& options,
                                      nlohmann::ordered_json& figures) const {
  if (strict) return mesh;
  return told(job, repair_mesh(std::move(mesh), name, options, job.progress("repair")), name, unit, options,
              figures);
}

TriangleMesh ShapeRepair::mended_surface(const Job& job, TriangleMesh mesh, const std::string& name,
                                         nlohmann::ordered_json& figures) const {
  if (strict) return mesh;
  return told(job, mend_surface(std::move(mesh), name, options(), job.progress("repair")), name, "",
              options(), figures);
}

}  // namespace astrolith
