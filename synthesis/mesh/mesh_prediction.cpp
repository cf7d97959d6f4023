#include "synthesis/mesh/mesh_prediction.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "numerics/errors.h"
#include "numerics/portable_double.h"

namespace astrolith {
namespace {

constexpr int kCoarseCells = 48;
constexpr int kFineCells = 96;
// Cells along the longest side without the border, as a whole mesh has them.
double body_cells(int resolution) { return resolution - 2; }

MeshPrediction measured(const MeshStatistics& s, int resolution) {
  return {resolution, double(s.triangles), double(s.evaluations), double(s.working_bytes)};
}

// Extrapolates from the counts a and b at resolutions of ratio `step` to the count at `ratio` times the
// resolution of b. The count is a power of the resolution, and its exponent stays between 1 (a curve) and 3
// (a volume).
double continued(double a, double b, double step, double ratio) {
  if (a <= 0.0 || b <= 0.0) return b * ratio * ratio;
  const double exponent = std::clamp(portable::log(b / a) / portable::log(step), 1.0, 3.0);
  return b * portable::pow(ratio, exponent);
}

}  // namespace

MeshGrowth::MeshGrowth(const std::function<MeshStatistics(int resolution)>& mesh)
    : coarse_(measured(mesh(kCoarseCells), kCoarseCells)) {
  const auto start = std::chrono::steady_clock::now();
  fine_ = measured(mesh(kFineCells), kFineCells);
  fine_seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

MeshPrediction MeshGrowth::at(int resolution) const {
  const double step = body_cells(kFineCells) / body_cells(kCoarseCells);
  const double ratio = body_cells(resolution) / body_cells(kFineCells);
  return {resolution, continued(coarse_.triangles, fine_.triangles, step, ratio),
          continued(coarse_.evaluations, fine_.evaluations, step, ratio),
          fine_.working_bytes * std::max(ratio, 1.0)};
}

int MeshGrowth::resolution_for(double triangles) const {
  if (fine_.triangles <= 0.0)
    throw WorkError("mesher: the surface is too small to tell its size; give a resolution");
  int low = kMinResolution, high = kMaxResolution;
  while (low < high) {
    const int middle = (low + high) / 2;
    (at(middle).triangles < triangles ? low = middle + 1 : high = middle);
  }
  const bool lower_is_nearer =
      low > kMinResolution && triangles - at(low - 1).triangles < at(low).triangles - triangles;
  return lower_is_nearer ? low - 1 : low;
}

}  // namespace astrolith
