#include "tasks/synth/check_tiles.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "geometry/io/ply_stream_reader.h"
#include "numerics/errors.h"
#include "numerics/files/sha256.h"
#include "numerics/memory_use.h"
#include "synthesis/mesh/manifold_check.h"
#include "tasks/job/job.h"
#include "tasks/job/words.h"
#include "tasks/synth/tile_certificate.h"

namespace astrolith {
namespace {

namespace fs = std::filesystem;

struct TileCheckArguments {
  std::vector<fs::path> summaries;
  fs::path meshes;  // folder of the meshes; empty = certificates are believed
};

struct Tile {
  fs::path source;
  TileCertificate certificate;

  int number() const { return certificate.number; }
};

void add_tile_check_options(Job& job, TileCheckArguments& arguments) {
  job.options
      .add_option("summaries", arguments.summaries,
                  "the files that synth --tile I/N --summary FILE.json wrote")
      .required()
      .placeholder("FILE.json...")
      .reads();
  job.options
      .add_option("--meshes", arguments.meshes,
                  "also read the tiles' meshes (.ply) in this folder, one after the other, and confirm what "
                  "their certificates say")
      .placeholder("DIR");
}

void require_one_body(const Tile& tile, const Tile& first) {
  const auto refuse = [&](const std::string& what) {
    throw InputError(fmt::format("{}: is {} than {}; make all tiles alike", tile.source.string(), what,
                                 first.source.string()));
  };
  const TileCertificate &a = tile.certificate, &b = first.certificate;
  if (a.count != b.count)
    refuse(fmt::format("a tile of {}, not of {}, and of another set", a.count, b.count));
  if (a.resolution != b.resolution)
    refuse(fmt::format("of resolution {}, not {}, and of another set", a.resolution, b.resolution));
  if (a.recipe_sha256 != b.recipe_sha256) refuse("of another recipe or seed");
  if (a.length_unit != b.length_unit) refuse("in another length unit");
}

// The tiles by their numbers.
std::vector<Tile> read_tiles(const std::vector<fs::path>& files) {
  std::vector<Tile> tiles;
  for (const fs::path& file : files) {
    tiles.push_back({file, read_tile_certificate(file)});
    require_one_body(tiles.back(), tiles.front());
  }
  std::stable_sort(tiles.begin(), tiles.end(),
                   [](const Tile& a, const Tile& b) { return a.number() < b.number(); });
  for (std::size_t i = 1; i < tiles.size(); ++i) {
    if (tiles[i].number() != tiles[i - 1].number()) continue;
    throw InputError(fmt::format("{}: is tile {}, as {} is; give each tile once", tiles[i].source.string(),
                                 tiles[i].number(), tiles[i - 1].source.string()));
  }
  return tiles;
}

// Ends the reading of a mesh, which may be large.
class StopWhenAsked : public MeshSink {
 public:
  explicit StopWhenAsked(const Job& job) : job_(job) {}
  void add_vertices(std::span<const MeshVertex>) override { stop_if_asked(); }
  void add_triangles(std::span<const Triangle>) override { stop_if_asked(); }

 private:
  void stop_if_asked() const {
    if (job_.stopped()) throw WorkError("meshes: stopped before all were read");
  }

