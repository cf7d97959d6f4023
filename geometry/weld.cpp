#include "geometry/weld.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <tuple>

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
      : radius_(radius), origin_(mesh.bounds().min), cell_of_vertex_(mesh.vertices.size()) {
    // Most comparisons end at x, which therefore stands beside the index.
    struct Entry {
      double x;
      std::uint32_t vertex;
    };
    std::vector<Entry> entries;
    entries.reserve(mesh.vertices.size());
    for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i)
      entries.push_back({place_of(mesh.vertices[i]).x, i});
    std::sort(entries.begin(), entries.end(), [&](const Entry& a, const Entry& b) {
      if (a.x != b.x) return a.x < b.x;
      const Vec3d p = place_of(mesh.vertices[a.vertex]), q = place_of(mesh.vertices[b.vertex]);
      return std::tie(p.y, p.z, a.vertex) < std::tie(q.y, q.z, b.vertex);
    });
    for (const Entry& entry : entries) {
      const Vec3d place = place_of(mesh.vertices[entry.vertex]);
      if (places_.empty() || before(places_.back(), place)) places_.push_back(place);
      cell_of_vertex_[entry.vertex] = static_cast<std::uint32_t>(places_.size() - 1);
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
    const std::uint32_t own = cell_of_vertex_[vertex];
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
    std::uint32_t& newest = newest_[cell_of_vertex_[vertex]];
    const auto index = static_cast<std::uint32_t>(older_.size());
    older_.push_back(newest);
    newest = index;
  }

 private:
  static bool before(const Vec3d& a, const Vec3d& b) {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
  }
  // Coordinates of the cell: whole numbers in doubles, which no small tolerance can overflow.
  Vec3d place_of(const Vec3d& p) const {
    if (radius_ == 0.0) return p;
    const Vec3d q = (p - origin_) * (0.999 / radius_);
    return {std::floor(q.x), std::floor(q.y), std::floor(q.z)};
  }

  double radius_;
  Vec3d origin_;
  std::vector<Vec3d> places_;                  // (#cells) sorted
  std::vector<std::uint32_t> cell_of_vertex_;  // (#V)
  std::vector<std::uint32_t> newest_, older_;  // (#cells), (#kept): chains of kept vertices
};

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

}  // namespace astrolith
