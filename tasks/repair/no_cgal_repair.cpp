#include "numerics/errors.h"
#include "tasks/repair/cgal_repair_internal.h"

namespace astrolith {
namespace {

[[noreturn]] void refuse(const std::string& name) {
  throw InputError(name + ": needs a repair that this build leaves out (CGAL); close the mesh first");
}

}  // namespace

FilledMesh fill_holes(const TriangleMesh& /*mesh*/, const std::string& name, const Progress& /*progress*/) {
  refuse(name);
}

UncrossedMesh remove_crossings(const TriangleMesh& /*mesh*/, const std::string& name,
                               const Progress& /*progress*/) {
  refuse(name);
}

TriangleMesh alpha_wrapped(const TriangleMesh& /*mesh*/, double /*alpha*/, double /*offset*/,
                           const std::string& name) {
  refuse(name);
}

std::vector<Vec3d> jet_smoothed(std::vector<Vec3d> /*points*/, int /*neighbours*/) { refuse("points"); }

std::vector<Vec3d> jet_normals(const std::vector<Vec3d>& /*points*/, int /*neighbours*/) { refuse("points"); }

TriangleMesh poisson_surface(const std::vector<Vec3d>& /*points*/, const std::vector<Vec3d>& /*normals*/,
                             double /*facet*/, double /*error*/, const std::string& name) {
  refuse(name);
}

TriangleMesh united(const TriangleMesh& /*mesh*/, const std::string& name, const Progress& /*progress*/) {
  refuse(name);
}

}  // namespace astrolith
