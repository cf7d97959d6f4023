#include "tasks/repair/mesh_repair.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "geometry/io/mesh_io.h"
#include "geometry/mesh_measure.h"
#include "geometry/mesh_topology.h"
#include "geometry/surface/surface_tree.h"
#include "geometry/wound_surface.h"
#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "tasks/repair/cgal_repair_internal.h"
#include "tasks/repair/mesh_repair_internal.h"
#include "tasks/repair/point_surface_internal.h"

namespace astrolith {
namespace {

// A mesh with more open edges, or edges of three facets, than this share is no damaged body. The work of a
// repair grows with such edges, and garbled meshes have many of them.
constexpr double kMostBadEdges = 0.2;
// A component with less than this share of its diagonal's cube is flat: two facets on one another.
constexpr double kFlat = 1e-12;
// A finer wrap that keeps less than this share of the volume has entered the body.
constexpr double kStillFilled = 0.7;
// Vertices at one place that belong to different parts of the surface are drawn apart by this share of the
// diagonal, so that nobody who welds equal vertices joins them again.
constexpr double kApart = 1e-7;

void tell(const Progress& progress, double fraction, std::string_view words) {
  if (!report(progress, fraction, words)) throw WorkError("stopped while the mesh was repaired");
}

bool is_sound(const MeshTopology& topology) {
  return topology.closed && topology.non_manifold_edges == 0 && topology.oriented;
}

// Step 1. Equal vertices and facets, and the winding of a mesh that is closed.
void weld(MeshRepair& repair) {
  TriangleMesh& mesh = repair.mesh;
  mesh.normals.clear();
  mesh.colors.clear();
  const std::size_t vertices = mesh.vertices.size(), facets = mesh.triangles.size();
  mesh = without_unused_vertices(drop_degenerate_and_repeated_faces(weld_vertices(std::move(mesh), 0.0)));
  repair.merged_vertices += static_cast<std::int64_t>(vertices - mesh.vertices.size());
  repair.dropped_facets += static_cast<std::int64_t>(facets - mesh.triangles.size());
}

// Winds the facets of a closed mesh alike and outwards. False where it is one-sided.
bool orient(MeshRepair& repair) {
  TriangleMesh& mesh = repair.mesh;
  TriangleMesh oriented = orient_faces(mesh);
  if (!analyze_topology(oriented).oriented) return false;
  repair.turned_facets += count_turned(mesh, oriented);
  mesh = std::move(oriented);
  return true;
}

std::int64_t open_edges(const TriangleMesh& mesh) { return analyze_topology(mesh).boundary_edges; }

void require_few_bad_edges(const MeshTopology& topology, const TriangleMesh& mesh, const std::string& name) {
  const auto bad = static_cast<double>(topology.boundary_edges + topology.non_manifold_edges);
  if (bad <= kMostBadEdges * 1.5 * static_cast<double>(mesh.triangles.size())) return;
  throw InputError(name + ": " + std::to_string(topology.boundary_edges) + " edges with one face and " +
                   std::to_string(topology.non_manifold_edges) + " with more than two are no damaged body");
}

void keep_without_fins(MeshRepair& repair, WithoutFins without, double area) {
  repair.mesh = std::move(without.mesh);
  repair.dropped_facets += without.dropped_facets;
  repair.dropped_share += without.dropped_area / area;
}

// Steps 2 and 3.
void mend_borders(MeshRepair& repair, const std::string& name) {
  const double area = surface_area(repair.mesh);
  keep_without_fins(repair, without_fins(std::move(repair.mesh)), area);
  const std::int64_t open = open_edges(repair.mesh);
  JoinedBorders joined = join_borders(std::move(repair.mesh), name);
  repair.mesh = std::move(joined.mesh);
  repair.split_facets += joined.split_facets;
  repair.moved = std::max(repair.moved, joined.moved);
  repair.stitched_edges += std::max<std::int64_t>(0, open - open_edges(repair.mesh)) / 2;
  keep_without_fins(repair, without_fins(std::move(repair.mesh)), area);
  keep_without_fins(repair, without_debris(std::move(repair.mesh)), area);
  repair.mesh = without_unused_vertices(repair.mesh);
  if (repair.mesh.triangles.empty()) throw InputError(name + ": has no surface that could be closed");
}

// Drops closed components without a volume.
void drop_flat_components(MeshRepair& repair) {
  TriangleMesh& mesh = repair.mesh;
  const std::vector<std::uint32_t> number = triangle_components(mesh);
  const std::uint32_t count = *std::max_element(number.begin(), number.end()) + 1;
  if (count == 1) return;
  const Vec3d origin = mesh.bounds().center();
  std::vector<double> volumes(count, 0.0);
  for (std::size_t f = 0; f < number.size(); ++f) {
    const auto corner = [&](std::size_t k) { return mesh.vertices[mesh.triangles[f][k]] - origin; };
    volumes[number[f]] += dot(corner(0), cross(corner(1), corner(2))) / 6.0;
  }
  const double least = kFlat * repair.diagonal * repair.diagonal * repair.diagonal;
  std::vector<Triangle> kept;
  for (std::size_t f = 0; f < number.size(); ++f) {
    if (std::abs(volumes[number[f]]) > least) kept.push_back(mesh.triangles[f]);
  }
  repair.dropped_facets += static_cast<std::int64_t>(mesh.triangles.size() - kept.size());
  mesh.triangles = std::move(kept);
}

// Moves vertices that lie at one place towards the middle of their neighbours.
void draw_apart(TriangleMesh& mesh, double diagonal) {
  const auto before = [&](std::uint32_t a, std::uint32_t b) {
    const Vec3d &p = mesh.vertices[a], &q = mesh.vertices[b];
    return std::tie(p.x, p.y, p.z, a) < std::tie(q.x, q.y, q.z, b);
  };
  std::vector<std::uint32_t> order(mesh.vertices.size());
  for (std::uint32_t v = 0; v < order.size(); ++v) order[v] = v;
  std::sort(order.begin(), order.end(), before);
  std::vector<char> shared(mesh.vertices.size(), 0);
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (mesh.vertices[order[i]] == mesh.vertices[order[i - 1]]) shared[order[i]] = shared[order[i - 1]] = 1;
  }
  std::map<std::uint32_t, Vec3d> towards;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (shared[t[k]] == 0) continue;
      const Vec3d& p = mesh.vertices[t[k]];
      towards[t[k]] += (mesh.vertices[t[(k + 1) % 3]] - p) + (mesh.vertices[t[(k + 2) % 3]] - p);
    }
  }
  for (const auto& [v, direction] : towards) {
    mesh.vertices[v] += kApart * diagonal * normalized(direction);
  }
}

