#include "estimation/shape/target/target_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "geometry/mesh_measure.h"
#include "geometry/mesh_topology.h"
#include "geometry/surface/mesh_sampling.h"
#include "geometry/surface/surface_tree.h"
#include "geometry/triangle_mesh.h"
#include "geometry/wound_surface.h"
#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "numerics/parallel_for.h"
#include "synthesis/body/body_spheres.h"

namespace astrolith {
namespace {

struct OuterSurface {
  TriangleMesh mesh;            // without the buried triangles; open along the seam where components meet
  std::int64_t components = 1;  // number of components of the union
  // (#F of the whole mesh) the union's component that each triangle belongs to, 0 .. components - 1
  std::vector<std::uint32_t> triangle_component;
};

// SurfaceTree takes the union of this many components at most.
constexpr std::size_t kMaxComponents = 64;

struct Component {
  TriangleMesh mesh;            // all vertices of the whole mesh, and the component's own triangles
  std::vector<Vec3d> vertices;  // the corners of its triangles, with repetitions
};

// Returns an empty list if there is one component, or if there are too many.
std::vector<Component> separate(const TriangleMesh& mesh, const std::vector<std::uint32_t>& component) {
  const std::size_t count = std::size_t{1} + *std::max_element(component.begin(), component.end());
  if (count < 2 || count > kMaxComponents) return {};
  std::vector<Component> components(count);
  for (Component& one : components) one.mesh.vertices = mesh.vertices;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Component& own = components[component[t]];
    own.mesh.triangles.push_back(mesh.triangles[t]);
    for (const std::uint32_t v : mesh.triangles[t]) own.vertices.push_back(mesh.vertices[v]);
  }
  return components;
}

bool reaches_into(const Component& component, const SurfaceTree& other) {
  return std::any_of(component.vertices.begin(), component.vertices.end(),
                     [&](const Vec3d& p) { return other.signed_distance(p) > 0.0; });
}

// (#components) the component of the union that each component of the mesh belongs to, numbered from 0.
std::vector<std::uint32_t> union_groups(const std::vector<Component>& components) {
  std::vector<std::uint32_t> group(components.size());
  std::iota(group.begin(), group.end(), 0u);
  for (std::size_t b = 0; b < components.size(); ++b) {
    const SurfaceTree tree(components[b].mesh);
    for (std::size_t a = 0; a < components.size(); ++a) {
      // std::replace takes references, so it needs copies: `group` changes while it runs.
      const std::uint32_t from = group[a], to = group[b];
      if (from != to && reaches_into(components[a], tree)) std::replace(group.begin(), group.end(), from, to);
    }
  }
  std::vector<std::uint32_t> names = group;
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  for (std::uint32_t& g : group) {
    g = static_cast<std::uint32_t>(std::lower_bound(names.begin(), names.end(), g) - names.begin());
  }
  return group;
}

std::int64_t component_count(const std::vector<std::uint32_t>& numbers) {
  return std::int64_t{1} + *std::max_element(numbers.begin(), numbers.end());
}

TriangleMesh without_buried(const TriangleMesh& mesh, const SurfaceTree& tree, double depth) {
  std::vector<char> buried(mesh.triangles.size());
  parallel_for(
      0, static_cast<std::int64_t>(buried.size()),
      [&](std::int64_t t) {
        const Triangle& v = mesh.triangles[static_cast<std::size_t>(t)];
        const Vec3d centroid =
            (mesh.vertices[v[0]] + mesh.vertices[v[1]] + mesh.vertices[v[2]]) * (1.0 / 3.0);
        buried[static_cast<std::size_t>(t)] = tree.signed_distance(centroid) > depth ? 1 : 0;
      },
      64);
  TriangleMesh outer{mesh.vertices, {}, {}};
  for (std::size_t t = 0; t < buried.size(); ++t) {
    if (buried[t] == 0) outer.triangles.push_back(mesh.triangles[t]);
  }
  return outer;
}

// `mesh` is closed and oriented, and `tree` was made of it. A triangle is buried if its centroid lies deeper
// than `depth` inside the union; `depth` is in the mesh's unit. The mesh comes back unchanged if it has one
// component, more than 64 components, or cavities.
OuterSurface outer_surface(const TriangleMesh& mesh, const SurfaceTree& tree, double depth) {
  std::vector<std::uint32_t> triangle_component = triangle_components(mesh);
  const std::vector<Component> components = separate(mesh, triangle_component);
  const bool solid = std::all_of(components.begin(), components.end(),
                                 [](const Component& one) { return volume(one.mesh) > 0.0; });
  if (components.empty() || !solid) {
    return {mesh, component_count(triangle_component), std::move(triangle_component)};
  }
  const std::vector<std::uint32_t> group = union_groups(components);
  for (std::uint32_t& component : triangle_component) component = group[component];
  return {without_buried(mesh, tree, depth), component_count(group), std::move(triangle_component)};
}

// A body with a volume below this share of its diagonal's cube is a sheet or a thread: no sphere fits inside.
constexpr double kSmallestVolume = 1e-6;

// A face deeper than this inside another component is buried (fraction of the diagonal).
constexpr double kBuriedDepth = 1e-5;

// The winding number is checked at places just under the surface. Each place costs a sum over all triangles,
// so the number of places times the number of triangles is bounded, within the limits below.
constexpr std::int64_t kWindingTriangles = 20000000, kMostWindings = 200, kFewestWindings = 20;
constexpr double kJustUnder = 1e-5;  // fraction of the diagonal
// A place may lie beyond a sharp edge or a thin wall, so this share of the places may have a wrong number.
constexpr double kWrongWindings = 0.02;

TriangleMesh numbered_by_use(const TriangleMesh& mesh) {
  constexpr std::uint32_t kUnused = 0xffffffffu;
  std::vector<std::uint32_t> new_number(mesh.vertices.size(), kUnused);
  TriangleMesh compact;
  for (const Triangle& triangle : mesh.triangles) {
    Triangle renumbered{};
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint32_t& index = new_number[triangle[k]];
      if (index == kUnused) {
        index = static_cast<std::uint32_t>(compact.vertices.size());
        compact.vertices.push_back(mesh.vertices[triangle[k]]);
      }
      renumbered[k] = index;
    }
    compact.triangles.push_back(renumbered);
  }
  return compact;
}

