#include "tasks/synth/detail_levels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/io/mesh_format.h"
#include "numerics/errors.h"
#include "synthesis/mesh/sample_grid.h"

namespace astrolith {
namespace {

namespace fs = std::filesystem;

// The cells of a level along the body's longest side, where the finest mesh has `finest`.
int level_resolution(int level, int finest) {
  constexpr double kBorder = 2.0;  // cells that hold no surface, whatever the resolution
  return static_cast<int>(std::lround(kBorder + (finest - kBorder) / double(1 << level)));
}

// The share of the screen's height below which each level gives way to the next: where what the next one
// leaves out is smaller than a pixel of a screen of 1080 rows. The last level is never taken away.
std::vector<double> find_coverage(const std::vector<DetailLevel>& coarser, double diagonal) {
  constexpr double kRows = 1080.0, kMost = 0.9;
  std::vector<double> coverage;
  for (const DetailLevel& level : coarser) {
    const double share = level.error.p99 > 0.0 ? diagonal / (kRows * level.error.p99) : kMost;
    coverage.push_back(std::min(share, coverage.empty() ? kMost : 0.9 * coverage.back()));
  }
  coverage.push_back(0.0);
  return coverage;
}

}  // namespace

fs::path level_file(const fs::path& output, int level) {
  const std::string extension = mesh_extension(output), name = output.string();
  if (level == 0 || extension == ".glb") return output;
  const std::size_t end = name.size() - extension.size() - (output.extension() == ".zst" ? 4 : 0);
  return name.substr(0, end) + "_lod" + std::to_string(level) + name.substr(end);
}

std::vector<fs::path> level_files(const fs::path& output, int levels) {
  std::vector<fs::path> files{output};
  for (int level = 1; level < levels && level_file(output, level) != output; ++level)
    files.push_back(level_file(output, level));
  return files;
}

void check_levels(int levels, int resolution) {
  if (levels < 2 || level_resolution(levels - 1, resolution) >= kMinResolution) return;
  throw InputError(
      fmt::format("--lod: level {} would have {} cells along the body; ask for fewer levels or a finer mesh",
                  levels - 1, level_resolution(levels - 1, resolution)));
}

std::vector<DetailLevel> coarser_levels(Job& job, const MeshPart& part, int levels,
                                        const TriangleMesh& mesh) {
  constexpr std::int64_t kSamples = 100000;  // as compare takes
  std::vector<DetailLevel> coarser;
  if (levels < 2) return coarser;
  const SurfaceTree tree(mesh);
  for (int k = 1; k < levels; ++k) {
    const MeshPart level = part.with_cells(level_resolution(k, part.resolution));
    MeshCollector collector;
    make_body_mesh(level, collector, job.stages());
    const SurfaceTree level_tree(collector.mesh);
    const SurfaceDistanceReport error =
        surface_distance(mesh, tree, collector.mesh, level_tree, kSamples, 1, job.progress("distance"));
    coarser.push_back({std::move(collector.mesh), level.resolution, error});
  }
  return coarser;
}

void write_levels(Job& job, const fs::path& output, int resolution, const std::vector<DetailLevel>& coarser,
                  std::span<const MeshLevel> levels, const MeshFileInfo& info) {
  const TriangleMesh& mesh = *levels.front().mesh;
  auto list = nlohmann::ordered_json::array();
  const auto add = [&](int level, const TriangleMesh& made, int cells, const SurfaceDistanceReport& error) {
    list.push_back({{"file", level_file(output, level).filename().string()},
                    {"resolution", cells},
                    {"triangles", made.triangles.size()},
                    {"mean_error", error.mean},
                    {"largest_error", error.max}});
  };
  add(0, mesh, resolution, {});
  for (std::size_t k = 0; k < coarser.size(); ++k) {
    const int level = static_cast<int>(k) + 1;
    add(level, coarser[k].mesh, coarser[k].resolution, coarser[k].error);
    job.say(fmt::format("level {}: {} triangles, {:.3g} {} from the finest, {:.3g} at most", level,
                        coarser[k].mesh.triangles.size(), coarser[k].error.mean, info.length_unit,
                        coarser[k].error.max));
  }
  job.summary["levels"] = std::move(list);
  if (level_file(output, 1) != output) {
    for (std::size_t k = 1; k < levels.size(); ++k) {
      MeshFileInfo level_tree = info;
      level_tree.skin = levels[k].skin;
      write_mesh(*levels[k].mesh, level_file(output, static_cast<int>(k)), level_tree);
    }
    return;
  }
  write_mesh_levels(levels, find_coverage(coarser, mesh.bounds().diagonal()), output, info);
}

}  // namespace astrolith