void require_sound(const TriangleMesh& mesh, const std::string& name) {
  const MeshTopology topology = analyze_topology(mesh);
  if (is_sound(topology)) return;
  throw InputError(name + ": is not a closed surface after its repair (" +
                   std::to_string(topology.boundary_edges) + " edges with one face, " +
                   std::to_string(topology.non_manifold_edges) + " with more than two)");
}

// Step 4.
void fill(MeshRepair& repair, const std::string& name, const Progress& progress) {
  const std::vector<Triangle> before = repair.mesh.triangles;
  FilledMesh filled = fill_holes(repair.mesh, name, progress);
  repair.mesh = std::move(filled.mesh);
  repair.stitched_edges += filled.stitched_edges;
  repair.holes += static_cast<std::int64_t>(filled.holes.size());
  drop_flat_components(repair);
  repair.mesh = without_unused_vertices(repair.mesh);
  draw_apart(repair.mesh, repair.diagonal);
  if (repair.mesh.triangles.empty() || !orient(repair)) {
    throw InputError(name + ": is one-sided; a body has an inside and an outside");
  }
  const double area = surface_area(repair.mesh);
  for (const double hole : filled.holes) {
    repair.filled_share += hole / area;
    repair.largest_hole = std::max(repair.largest_hole, hole / area);
  }
}