TriangleMesh welded(TriangleMesh mesh, std::vector<std::string>& remarks) {
  const std::size_t vertices = mesh.vertices.size(), triangles = mesh.triangles.size();
  mesh = drop_degenerate_and_repeated_faces(weld_vertices(std::move(mesh), 0.0));
  mesh = numbered_by_use(mesh);
  if (mesh.vertices.size() < vertices) {
    remarks.push_back(std::to_string(vertices - mesh.vertices.size()) +
                      " repeated or unused vertices merged");
  }
  if (mesh.triangles.size() < triangles) {
    remarks.push_back(std::to_string(triangles - mesh.triangles.size()) + " empty or repeated faces dropped");
  }
  return mesh;
}

void turn_inside_out(TriangleMesh& mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
}

// Throws InputError for defects that cannot be mended, and orients the faces outwards.
void require_closed_body(TriangleMesh& mesh, const std::string& name, std::vector<std::string>& remarks) {
  MeshTopology topology = analyze_topology(mesh);
  if (!topology.closed) {
    throw InputError(name + ": mesh is open (" + std::to_string(topology.boundary_edges) +
                     " edges with one face); close the holes first");
  }
  if (topology.non_manifold_edges > 0) {
    throw InputError(name + ": mesh is not manifold (" + std::to_string(topology.non_manifold_edges) +
                     " edges with more than two faces); remove inner walls first");
  }
  if (!topology.oriented) {
    mesh = orient_faces(std::move(mesh));
    topology = analyze_topology(mesh);
    if (!topology.oriented)
      throw InputError(name + ": mesh is one-sided; a body has an inside and an outside");
    remarks.push_back("faces looked both ways; turned outwards");
  }
  if (volume(mesh) < 0.0) {
    turn_inside_out(mesh);
    remarks.push_back("mesh was inside out; faces turned outwards");
  }
}