  const Job& job_;
};

// What keeps a mesh from being what the certificate says; empty where it is that.
std::string difference_from(const Job& job, const TileCertificate& tile, const fs::path& mesh) {
  if (mesh.extension() != ".ply") return "it is no .ply, and no other mesh is read here";
  if (file_sha256(mesh) != tile.file_sha256) return "its bytes have another SHA-256";
  const auto plane = [](const std::optional<TileSide>& side) {
    return side ? std::optional(side->z) : std::nullopt;
  };
  const TileFigures& stated = tile.figures;
  ManifoldCheck check;
  TileBorder border(plane(stated.lower), plane(stated.upper));
  StopWhenAsked stop(job);
  SinkList sinks;
  sinks.add(check);
  sinks.add(border);
  sinks.add(stop);
  PlyStreamReader(mesh).read(sinks);
  const ManifoldReport report = check.finish();
  const std::optional<TileFigures> found = border.figures();
  if (report.non_manifold_vertices > 0 || report.late_triangles > 0) return "it is not manifold";
  if (!found || found->border_vertices() != report.open_vertices)
    return "it is open elsewhere than at its sides";
  if (found->triangles != stated.triangles || found->vertices != stated.vertices)
    return fmt::format("it has {} triangles and {} vertices, not {} and {}", found->triangles,
                       found->vertices, stated.triangles, stated.vertices);
  if (found->lower != stated.lower) return "its lower side has other edges";
  if (found->upper != stated.upper) return "its upper side has other edges";
  return found->volume == stated.volume ? "" : "it has another volume";
}

// False where a mesh is not what its certificate says, which has been said then.
bool confirm_meshes(Job& job, const std::vector<Tile>& tiles, const fs::path& folder) {
  const Progress progress = job.progress("meshes");
  bool all_right = true;
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    const auto& [source, certificate] = tiles[i];
    const std::string name = fmt::format("tile {}", certificate.number);
    if (!report(progress, static_cast<double>(i) / static_cast<double>(tiles.size()), name))
      throw WorkError("meshes: stopped before all were read");
    // A name that leads elsewhere is a hostile one.
    const fs::path mesh = folder / fs::path(certificate.file).filename();
    const std::string difference = difference_from(job, certificate, mesh);
    if (difference.empty()) continue;
    all_right = false;
    job.report_failure(fmt::format("{}: is not the mesh that {} certifies: {}; make {} again", mesh.string(),
                                   source.string(), difference, name));
  }
  report(progress, 1.0, "");
  return all_right;
}

std::string describe_misfit(const TileSide& below, const TileSide& above) {
  if (below.z != above.z) return fmt::format("they are cut at {:.9g} and {:.9g}", below.z, above.z);
  if (below.vertices != above.vertices || below.loops != above.loops)
    return fmt::format("{} vertices on {} meet {} on {}", below.vertices,
                       counted(static_cast<std::size_t>(below.loops), "loop"), above.vertices,
                       counted(static_cast<std::size_t>(above.loops), "loop"));
  return below.sha256 == above.sha256 ? "" : "their vertices lie at other places or are joined otherwise";
}

struct Seams {
  int certified = 0, broken = 0;
};

Seams check_seams(Job& job, const std::vector<Tile>& tiles) {
  Seams seams;
  for (std::size_t i = 1; i < tiles.size(); ++i) {
    if (tiles[i].number() != tiles[i - 1].number() + 1) continue;
    const std::string misfit =
        describe_misfit(*tiles[i - 1].certificate.figures.upper, *tiles[i].certificate.figures.lower);
    if (misfit.empty()) {
      ++seams.certified;
      continue;
    }
    ++seams.broken;
    job.report_failure(fmt::format("{} and {}: do not fit: {}; make both again with one program",
                                   tiles[i - 1].source.string(), tiles[i].source.string(), misfit));
  }
  return seams;
}

// "1-20, 24": the numbers that no tile has.
std::string missing_tiles(const std::vector<Tile>& tiles) {
  std::string ranges;
  int next = 1;
  const auto add_until = [&](int end) {
    if (next < end)
      ranges += fmt::format("{}{}", ranges.empty() ? "" : ", ",
                            next + 1 == end ? fmt::format("{}", next) : fmt::format("{}-{}", next, end - 1));
    next = end + 1;
  };
  for (const Tile& tile : tiles) add_until(tile.number());
  add_until(tiles.front().certificate.count + 1);
  return ranges;
}

TileFigures add_figures(const std::vector<Tile>& tiles) {
  TileFigures sum;
  for (const Tile& tile : tiles) {
    sum.triangles += tile.certificate.figures.triangles;
    sum.vertices += tile.certificate.figures.vertices;
    if (const auto& side = tile.certificate.figures.lower) sum.vertices -= side->vertices;
    sum.volume += tile.certificate.figures.volume;
  }
  return sum;
}

void check_all_tiles(Job& job, const TileCheckArguments& arguments) {
  const std::vector<Tile> tiles = read_tiles(arguments.summaries);
  const TileCertificate& first = tiles.front().certificate;
  const bool true_meshes = arguments.meshes.empty() || confirm_meshes(job, tiles, arguments.meshes);
  const Seams seams = check_seams(job, tiles);
  const std::string missing = missing_tiles(tiles);
  const TileFigures whole = add_figures(tiles);
  const bool closed = true_meshes && missing.empty() && seams.broken == 0 && whole.triangles > 0;
  job.summary = {{"tiles", tiles.size()},
                 {"count", first.count},
                 {"missing", missing},
                 {"seams", first.count - 1},
                 {"seams_certified", seams.certified},
                 {"meshes_read", !arguments.meshes.empty()},
                 {"complete", missing.empty()},
                 {"closed_manifold", closed},
                 {"triangles", whole.triangles}};
  const std::string sum = fmt::format("{} of {} seams certified, {} triangles", seams.certified,
                                      first.count - 1, whole.triangles);
  if (closed) {
    job.summary["vertices"] = whole.vertices;
    job.summary["euler_characteristic"] = whole.euler_characteristic();
    job.summary["volume"] = whole.volume;
    job.say(fmt::format("{}: complete, closed, manifold; {}, Euler characteristic {}, {:.9g} {}^3{}",
                        counted(tiles.size(), "tile"), sum, whole.euler_characteristic(), whole.volume,
                        first.length_unit, arguments.meshes.empty() ? "" : "; all meshes read"));
  } else if (!missing.empty()) {
    job.report_failure(fmt::format("{} of {}: {}; make the missing ones: {}", counted(tiles.size(), "tile"),
                                   first.count, sum, missing));
  } else if (whole.triangles == 0) {
    job.report_failure("the tiles hold no triangle; take a finer resolution");
  }
  job.summary["peak_bytes"] = peak_bytes();
}

}  // namespace

JobWork declare_check_tiles(Job& job) {
  const auto arguments = std::make_shared<TileCheckArguments>();
  add_tile_check_options(job, *arguments);
  return [&job, arguments] { check_all_tiles(job, *arguments); };
}

}  // namespace astrolith