bool before_in_space(const Vec3d& a, const Vec3d& b) {
  return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
}

// The greatest distance from new vertices of `mesh` to the surface `old`.
double distance_moved(const TriangleMesh& mesh, const TriangleMesh& old) {
  std::vector<Vec3d> known = old.vertices;
  std::sort(known.begin(), known.end(), before_in_space);
  const SurfaceTree tree(old);
  std::vector<double> distances(mesh.vertices.size(), 0.0);
  parallel_for(
      0, static_cast<std::int64_t>(distances.size()),
      [&](std::int64_t i) {
        const auto k = static_cast<std::size_t>(i);
        const Vec3d& p = mesh.vertices[k];
        if (!std::binary_search(known.begin(), known.end(), p, before_in_space)) {
          distances[k] = tree.closest(p).distance;
        }
      },
      64);
  return *std::max_element(distances.begin(), distances.end());
}

// Step 5.
void uncross(MeshRepair& repair, const std::string& name, const Progress& progress) {
  const TriangleMesh old = repair.mesh;
  UncrossedMesh uncrossed = remove_crossings(repair.mesh, name, progress);
  if (!uncrossed.has_no_crossings) throw InputError(name + ": its crossings cannot be removed");
  repair.crossing_facets = uncrossed.crossing_facets;
  repair.mesh = without_unused_vertices(uncrossed.mesh);
  repair.moved = std::max(repair.moved, distance_moved(repair.mesh, old));
}

std::string percent(double share) { return fmt::format("{:.2g} %", 100.0 * share); }

void require_within_limits(const MeshRepair& repair, const std::string& name, double most_filled) {
  if (repair.filled_share > most_filled) {
    throw InputError(name + ": its holes are " + percent(repair.filled_share) +
                     " of the surface, which is more than a guess can fill");
  }
  if (repair.moved > kMostMoved * repair.diagonal) {
    throw InputError(name + ": a repair would move it by " + percent(repair.moved / repair.diagonal) +
                     " of the diagonal");
  }
}

void mend(MeshRepair& repair, const std::string& name, const RepairOptions& options,
          const Progress& progress) {
  const MeshTopology topology = analyze_topology(repair.mesh);
  require_few_bad_edges(topology, repair.mesh, name);
  tell(progress, 0.1, "welded");
  if (!is_sound(topology)) {
    mend_borders(repair, name);
    tell(progress, 0.3, "borders");
    fill(repair, name, [&](double fraction, std::string_view words) {
      return report(progress, 0.3 + 0.4 * fraction, words);
    });
  }
  if (options.crossings) {
    uncross(repair, name, [&](double fraction, std::string_view words) {
      return report(progress, 0.7 + 0.3 * fraction, words);
    });
  }
  require_sound(repair.mesh, name);
  require_within_limits(repair, name, options.wrap ? kMostFilledBeforeWrap : kMostFilled);
}

// Step 1 alone. Whether it made a closed body.
bool weld_and_orient(MeshRepair& repair) {
  weld(repair);
  if (repair.mesh.triangles.empty()) return false;
  const MeshTopology topology = analyze_topology(repair.mesh);
  return topology.closed && topology.non_manifold_edges == 0 && orient(repair);
}

// The wrap lies outside by its offset. Its vertices move onto the surface where that is near.
void move_onto(TriangleMesh& wrap, const SurfaceTree& tree, double offset) {
  parallel_for(
      0, static_cast<std::int64_t>(wrap.vertices.size()),
      [&](std::int64_t i) {
        Vec3d& p = wrap.vertices[static_cast<std::size_t>(i)];
        const ClosestPoint closest = tree.closest(p);
        if (closest.distance <= 1.5 * offset) p = closest.point;
      },
      64);
}

