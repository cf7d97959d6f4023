#include "geometry/surface/surface_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "geometry/mesh_edges.h"
#include "geometry/mesh_measure.h"
#include "geometry/mesh_topology.h"
#include "geometry/surface/embree_internal.h"
#include "geometry/surface/triangle_scene.h"
#include "numerics/errors.h"

namespace astrolith {
namespace {

using Feature = TriangleFeature;

ClosestOnTriangle at(const Vec3d& p, const Vec3d& point, Feature feature) {
  return {point, squared_norm(p - point), feature};
}

// The point nearest to p on the segment from start to end. The last three arguments name the segment's two
// ends and its inside.
ClosestOnTriangle closest_on_segment(const Vec3d& p, const Vec3d& start, const Vec3d& end, Feature at_start,
                                     Feature at_end, Feature between) {
  const Vec3d along = end - start;
  const double length2 = squared_norm(along);
  const double t = dot(p - start, along);
  if (!(t > 0)) return at(p, start, at_start);
  if (t >= length2) return at(p, end, at_end);
  return at(p, start + (t / length2) * along, between);
}

ClosestOnTriangle nearer(const ClosestOnTriangle& x, const ClosestOnTriangle& y) {
  return y.squared_distance < x.squared_distance ? y : x;
}

ClosestOnTriangle closest_on_boundary(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const auto ab = closest_on_segment(p, a, b, Feature::corner_a, Feature::corner_b, Feature::side_ab);
  const auto bc = closest_on_segment(p, b, c, Feature::corner_b, Feature::corner_c, Feature::side_bc);
  const auto ca = closest_on_segment(p, c, a, Feature::corner_c, Feature::corner_a, Feature::side_ca);
  return nearer(nearer(ab, bc), ca);
}

Box triangle_box(const TriangleMesh& mesh, std::size_t triangle, double margin) {
  Box box;
  for (const std::uint32_t v : mesh.triangles[triangle]) box.extend(mesh.vertices[v]);
  const Vec3d around{margin, margin, margin};
  return {box.min - around, box.max + around};
}

// The mean number of triangles whose boxes hold a place of the surface, by some places and some of the boxes:
// a search looks at no fewer. Boxes are as wide as single precision makes them.
double triangles_at_a_place(const TriangleMesh& mesh) {
  constexpr std::size_t kPlaces = 64, kBoxes = 1 << 16;
  const std::size_t count = mesh.triangles.size(), step = count / kBoxes + 1;
  const double margin = 1e-6 * mesh.bounds().diagonal();
  std::vector<Vec3d> places;
  for (std::size_t k = 0; k < kPlaces; ++k) {
    const auto [a, b, c] = mesh.triangles[(2 * k + 1) * count / (2 * kPlaces)];
    places.push_back((mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) * (1.0 / 3.0));
  }
  std::size_t held = 0;
  for (std::size_t t = 0; t < count; t += step) {
    const Box box = triangle_box(mesh, t, margin);
    for (const Vec3d& p : places) held += boxes_touch(box, {p, p}) ? step : 0;
  }
  return static_cast<double>(held) / static_cast<double>(kPlaces);
}

// Measured shapes have 2 to 3 triangles at a place, a cylinder of 1,000 sides 60. Where there are 4,000, the
// 200,000 searches of a comparison took 25 seconds.
constexpr double kMostAtAPlace = 500.0;

const TriangleMesh& checked(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) throw InputError("mesh: has no triangles; a surface needs at least one");
  for (const Vec3d& p : mesh.vertices) {
    if (!std::isfinite(squared_norm(p))) throw InputError("mesh: a vertex is not finite; repair the file");
  }
  check_indices(mesh);
  if (const double crowd = triangles_at_a_place(mesh); crowd > kMostAtAPlace) {
    throw InputError("mesh: " + std::to_string(std::llround(crowd)) +
                     " of its faces meet at each place; vertices are far outside the body, or vertices or "
                     "faces are garbled: repair the file");
  }
  return mesh;
}

// The mesh in the unit ball about the centre of its box.
TriangleScene unit_scene(const TriangleMesh& mesh) {
  const Box box = mesh.bounds();
  return {mesh, box.center(), box.diagonal() > 0 ? 2 / box.diagonal() : 1};
}

// (3 #F) pseudo-normals of the sides that start at each corner: the normalised sum of the unit normals of all
// triangles at the edge.
std::vector<Vec3d> side_normals(const TriangleMesh& mesh, const std::vector<Vec3d>& faces) {
  std::vector<Vec3d> normals(3 * mesh.triangles.size());
  for_each_edge(sorted_sides(mesh), [&](std::span<const TriangleSide> edge) {
    Vec3d sum;
    for (const TriangleSide& side : edge) sum += faces[side.triangle];
    for (const TriangleSide& side : edge) normals[3 * side.triangle + side.corner] = normalized(sum);
  });
  return normals;
}

}  // namespace

