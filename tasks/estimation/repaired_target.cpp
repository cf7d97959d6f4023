#include "tasks/estimation/repaired_target.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "numerics/errors.h"
#include "numerics/files/sha256.h"
#include "tasks/repair/mesh_repair.h"

namespace astrolith {

TriangleMesh read_target_mesh(FitArguments& arguments) {
  if (arguments.in_memory) {
    Sha256 hash;
    hash.update(arguments.in_memory->vertices.data(), arguments.in_memory->vertices.size() * sizeof(Vec3d));
    hash.update(arguments.in_memory->triangles.data(),
                arguments.in_memory->triangles.size() * sizeof(Triangle));
    arguments.mesh_sha256 = hash.hex();
    return *arguments.in_memory;
  }
  arguments.mesh_sha256 = file_sha256(arguments.mesh);
  TriangleMesh mesh = arguments.repair.read(arguments.mesh);
  if (file_sha256(arguments.mesh) != arguments.mesh_sha256) {
    throw InputError(arguments.mesh + ": changed while it was read; run again when it is whole");
  }
  return mesh;
}

Vec3d local_origin(const TriangleMesh& mesh) {
  constexpr double kFar = 8.0;  // lengths
  const Box box = mesh.bounds();
  const double length = box.diagonal();
  if (!(norm(box.center()) > kFar * length)) return {};
  double steps = 1.0;  // in a unit: a power of ten, so that the numbers are short
  while (steps * length < 1.0) steps *= 10.0;
  const auto rounded = [&](double c) { return std::round(steps * c) / steps + 0.0; };  // no -0
  const Vec3d center = box.center();
  return {rounded(center.x), rounded(center.y), rounded(center.z)};
}

TargetBody repaired_target(Job& job, const FitArguments& arguments, TriangleMesh mesh,
                           const Progress& preparing) {
  const std::string& name = arguments.mesh;
  const Progress repairing = job.progress("repair");
  RepairOptions options = arguments.repair.options();
  options.overlap = "the union is fitted";
  std::vector<std::string> remarks;
  nlohmann::ordered_json figures;
  const auto repair = [&] {
    MeshRepair done = repair_mesh(std::move(mesh), name, options, repairing);
    mesh = std::move(done.mesh);
    if (std::string words = repair_words(done, arguments.unit, options); !words.empty())
      remarks.push_back(std::move(words));
    if (done.changed || mentions_parts(done)) figures = repair_json(done);
  };
  const auto prepared = [&]() -> TargetBody {
    if (arguments.repair.strict) return prepare_target(std::move(mesh), name, preparing);
    repair();
    try {
      return prepare_target(mesh, name, preparing);
    } catch (const CrossingMesh&) {
      options.crossings = true;
      repair();
      return prepare_target(std::move(mesh), name, preparing);
    }
  };
  TargetBody target = prepared();
  remarks.insert(remarks.end(), target.remarks.begin(), target.remarks.end());
  for (const std::string& remark : remarks) job.say(name + ": " + remark);
  if (!figures.is_null()) job.summary["repair"] = figures;
  return target;
}

}  // namespace astrolith