// The share of the surface just under which the winding number is not 1: places that lie outside the body, or
// inside it twice.
double wrong_winding_share(const TriangleMesh& mesh, const TriangleMesh& surface, const Progress& progress) {
  const auto triangles = static_cast<std::int64_t>(mesh.triangles.size());
  const std::int64_t count = std::clamp(kWindingTriangles / triangles, kFewestWindings, kMostWindings);
  const SurfaceSamples samples = sample_surface(surface, count, 1);
  std::vector<char> wrong(samples.points.size());
  for (std::int64_t first = 0; first < count; first += kFewestWindings) {
    report(progress, 0.7 + 0.3 * static_cast<double>(first) / static_cast<double>(count), "winding numbers");
    parallel_for(first, std::min(count, first + kFewestWindings), [&](std::int64_t i) {
      const auto k = static_cast<std::size_t>(i);
      const double winding = winding_number(mesh, samples.points[k] - kJustUnder * samples.normals[k]);
      wrong[k] = std::abs(winding - 1.0) > 0.5 ? 1 : 0;
    });
  }
  return static_cast<double>(std::count(wrong.begin(), wrong.end(), 1)) / static_cast<double>(count);
}

void require_no_crossing(const TriangleMesh& mesh, const TriangleMesh& surface, const std::string& name,
                         const Progress& progress) {
  const double share = wrong_winding_share(mesh, surface, progress);
  if (share <= kWrongWindings) return;
  throw CrossingMesh(name + ": mesh passes through itself or has parts inside out (about " +
                     std::to_string(static_cast<int>(std::lround(100.0 * share))) +
                     " % of its surface does not bound the body); repair it first");
}

// Where the surface bends back, a point offset from it may lie too near to the surface or on its other side.
// Points nearer than this share of the offset are left out.
constexpr double kSurelyAway = 0.7;

// The point below p halfway to the opposite wall, where that wall is too near for a point at `distance`.
// Edges are no walls: the normal must look the other way.
bool find_middle(const SurfaceTree& tree, const Vec3d& p, const Vec3d& normal, double distance,
                 Vec3d& middle) {
  constexpr double kOpposite = -0.5;  // largest cosine between the walls' normals
  constexpr int kSteps = 6;
  middle = p - normal * distance;
  if (tree.signed_distance(middle) > kSurelyAway * distance) return false;
  double depth = 0.5 * distance;
  for (int step = 0; step < kSteps; ++step, depth *= 0.5) {
    middle = p - normal * depth;
    if (tree.signed_distance(middle) <= kSurelyAway * depth) continue;
    // The nearest point from a little deeper lies on the opposite wall.
    return dot(tree.closest(p - normal * (2.0 * depth)).normal, normal) < kOpposite;
  }
  return false;
}

void move_to_body_frame(TriangleMesh& mesh, const Vec3d& center, double diagonal) {
  for (Vec3d& p : mesh.vertices) p = (p - center) * (1.0 / diagonal);
}

}  // namespace

TargetBody prepare_target(TriangleMesh mesh, const std::string& name, const Progress& progress) {
  std::vector<std::string> remarks;
  mesh.normals.clear();
  mesh = welded(std::move(mesh), remarks);
  if (mesh.triangles.empty()) throw InputError(name + ": no face with an area; give a closed mesh");
  report(progress, 0.3, "welded");
  const Box box = mesh.bounds();
  const double diagonal = box.diagonal();
  if (!(diagonal > 1e-9 && diagonal < 1e9)) {
    throw InputError(fmt::format(
        "{}: bounding-box diagonal {:.3g} is out of range; scale the mesh to metres or kilometres", name,
        diagonal));
  }
  require_closed_body(mesh, name, remarks);
  move_to_body_frame(mesh, box.center(), diagonal);
  const double body_volume = volume(mesh);
  if (body_volume < kSmallestVolume) {
    throw InputError(name + ": mesh encloses no volume to speak of; give a solid body, not a sheet");
  }
  report(progress, 0.5, "topology");
  SurfaceTree tree(mesh);
  report(progress, 0.6, "tree");
  OuterSurface outer = outer_surface(mesh, tree, kBuriedDepth);
  if (outer.mesh.triangles.size() < mesh.triangles.size()) {
    remarks.push_back("components overlap; their union is fitted, walls inside it are left out (" +
                      std::to_string(mesh.triangles.size() - outer.mesh.triangles.size()) + " faces)");
  }
  if (outer.components > 1) {
    remarks.push_back("holds " + std::to_string(outer.components) +
                      " surfaces apart from one another, bodies or cavities; fitted together");
  }
  report(progress, 0.7, "outer surface");
  require_no_crossing(mesh, outer.mesh, name, progress);
  const double area = surface_area(outer.mesh);
  return {std::move(mesh),
          std::move(tree),
          std::move(outer.mesh),
          area,
          body_volume,
          outer.components,
          std::move(outer.triangle_component),
          box.center(),
          diagonal,
          std::move(remarks)};
}