ClosestOnTriangle closest_on_triangle(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d normal = cross(b - a, c - a);
  // Barycentric coordinates of p's projection, not normalised. Each is positive on the inner side of one side
  // of the triangle.
  const double over_a = dot(normal, cross(b - p, c - p));
  const double over_b = dot(normal, cross(c - p, a - p));
  const double over_c = dot(normal, cross(a - p, b - p));
  if (!(over_a > 0 && over_b > 0 && over_c > 0)) return closest_on_boundary(p, a, b, c);
  // The weights sum to one. Differences from a corner therefore keep the digits of triangles far from the
  // origin.
  const double total = over_a + over_b + over_c;
  return at(p, a + (over_b / total) * (b - a) + (over_c / total) * (c - a), Feature::face);
}

// A component that may overlap another.
struct SurfaceTree::Body {
  Box box;
  SurfaceTree tree;
};

struct SurfaceTree::State {
  TriangleMesh mesh;                         // without normals
  std::vector<Vec3d> faces, sides, corners;  // unit pseudo-normals, (#F), (3 #F), (#V)
  TriangleScene scene;                       // inside the unit ball
  std::vector<Body> bodies;                  // the components whose boxes meet another component's box

  explicit State(const TriangleMesh& m)
      : mesh{m.vertices, m.triangles, {}},
        faces(triangle_normals(m)),
        sides(side_normals(m, faces)),
        corners(vertex_normals(m)),
        scene(unit_scene(m)) {}

  ClosestOnTriangle on_triangle(const Vec3d& p, std::uint32_t t) const {
    const Triangle& v = mesh.triangles[t];
    return closest_on_triangle(p, mesh.vertices[v[0]], mesh.vertices[v[1]], mesh.vertices[v[2]]);
  }
  Vec3d normal(std::uint32_t t, TriangleFeature feature) const {
    const auto index = static_cast<std::size_t>(feature);
    if (feature == TriangleFeature::face) return faces[t];
    return index < 3 ? corners[mesh.triangles[t][index]] : sides[3 * std::size_t{t} + index - 3];
  }
};

namespace {

// Overlaps are sought among at most this many components. All pairs are compared, and each component gets a
// tree.
constexpr std::size_t kMaxBodies = 64;

// The components as separate meshes, when there are 2 to kMaxBodies of them and all are wound outwards;
// otherwise an empty list.
std::vector<TriangleMesh> separate_bodies(const TriangleMesh& mesh) {
  const std::vector<std::uint32_t> component = triangle_components(mesh);
  const std::size_t count = std::size_t{1} + *std::max_element(component.begin(), component.end());
  if (count < 2 || count > kMaxBodies) return {};
  std::vector<TriangleMesh> bodies(count);
  std::vector<std::uint32_t> renumbered(mesh.vertices.size(), std::numeric_limits<std::uint32_t>::max());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    TriangleMesh& body = bodies[component[t]];
    Triangle triangle = mesh.triangles[t];
    for (std::uint32_t& v : triangle) {
      std::uint32_t& own = renumbered[v];
      if (own == std::numeric_limits<std::uint32_t>::max()) {
        own = static_cast<std::uint32_t>(body.vertices.size());
        body.vertices.push_back(mesh.vertices[v]);
      }
      v = own;
    }
    body.triangles.push_back(triangle);
  }
  const bool outwards =
      std::all_of(bodies.begin(), bodies.end(), [](const TriangleMesh& body) { return volume(body) > 0; });
  return outwards ? bodies : std::vector<TriangleMesh>();
}