// Wraps by balls of 27, 9 and 3 times the finest radius, and by the finest. Once the ball passes through a
// hole, the wrap follows the surface inside, and most of its volume is gone: the wrap before it is taken
// then.
MeshRepair wrapped(const TriangleMesh& mesh, const std::string& name, const Progress& progress) {
  MeshRepair repair;
  repair.changed = repair.wrapped = true;
  repair.diagonal = mesh.bounds().diagonal();
  repair.wrap_alpha = kWrapAlpha * repair.diagonal;
  repair.wrap_offset = kWrapOffset * repair.diagonal;
  const double finest = repair.wrap_alpha;
  double inside = 0.0;  // volume of the wrap so far
  for (const double alpha : {27.0 * finest, 9.0 * finest, 3.0 * finest, finest}) {
    tell(progress, 0.5 * finest / alpha, "wrap");
    TriangleMesh wrap = alpha_wrapped(mesh, alpha, repair.wrap_offset, name);
    const double wrap_volume = wrap.triangles.empty() ? 0.0 : std::abs(volume(wrap));
    if (wrap_volume <= kStillFilled * inside) break;
    inside = wrap_volume;
    repair.wrap_alpha = alpha;
    repair.mesh = std::move(wrap);
  }
  if (repair.mesh.triangles.empty()) throw InputError(name + ": its wrap is empty; give a body");
  tell(progress, 0.9, "wrap");
  const SurfaceTree tree(mesh);
  move_onto(repair.mesh, tree, repair.wrap_offset);
  orient(repair);
  repair.turned_facets = 0;
  repair.moved = distance_moved(repair.mesh, mesh);
  require_sound(repair.mesh, name);
  return repair;
}

// A surface through points without faces.
MeshRepair through_points(const TriangleMesh& mesh, const std::string& name, const RepairOptions& options,
                          const Progress& progress) {
  PointSurface surface = surface_through(mesh, name, progress);
  MeshRepair repair;
  repair.changed = true;
  repair.diagonal = mesh.bounds().diagonal();
  repair.points = surface.points;
  repair.stray_points = surface.strays;
  repair.stray = surface.stray;
  repair.noise = surface.noise;
  repair.farthest_point = surface.farthest_point;
  repair.farthest_ground = surface.farthest_ground;
  repair.unseen_share = surface.unseen_share;
  repair.mesh = std::move(surface.mesh);
  constexpr double kFarthest = 0.2;  // from a surface through them, over the diagonal
  if (repair.farthest_point > kFarthest * repair.diagonal) {
    throw InputError(name + ": no one closed surface goes through its points, which lie up to " +
                     percent(repair.farthest_point / repair.diagonal) +
                     " of the diagonal from it; give the points of one body");
  }
  if (repair.unseen_share > kMostUnseen && !options.fill_unseen) {
    throw InputError(
        fmt::format("{}: no point saw {:.0f} % of the ground, which is more than a guess should fill; give "
                    "points of all sides, "
                    "or add --fill-unseen",
                    name, 100.0 * repair.unseen_share));
  }
  orient(repair);
  repair.turned_facets = 0;
  require_sound(repair.mesh, name);
  return repair;
}

void require_finite(const TriangleMesh& mesh, const std::string& name) {
  for (const Vec3d& p : mesh.vertices) {
    if (!std::isfinite(squared_norm(p))) throw InputError(name + ": a vertex is not finite; repair the file");
  }
  const double diagonal = mesh.bounds().diagonal();
  if (!(diagonal > 1e-9 && diagonal < 1e9)) {
    throw InputError(name + ": its size is out of range; scale the mesh to metres or kilometres");
  }
}

// Keeps the largest body of a scene, or all, and says how its parts lie to one another.
void sort_bodies(MeshRepair& repair, bool all_parts) {
  SceneBodies scene = find_bodies(repair.mesh);
  repair.bodies = scene.bodies;
  if (scene.bodies > 1 && !all_parts) {
    repair.changed = true;
    repair.kept_volume = scene.volume_share;
    repair.mesh = without_unused_vertices(scene.largest);
    scene = find_bodies(repair.mesh);
  }
  repair.overlapping_parts = scene.overlapping;
  repair.nested_parts = scene.nested;
  repair.cavities = scene.cavities;
  repair.undecided_parts = scene.undecided;
}

