#include "tasks/estimation/repaired_target.h"

#include <utility>

#include "tasks/repair/repair_words.h"

namespace astrolith {

RepairedTarget repaired_target(TriangleMesh mesh, const std::string& name, const std::string& unit,
                               bool strict, RepairOptions options, const Progress& repairing,
                               const Progress& preparing) {
  if (strict) return {prepare_target(std::move(mesh), name, preparing), {}, {}};
  std::vector<std::string> said;
  nlohmann::ordered_json figures;
  const auto repair = [&] {
    MeshRepair done = repair_mesh(std::move(mesh), name, options, repairing);
    mesh = std::move(done.mesh);
    if (std::string words = repair_words(done, unit, options); !words.empty())
      said.push_back(std::move(words));
    if (done.changed || says_of_parts(done)) figures = repair_json(done);
  };
  options.overlap = "the union is fitted";
  repair();
  try {
    return {prepare_target(mesh, name, preparing), said, figures};
  } catch (const CrossingMesh&) {
    options.crossings = true;
    repair();
    TargetBody target = prepare_target(std::move(mesh), name, preparing);
    return {std::move(target), said, figures};
  }
}

}  // namespace astrolith
