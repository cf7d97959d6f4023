#include "geometry/wound_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "geometry/mesh_edges.h"
#include "geometry/mesh_measure.h"
#include "geometry/mesh_topology.h"

namespace astrolith {
namespace {

constexpr std::uint32_t kNone = 0xffffffff;

// Vertices in the grid cells that they lie in. Cells are found by sorting, which no choice of coordinates
// makes slow. They are a little wider than the radius: the 27 cells around a point then hold all vertices
// within the radius, whichever way its cell was rounded. Radius 0 makes every triple of coordinates its own
// cell.
class VertexCells {
 public:
  VertexCells(const TriangleMesh& mesh, double radius)
      : radius_(radius), origin_(mesh.bounds().min), vertex_cell_(mesh.vertices.size()) {
    // Most comparisons end at x, which therefore stands beside the index.
    struct Entry {
      double x;
      std::uint32_t vertex;
    };
    std::vector<Entry> entries;
    entries.reserve(mesh.vertices.size());
    for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i)
      entries.push_back({cell_coordinates(mesh.vertices[i]).x, i});
    std::sort(entries.begin(), entries.end(), [&](const Entry& a, const Entry& b) {
      if (a.x != b.x) return a.x < b.x;
      const Vec3d p = cell_coordinates(mesh.vertices[a.vertex]),
                  q = cell_coordinates(mesh.vertices[b.vertex]);
      return std::tie(p.y, p.z, a.vertex) < std::tie(q.y, q.z, b.vertex);
    });
    for (const Entry& entry : entries) {
      const Vec3d place = cell_coordinates(mesh.vertices[entry.vertex]);
      if (places_.empty() || before(places_.back(), place)) places_.push_back(place);
      vertex_cell_[entry.vertex] = static_cast<std::uint32_t>(places_.size() - 1);
    }
    newest_.assign(places_.size(), kNone);
  }

  // The first kept vertex within reach of this one, or kNone.
  std::uint32_t find(std::uint32_t vertex, const Vec3d& p, const std::vector<Vec3d>& kept) const {
    std::uint32_t first = kNone;
    const auto look_into = [&](std::uint32_t cell) {
      for (std::uint32_t i = newest_[cell]; i != kNone; i = older_[i]) {
        if (squared_norm(kept[i] - p) <= radius_ * radius_) first = std::min(first, i);
      }
    };
    const std::uint32_t own = vertex_cell_[vertex];
    if (radius_ == 0.0) return newest_[own];
    for (double dx = -1.0; dx <= 1.0; ++dx) {
      for (double dy = -1.0; dy <= 1.0; ++dy) {
        const Vec3d low = places_[own] + Vec3d{dx, dy, -1.0}, high = places_[own] + Vec3d{dx, dy, 1.0};
        auto cell = std::lower_bound(places_.begin(), places_.end(), low, before);
        for (; cell != places_.end() && !before(high, *cell); ++cell)
          look_into(static_cast<std::uint32_t>(cell - places_.begin()));
      }
    }
    return first;
  }

  // Keeps a vertex. The k-th call keeps the one with index k among the kept, counted from 0.
  void keep(std::uint32_t vertex) {
    std::uint32_t& newest = newest_[vertex_cell_[vertex]];
    const auto index = static_cast<std::uint32_t>(older_.size());
    older_.push_back(newest);
    newest = index;
  }

 private:
  static bool before(const Vec3d& a, const Vec3d& b) {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
  }
  // Coordinates of the cell: whole numbers in doubles, which no small tolerance can overflow.
  Vec3d cell_coordinates(const Vec3d& p) const {
    if (radius_ == 0.0) return p;
    const Vec3d q = (p - origin_) * (0.999 / radius_);
    return {std::floor(q.x), std::floor(q.y), std::floor(q.z)};
  }