MetaballBody in_target_frame(const TargetBody& target, MetaballBody body) {
  for_each_sphere(body, [&](Sphere& s) {
    s.center = (s.center - target.center) * (1.0 / target.diagonal);
    s.radius /= target.diagonal;
  });
  return body;
}

void add_containment_points(const TargetBody& target, double depth, int count, std::uint64_t seed,
                            FitPoints& points) {
  constexpr int kAttempts = 200;
  constexpr double kBoxScale = 1.3;
  const Box box = target.mesh.bounds();
  const auto search = [&](std::int64_t i, double sign, Vec3d& found) {
    CounterRandom random(seed, static_cast<std::uint64_t>(2 * i + (sign > 0.0 ? 1 : 0)));
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      const double x = random.uniform() - 0.5, y = random.uniform() - 0.5, z = random.uniform() - 0.5;
      const Vec3d e = box.extent() * kBoxScale;
      found = box.center() + Vec3d{x * e.x, y * e.y, z * e.z};
      if (sign * target.tree.signed_distance(found) > depth) return true;
    }
    return false;
  };
  for (const double sign : {1.0, -1.0}) {
    std::vector<Vec3d> candidates(static_cast<std::size_t>(count));
    std::vector<char> ok(candidates.size());
    parallel_for(
        0, count,
        [&](std::int64_t i) {
          const auto k = static_cast<std::size_t>(i);
          ok[k] = search(i, sign, candidates[k]) ? 1 : 0;
        },
        16);
    std::vector<Vec3d>& list = sign > 0.0 ? points.inside : points.outside;
    for (std::size_t k = 0; k < candidates.size(); ++k) {
      if (ok[k] != 0) list.push_back(candidates[k]);
    }
  }
}

void add_shell_points(const TargetBody& target, double distance, int count, std::uint64_t seed,
                      FitPoints& points) {
  const SurfaceSamples samples = sample_surface(target.surface, count, seed, SampleNormals::interpolated);
  std::vector<Vec3d> inner(samples.points.size()), outer(samples.points.size());
  std::vector<char> inner_ok(inner.size()), outer_ok(outer.size());
  parallel_for(
      0, static_cast<std::int64_t>(inner.size()),
      [&](std::int64_t k) {
        const auto i = static_cast<std::size_t>(k);
        inner[i] = samples.points[i] - samples.normals[i] * distance;
        outer[i] = samples.points[i] + samples.normals[i] * distance;
        inner_ok[i] = target.tree.signed_distance(inner[i]) > kSurelyAway * distance ? 1 : 0;
        outer_ok[i] = target.tree.signed_distance(outer[i]) < -kSurelyAway * distance ? 1 : 0;
      },
      16);
  for (std::size_t i = 0; i < inner.size(); ++i) {
    if (inner_ok[i] != 0) points.inside.push_back(inner[i]);
    if (outer_ok[i] != 0) points.outside.push_back(outer[i]);
  }
}

void add_middle_points(const TargetBody& target, double distance, int count, std::uint64_t seed,
                       FitPoints& points) {
  const SurfaceSamples samples = sample_surface(target.surface, count, seed, SampleNormals::interpolated);
  std::vector<Vec3d> middle(samples.points.size());
  std::vector<char> found(middle.size());
  parallel_for(
      0, static_cast<std::int64_t>(middle.size()),
      [&](std::int64_t k) {
        const auto i = static_cast<std::size_t>(k);
        found[i] =
            find_middle(target.tree, samples.points[i], samples.normals[i], distance, middle[i]) ? 1 : 0;
      },
      16);
  for (std::size_t i = 0; i < middle.size(); ++i) {
    if (found[i] != 0) points.inside.push_back(middle[i]);
  }
}

}  // namespace astrolith
