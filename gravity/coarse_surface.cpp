#include "gravity/coarse_surface.h"

#include <algorithm>
#include <unordered_map>

namespace astrolith {
namespace {

// The cells that hold vertices, numbered as they are met.
class CellNumbers {
 public:
  CellNumbers(const Box& bounds, int cells) : low_(bounds.min) {
    const Vec3d e = bounds.extent();
    const double longest = std::max({e.x, e.y, e.z});
    per_unit_ = longest > 0.0 ? cells / longest : 0.0;
  }

  std::uint32_t of(const Vec3d& p) {
    const Vec3d at = per_unit_ * (p - low_);
    const auto x = static_cast<std::uint64_t>(at.x), y = static_cast<std::uint64_t>(at.y),
               z = static_cast<std::uint64_t>(at.z);
    const auto next = static_cast<std::uint32_t>(numbers_.size());
    return numbers_.try_emplace(x << 42 | y << 21 | z, next).first->second;
  }

 private:
  Vec3d low_;
  double per_unit_;
  std::unordered_map<std::uint64_t, std::uint32_t> numbers_;
};

}  // namespace

CoarseSurface coarse_surface(const TriangleMesh& mesh, int cells) {
  CoarseSurface coarse;
  CellNumbers numbers(mesh.bounds(), cells);
  std::vector<Vec3d>& means = coarse.mesh.vertices;
  std::vector<double> counts;
  coarse.cell.reserve(mesh.vertices.size());
  for (const Vec3d& p : mesh.vertices) {
    const std::uint32_t cell = numbers.of(p);
    if (cell == means.size()) {
      means.push_back({});
      counts.push_back(0.0);
    }
    means[cell] += p;
    counts[cell] += 1.0;
    coarse.cell.push_back(cell);
  }
  for (std::size_t i = 0; i < means.size(); ++i) means[i] = means[i] * (1.0 / counts[i]);
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::uint32_t i = coarse.cell[a], j = coarse.cell[b], k = coarse.cell[c];
    if (i != j && j != k && k != i) coarse.mesh.triangles.push_back({i, j, k});
  }
  return coarse;
}

}  // namespace astrolith