  double radius_;
  Vec3d origin_;
  std::vector<Vec3d> places_;                  // (#cells) sorted
  std::vector<std::uint32_t> vertex_cell_;     // (#V)
  std::vector<std::uint32_t> newest_, older_;  // (#cells), (#kept): chains of kept vertices
};

// The face across one side of a face, or kNone, and whether the two faces are wound alike.
struct Neighbour {
  static constexpr std::uint32_t kNone = 0xffffffff;
  std::uint32_t face = kNone;
  bool alike = true;
};

struct Components {
  std::vector<std::uint32_t> number;  // (#F) from 0, in the order of their first faces
  std::vector<double> border;         // length of the edges with an odd number of faces
};

void turn(Triangle& t) { std::swap(t[1], t[2]); }

// Winds the faces that can be reached from `seed` alike, and numbers their component.
void wind_alike(TriangleMesh& mesh, const std::vector<std::array<Neighbour, 3>>& adjacent, std::uint32_t seed,
                std::uint32_t component, std::vector<std::uint32_t>& number) {
  std::vector<std::uint32_t> faces{seed};
  std::vector<bool> turned{false};
  number[seed] = component;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    for (const Neighbour& n : adjacent[faces[i]]) {
      if (n.face == Neighbour::kNone || number[n.face] != Neighbour::kNone) continue;
      number[n.face] = component;
      faces.push_back(n.face);
      turned.push_back(turned[i] == n.alike);
    }
  }
  const auto many = static_cast<std::size_t>(std::count(turned.begin(), turned.end(), true));
  const bool as_the_others = 2 * many > faces.size();
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (turned[i] != as_the_others) turn(mesh.triangles[faces[i]]);
  }
}

Components wind_components(TriangleMesh& mesh) {
  std::vector<std::array<Neighbour, 3>> adjacent(mesh.triangles.size());
  const std::vector<TriangleSide> sides = sorted_sides(mesh);
  for_each_edge(sides, [&](std::span<const TriangleSide> edge) {
    if (edge.size() != 2) return;
    const bool alike = edge[0].forward != edge[1].forward;
    adjacent[edge[0].triangle][edge[0].corner] = {edge[1].triangle, alike};
    adjacent[edge[1].triangle][edge[1].corner] = {edge[0].triangle, alike};
  });
  Components components{std::vector<std::uint32_t>(mesh.triangles.size(), Neighbour::kNone), {}};
  std::uint32_t count = 0;
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    if (components.number[f] == Neighbour::kNone) {
      wind_alike(mesh, adjacent, f, count++, components.number);
    }
  }
  components.border.assign(count, 0.0);
  for_each_edge(sides, [&](std::span<const TriangleSide> edge) {
    if (edge.size() % 2 == 0) return;
    const double length = norm(mesh.vertices[edge[0].low] - mesh.vertices[edge[0].high]);
    for (const TriangleSide& side : edge) components.border[components.number[side.triangle]] += length;
  });
  return components;
}

// (#parts) the outermost part around each, or the part itself. Where finding out would take too long, a part
// in the box of the largest belongs to that.
std::vector<std::size_t> outermost(const std::vector<SurfacePart>& parts) {
  std::vector<std::size_t> by_volume(parts.size());
  std::iota(by_volume.begin(), by_volume.end(), std::size_t{0});
  std::stable_sort(by_volume.begin(), by_volume.end(), [&](std::size_t a, std::size_t b) {
    return std::abs(parts[a].volume) > std::abs(parts[b].volume);
  });
  std::vector<std::size_t> around(parts.size());
  PartNesting nesting;
  const std::size_t largest = by_volume.front();
  for (std::size_t i = 0; i < by_volume.size(); ++i) {
    const std::size_t inner = by_volume[i];
    around[inner] = inner;
    for (std::size_t j = 0; j < i && around[inner] == inner && !nesting.spent(); ++j) {
      if (nesting.lies_inside(parts[inner], parts[by_volume[j]])) around[inner] = around[by_volume[j]];
    }
    if (nesting.spent() && box_holds(parts[largest].box, parts[inner].box)) around[inner] = largest;
  }
  return around;
}

bool wound_alike(const Triangle& a, const Triangle& b) {
  return (a[0] == b[0] && a[1] == b[1]) || (a[1] == b[0] && a[2] == b[1]) || (a[2] == b[0] && a[0] == b[1]);
}

}  // namespace

TriangleMesh weld_vertices(TriangleMesh mesh, double tolerance) {
  if (!(tolerance >= 0.0 && tolerance < 0.1)) throw std::invalid_argument("weld tolerance outside [0, 0.1)");
  VertexCells cells(mesh, tolerance > 0.0 ? tolerance * mesh.bounds().diagonal() : 0.0);
  std::vector<std::uint32_t> kept_from_old(mesh.vertices.size());
  std::vector<Vec3d> kept, kept_normals;
  for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i) {
    const Vec3d& p = mesh.vertices[i];
    std::uint32_t target = cells.find(i, p, kept);
    if (target == kNone) {
      target = static_cast<std::uint32_t>(kept.size());
      cells.keep(i);
      kept.push_back(p);
      if (!mesh.normals.empty()) kept_normals.push_back(mesh.normals[i]);
    }
    kept_from_old[i] = target;
  }
  for (Triangle& t : mesh.triangles) {
    for (std::uint32_t& index : t) index = kept_from_old[index];
  }
  mesh.vertices = std::move(kept);
  mesh.normals = std::move(kept_normals);
  return mesh;
}

