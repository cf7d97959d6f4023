#include "tasks/synth/body_mesh.h"

#include <string>
#include <utility>

#include "numerics/errors.h"
#include "synthesis/mesh/mesh_components.h"

namespace astrolith {
namespace {

// Throws WorkError for a mesh that is not manifold or not closed. A tile or patch may be open where it was
// cut.
void require_closed_manifold(const ManifoldReport& report, const MeshStatistics& statistics) {
  if (report.open_vertices != statistics.cut_vertices || report.late_triangles > 0 ||
      report.non_manifold_vertices > 0) {
    throw WorkError("the mesh is not a closed manifold (" + std::to_string(report.open_vertices) +
                    " open and " + std::to_string(report.non_manifold_vertices) +
                    " non-manifold vertices); nothing was written");
  }
}

// Meshes the region into a sink, without the pieces that are too small. Returns the statistics, and sets the
// number of pieces left out.
MeshStatistics mesh_without_crumbs(const BodyMeshJob& job, MeshSink& sink, const StageProgress& progress,
                                   std::int64_t& dropped) {
  const auto mesh = [&](MeshSink& to, const char* stage) {
    return mesh_region(job.field, job.region, job.resolution, to, progress(stage), job.device);
  };
  if (!(job.least_component > 0.0)) return mesh(sink, "mesh");
  ComponentSizes sizes;
  mesh(sizes, "pieces");
  ComponentChoice choice = sizes.larger_than(job.least_component);
  dropped = choice.dropped_components;
  ComponentFilter filter(std::move(choice), sink);
  const MeshStatistics statistics = mesh(filter, "mesh");
  filter.finish();
  return statistics;
}

// Meshes the region as above, makes its triangles more even, and passes them on in the same batches.
void mesh_evenly(const BodyMeshJob& job, MeshSink& sink, const StageProgress& progress,
                 BodyMeshReport& result) {
  RecordedMesh mesh;
  result.statistics = mesh_without_crumbs(job, mesh, progress, result.dropped_components);
  result.even = even_region(job.field, job.region, result.statistics.step, mesh, progress("even"));
  result.statistics.evaluations += result.even->evaluations;
  mesh.replay(sink);
}

}  // namespace

BodyMeshReport make_body_mesh(const BodyMeshJob& job, MeshSink& sink, const StageProgress& progress) {
  ManifoldCheck check;
  SinkList sinks;
  sinks.add(check);
  sinks.add(sink);
  BodyMeshReport result;
  if (job.even) {
    mesh_evenly(job, sinks, progress, result);
  } else {
    result.statistics = mesh_without_crumbs(job, sinks, progress, result.dropped_components);
  }
  result.manifold = check.finish();
  if (result.manifold.triangles == 0) {
    if (job.may_be_empty) return result;
    fail_empty(job.recipe, job.field, job.region, job.resolution, job.file);
  }
  require_closed_manifold(result.manifold, result.statistics);
  return result;
}

void require_body(const Recipe& recipe, const std::filesystem::path& file) {
  if (recipe.body) return;
  throw InputError(file.string() +
                   ": body: absent; lay its layers on a body with --base BODY.json, or draw its height map "
                   "with --texture WxH");
}

ImplicitField field_of_region(const Recipe& recipe, const std::filesystem::path& file, const Region& region,
                              const Progress& progress) {
  ImplicitField field(recipe, file.string(), region.cube(), progress);
  if (field.bounds().empty()) {
    throw InputError(file.string() + ": body.iso_value: no point of the body reaches it; lower it");
  }
  return field;
}

}  // namespace astrolith
