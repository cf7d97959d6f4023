// What programs do with a mesh that is no closed body: --strict, --wrap,
// --fill-unseen, --union and --all-parts.
#pragma once

#include <filesystem>
#include <string>

#include "geometry/triangle_mesh.h"
#include "tasks/job/job.h"
#include "tasks/repair/mesh_repair.h"

namespace astrolith {

struct ShapeRepair {
  bool strict = false, wrap = false, fill_unseen = false, unite = false, all_parts = false;

  // Programs of surfaces take all bodies of a scene: they have no --all-parts.
  void add_to(OptionTable& app, bool for_bodies = true);
  RepairOptions options() const;

  // Reads a mesh. With --wrap also points, as read_cloud() does.
  TriangleMesh read(const std::filesystem::path& file) const;

  // The closed body of a mesh in `unit`. Says what was done; `figures` gets the fields repair.* of the
  // summary, or nothing where nothing was done. With --strict the mesh comes back as it is. Throws InputError
  // for a mesh that cannot be repaired.
  TriangleMesh closed_body(const Job& job, TriangleMesh mesh, const std::string& name,
                           const std::string& unit, const RepairOptions& options,
                           nlohmann::ordered_json& figures) const;

  // The mesh repaired for a program that takes any surface, as mend_surface does.
  TriangleMesh mended_surface(const Job& job, TriangleMesh mesh, const std::string& name,
                              nlohmann::ordered_json& figures) const;
};

}  // namespace astrolith