TriangleMesh drop_degenerate_and_repeated_faces(TriangleMesh mesh) {
  std::vector<std::array<std::uint32_t, 4>> keys;  // sorted corners, and the face
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    Triangle t = mesh.triangles[f];
    std::sort(t.begin(), t.end());
    if (t[0] != t[1] && t[1] != t[2]) keys.push_back({t[0], t[1], t[2], f});
  }
  std::sort(keys.begin(), keys.end());
  std::vector<bool> stays(mesh.triangles.size(), false);
  for (std::size_t k = 0; k < keys.size(); ++k)
    stays[keys[k][3]] = k == 0 || !std::equal(keys[k].begin(), keys[k].begin() + 3, keys[k - 1].begin());
  std::size_t kept = 0;
  for (std::size_t f = 0; f < stays.size(); ++f) {
    if (stays[f]) mesh.triangles[kept++] = mesh.triangles[f];
  }
  mesh.triangles.resize(kept);
  return mesh;
}

TriangleMesh without_unused_vertices(const TriangleMesh& mesh) {
  std::vector<std::uint32_t> number(mesh.vertices.size(), 0);
  for (const Triangle& t : mesh.triangles) number[t[0]] = number[t[1]] = number[t[2]] = 1;
  TriangleMesh compact;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] == 0) continue;
    number[v] = static_cast<std::uint32_t>(compact.vertices.size());
    compact.vertices.push_back(mesh.vertices[v]);
  }
  compact.triangles = mesh.triangles;
  for (Triangle& t : compact.triangles) t = {number[t[0]], number[t[1]], number[t[2]]};
  return compact;
}

TriangleMesh orient_faces(TriangleMesh mesh) {
  if (mesh.triangles.empty()) return mesh;
  const Components components = wind_components(mesh);
  const std::vector<SurfacePart> parts = split_parts(mesh, components.number);
  std::vector<char> inside_out(parts.size());
  bool any = false;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const double border = components.border[p];
    const bool has_inside = border == 0.0 || border * border < 0.5 * surface_area(parts[p].mesh);
    inside_out[p] = has_inside && parts[p].volume < 0.0 ? 1 : 0;
    any = any || inside_out[p] != 0;
  }
  if (!any) return mesh;
  const std::vector<std::size_t> around = outermost(parts);
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    if (inside_out[around[components.number[f]]] != 0) turn(mesh.triangles[f]);
  }
  return mesh;
}

std::string WoundSurface::words() const {
  std::string text;
  if (merged_vertices > 0) text = "merged " + std::to_string(merged_vertices) + " vertices at equal places";
  if (turned_faces == 0) return text;
  if (!text.empty()) text += ", ";
  return text + "turned " + std::to_string(turned_faces) + (turned_faces == 1 ? " facet" : " facets");
}

bool is_closed_body(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return false;
  const MeshTopology topology = analyze_topology(mesh);
  const bool sound = topology.closed && topology.non_manifold_edges == 0 && topology.oriented;
  if (!sound || !(volume(mesh) > 0.0)) return false;
  return topology.components == 1 || orient_faces(mesh).triangles == mesh.triangles;
}

std::int64_t count_turned(const TriangleMesh& before, const TriangleMesh& after) {
  std::int64_t turned = 0;
  for (std::size_t f = 0; f < before.triangles.size(); ++f) {
    turned += wound_alike(before.triangles[f], after.triangles[f]) ? 0 : 1;
  }
  return turned;
}

WoundSurface wound_surface(TriangleMesh mesh) {
  WoundSurface wound;
  if (mesh.triangles.empty() || is_closed_body(mesh)) {
    wound.mesh = std::move(mesh);
    return wound;
  }
  if (const std::int64_t open = analyze_topology(mesh).boundary_edges; open > 0) {
    TriangleMesh welded =
        without_unused_vertices(drop_degenerate_and_repeated_faces(weld_vertices(mesh, 0.0)));
    if (analyze_topology(welded).boundary_edges < open) {
      wound.merged_vertices = static_cast<std::int64_t>(mesh.vertices.size() - welded.vertices.size());
      mesh = std::move(welded);
      mesh.normals.clear();
      mesh.colors.clear();
    }
  }
  wound.mesh = orient_faces(mesh);
  wound.turned_faces = count_turned(mesh, wound.mesh);
  if (wound.turned_faces > 0) wound.mesh.normals.clear();
  return wound;
}

}  // namespace astrolith