void unite_parts(MeshRepair& repair, const std::string& name, const Progress& progress) {
  if (repair.overlapping_parts + repair.nested_parts + repair.undecided_parts == 0) return;
  repair.mesh = united(repair.mesh, name, progress);
  draw_apart(repair.mesh, repair.diagonal);
  require_sound(repair.mesh, name);
  repair.changed = repair.united = true;
}

MeshRepair with_bodies(MeshRepair repair, const std::string& name, const RepairOptions& options,
                       const Progress& progress) {
  sort_bodies(repair, options.all_parts);
  if (options.unite) unite_parts(repair, name, progress);
  return repair;
}

}  // namespace

TriangleMesh read_mesh_to_repair(const std::filesystem::path& file, bool wrap) {
  if (wrap) return read_cloud(file);
  if (holds_points(file)) throw InputError(file.string() + ": holds points without faces; add --wrap");
  return read_mesh(file);
}

MeshRepair repair_mesh(TriangleMesh mesh, const std::string& name, const RepairOptions& options,
                       const Progress& progress) {
  if (mesh.triangles.empty() && !options.wrap) {
    throw InputError(name + ": holds points without faces; " + options.remedy);
  }
  MeshRepair repair;
  repair.diagonal = mesh.bounds().diagonal();
  if (!options.crossings && is_closed_body(mesh)) {
    repair.mesh = std::move(mesh);
    return with_bodies(std::move(repair), name, options, progress);
  }
  require_finite(mesh, name);
  repair.mesh = mesh;
  repair.changed = true;
  try {
    const bool closed = !mesh.triangles.empty() && weld_and_orient(repair);
    if (mesh.triangles.empty()) {
      return with_bodies(through_points(mesh, name, options, progress), name, options, progress);
    } else if (repair.mesh.triangles.empty()) {
      throw InputError(name + ": has no face with an area");
    } else if (!closed || options.crossings) {
      mend(repair, name, options, progress);
    }
  } catch (const InputError& e) {
    if (mesh.triangles.empty()) throw;
    if (!options.wrap) throw InputError(std::string(e.what()) + "; " + options.remedy);
    repair = wrapped(mesh, name, progress);
  }
  return with_bodies(std::move(repair), name, options, progress);
}

MeshRepair mend_surface(TriangleMesh mesh, const std::string& name, RepairOptions options,
                        const Progress& progress) {
  options.all_parts = true;
  if (!mesh.triangles.empty() || options.wrap) {
    try {
      return repair_mesh(mesh, name, options, progress);
    } catch (const InputError&) {
      if (options.wrap || options.unite) throw;
    }
  }
  MeshRepair repair;
  repair.diagonal = mesh.bounds().diagonal();
  WoundSurface wound = wound_surface(std::move(mesh));
  repair.changed = wound.changed();
  repair.merged_vertices = wound.merged_vertices;
  repair.turned_facets = wound.turned_faces;
  repair.mesh = std::move(wound.mesh);
  return repair;
}

TriangleMesh read_mended_surface(const std::filesystem::path& file, std::string& remark) {
  const std::string name = file.string();
  RepairOptions options;
  options.overlap = "walls lie inside it";
  MeshRepair repair = mend_surface(read_mesh_or_points(file), name, options);
  remark = repair_words(repair, "", options);
  const std::int64_t open = repair.mesh.triangles.empty() ? 0 : open_edges(repair.mesh);
  if (open > 0) {
    remark += (remark.empty() ? "" : "; ") + ("open, " + std::to_string(open)) +
              (open == 1 ? " edge has" : " edges have") + " one face only; used as it is";
  }
  if (!remark.empty()) remark = name + ": " + remark;
  return std::move(repair.mesh);
}

}  // namespace astrolith