// Beyond this many radii from the mesh, boxes cannot be told apart in single precision.
constexpr double kFarInRadii = 1e5;

// The best candidate of one query.
struct Search {
  const Vec3d& p;
  double scaled_norm;  // distance of p from the mesh's centre, in radii
  std::uint32_t triangle = 0;
  ClosestOnTriangle best{{}, std::numeric_limits<double>::infinity(), TriangleFeature::face};

  // Takes the candidate and returns true when it is nearer than the best one, or as near with a lower index.
  bool offer(const ClosestOnTriangle& candidate, std::uint32_t t) {
    const double d2 = candidate.squared_distance;
    if (d2 > best.squared_distance || (d2 == best.squared_distance && t >= triangle)) return false;
    best = candidate;
    triangle = t;
    return true;
  }
  // A radius in single precision that surely reaches the best candidate. Positions and distances carry
  // rounding errors of a few 2^-24 of the numbers involved; 16 times 2^-24 is allowed for them.
  float safe_radius(double scale) const {
    return static_cast<float>(std::sqrt(best.squared_distance) * scale * (1 + 1e-6) +
                              1e-6 * (1 + scaled_norm));
  }
};

}  // namespace

SurfaceTree::SurfaceTree(const TriangleMesh& mesh) : state_(std::make_unique<State>(checked(mesh))) {
  const std::vector<TriangleMesh> bodies = separate_bodies(mesh);
  for (const TriangleMesh& body : bodies) {
    const auto meets = [&](const TriangleMesh& other) {
      return &other != &body && boxes_touch(body.bounds(), other.bounds());
    };
    if (std::any_of(bodies.begin(), bodies.end(), meets)) {
      state_->bodies.push_back({body.bounds(), SurfaceTree(body)});
    }
  }
}

SurfaceTree::SurfaceTree(SurfaceTree&&) noexcept = default;
SurfaceTree& SurfaceTree::operator=(SurfaceTree&&) noexcept = default;
SurfaceTree::~SurfaceTree() = default;

ClosestPoint SurfaceTree::closest(const Vec3d& p) const {
  const Vec3d q = state_->scene.to_scene(p);
  Search search{p, norm(q)};
  if (search.scaled_norm > kFarInRadii) {
    for (std::uint32_t t = 0; t < state_->mesh.triangles.size(); ++t)
      search.offer(state_->on_triangle(p, t), t);
  } else {
    struct Call {
      const State& state;
      Search& search;
    } call{*state_, search};
    const auto visit = [](RTCPointQueryFunctionArguments* arguments) {
      auto& [state, current] = *static_cast<Call*>(arguments->userPtr);
      const std::uint32_t t = arguments->primID;
      if (!current.offer(state.on_triangle(current.p, t), t)) return false;
      arguments->query->radius = current.safe_radius(state.scene.scale());
      return true;
    };
    RTCPointQuery query{static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z), 0,
                        std::numeric_limits<float>::infinity()};
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(state_->scene.handle(), &query, &context, visit, &call);
  }
  const ClosestOnTriangle& best = search.best;
  return {best.point, search.triangle, std::sqrt(best.squared_distance),
          state_->normal(search.triangle, best.feature)};
}

double SurfaceTree::signed_distance(const Vec3d& p) const {
  const ClosestPoint nearest = closest(p);
  double distance = dot(p - nearest.point, nearest.normal) > 0 ? -nearest.distance : nearest.distance;
  // A point inside any of the bodies is inside their union. A body that p is outside of offers only smaller
  // values.
  for (const Body& body : state_->bodies) {
    if (boxes_touch(body.box, {p, p})) distance = std::max(distance, body.tree.signed_distance(p));
  }
  return distance;
}

}  // namespace astrolith
