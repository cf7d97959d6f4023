#include "geometry/weld.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>

#include "geometry/index_table_internal.h"

namespace astrolith {
namespace {

std::uint64_t hash_cell_of(const Vec3d& cell) {
  std::uint64_t h = mix_bits_64(std::bit_cast<std::uint64_t>(cell.x));
  h = mix_bits_64(h ^ std::bit_cast<std::uint64_t>(cell.y));
  return mix_bits_64(h ^ std::bit_cast<std::uint64_t>(cell.z));
}

// The kept vertices, hashed by the grid cell that they lie in. Cells are a little wider than the radius: the
// 27 cells around a point then hold all vertices within the radius, whichever way its cell was rounded.
// Radius 0 makes every triple of coordinates its own cell.
class VertexGrid {
 public:
  VertexGrid(const TriangleMesh& mesh, double radius)
      : radius_(radius), origin_(mesh.bounds().min), table_(mesh.vertices.size()) {}

  // The first kept vertex within reach of p, or IndexTable::kNone.
  std::uint32_t find(const Vec3d& p, const std::vector<Vec3d>& kept) const {
    const Vec3d center = cell_of(p);
    const int reach = radius_ > 0.0 ? 1 : 0;
    std::uint32_t first = IndexTable::kNone;
    for (int dx = -reach; dx <= reach; ++dx) {
      for (int dy = -reach; dy <= reach; ++dy) {
        for (int dz = -reach; dz <= reach; ++dz) {
          const Vec3d cell = center + Vec3d{double(dx), double(dy), double(dz)};
          table_.visit(hash_cell_of(cell), [&](std::uint32_t i) {
            if (squared_norm(kept[i] - p) <= radius_ * radius_) first = std::min(first, i);
          });
        }
      }
    }
    return first;
  }
  void insert(const Vec3d& p, std::uint32_t index) { table_.insert(hash_cell_of(cell_of(p)), index); }

 private:
  // Cell coordinates are whole numbers in doubles, which no small tolerance can overflow. Adding zero turns
  // -0 into 0.
  Vec3d cell_of(const Vec3d& p) const {
    if (radius_ == 0.0) return p + Vec3d{0.0, 0.0, 0.0};
    const Vec3d q = (p - origin_) * (0.999 / radius_);
    return {std::floor(q.x), std::floor(q.y), std::floor(q.z)};
  }

  double radius_;
  Vec3d origin_;
  IndexTable table_;
};

Triangle sorted(Triangle t) {
  std::sort(t.begin(), t.end());
  return t;
}

std::uint64_t hash_of(const Triangle& t) {
  return mix_bits_64(mix_bits_64((std::uint64_t{t[0]} << 32) | t[1]) ^ t[2]);
}

}  // namespace

TriangleMesh weld_vertices(TriangleMesh mesh, double tolerance) {
  if (!(tolerance >= 0.0 && tolerance < 0.1)) throw std::invalid_argument("weld tolerance outside [0, 0.1)");
  VertexGrid grid(mesh, tolerance > 0.0 ? tolerance * mesh.bounds().diagonal() : 0.0);
  std::vector<std::uint32_t> kept_from_old(mesh.vertices.size());
  std::vector<Vec3d> kept, kept_normals;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Vec3d& p = mesh.vertices[i];
    std::uint32_t target = grid.find(p, kept);
    if (target == IndexTable::kNone) {
      target = static_cast<std::uint32_t>(kept.size());
      grid.insert(p, target);
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
  IndexTable table(mesh.triangles.size());
  std::vector<Triangle> kept;
  for (const Triangle& t : mesh.triangles) {
    const Triangle key = sorted(t);
    if (key[0] == key[1] || key[1] == key[2]) continue;
    bool repeated = false;
    table.visit(hash_of(key), [&](std::uint32_t i) { repeated = repeated || sorted(kept[i]) == key; });
    if (repeated) continue;
    table.insert(hash_of(key), static_cast<std::uint32_t>(kept.size()));
    kept.push_back(t);
  }
  mesh.triangles = std::move(kept);
  return mesh;
}

}  // namespace astrolith
