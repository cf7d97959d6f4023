#include "descriptor/features/scale_space.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/points/point_tree_internal.h"
#include "numerics/errors.h"
#include "numerics/sample_statistics.h"

namespace astrolith {
namespace {

constexpr double kLargestScale = 0.3;  // radii of the sphere of equal area
constexpr double kFaintest = 0.002, kApart = 1.5, kNeighbourShare = 0.9;

// The numbers of steps whose deviations lie a factor of 1.25 apart, with one more than the last scale.
std::vector<int> scale_steps(double body_radius) {
  std::vector<int> steps{1};
  while (std::sqrt(steps.back()) * kStepDeviation <= kLargestScale * body_radius || steps.size() < 4) {
    steps.push_back(static_cast<int>(std::ceil(1.5625 * steps.back())));
  }
  return steps;
}

struct Scale {
  double s = 0.0;                // the mesh's unit
  std::vector<double> response;  // (n) D less its mean, positive where the sign asks for it
  std::vector<Vec3d> normals;    // (n)
};

Scale scale_between(const std::vector<Vec3d>& fine, const std::vector<Vec3d>& coarse,
                    const std::vector<Vec3d>& normals, double s, BlobSign sign) {
  Scale scale{s, {}, {}};
  for (std::size_t i = 0; i < fine.size(); ++i) {
    scale.normals.push_back(normalized(normals[i]));
    const double d = dot(scale.normals[i], fine[i] - coarse[i]) / s;
    scale.response.push_back(sign == BlobSign::hollow ? -d : d);
  }
  const double mean = sample_mean(scale.response);
  for (double& r : scale.response) r -= mean;
  return scale;
}

std::vector<Scale> find_scales(const EvenedSurface& even, const SmoothingStep& step, BlobSign sign,
                               const Progress& progress) {
  const double body_radius = std::sqrt(even.area / (4.0 * std::numbers::pi)) / even.edge;
  const std::vector<int> steps = scale_steps(body_radius);
  std::vector<Scale> scales;
  std::vector<Vec3d> surface = even.means, normals = even.normals, finer = surface;
  int done = 1;
  for (std::size_t k = 1; k < steps.size(); ++k) {
    for (; done < steps[k]; ++done) surface = step(surface), normals = step(normals);
    scales.push_back(
        scale_between(finer, surface, normals, std::sqrt(steps[k - 1]) * kStepDeviation * even.edge, sign));
    finer = surface;
    if (!report(progress, static_cast<double>(done) / steps.back(), "scale space"))
      throw WorkError("scale space: stopped");
  }
  return scales;
}

// Whether no point within the reach that looks the same way has a greater response, or an equal one before
// it.
bool is_greatest(const EvenedSurface& even, const PointTree& tree, const Scale& scale, std::size_t i) {
  const double own = scale.response[i];
  for (const auto& [j, squared] : tree.within(even.points[i], kApart * scale.s)) {
    const double other = scale.response[j];
    if ((other > own || (other == own && j < i)) && dot(even.normals[i], even.normals[j]) > 0.0) return false;
  }
  return true;
}

}  // namespace

std::vector<SurfaceBlob> surface_blobs(const EvenedSurface& even, const SmoothingStep& step, BlobSign sign,
                                       const Progress& progress) {
  const std::vector<Scale> scales = find_scales(even, step, sign, progress);
  const PointTree tree(even.points);
  std::vector<SurfaceBlob> blobs;
  for (std::size_t k = 0; k < scales.size(); ++k) {
    const Scale& scale = scales[k];
    std::vector<std::uint8_t> blob(even.points.size(), 0);
    parallel_for(0, static_cast<std::int64_t>(even.points.size()), [&](std::int64_t index) {
      const auto i = static_cast<std::size_t>(index);
      const double own = scale.response[i];
      if (own < kFaintest) return;
      for (const SmoothingShare& near : step.around(i))
        if (scale.response[near.point] > own) return;
      if (k > 0 && own < kNeighbourShare * scales[k - 1].response[i]) return;
      if (k + 1 < scales.size() && own < kNeighbourShare * scales[k + 1].response[i]) return;
      blob[i] = is_greatest(even, tree, scale, i) ? 1 : 0;
    });
    for (std::size_t i = 0; i < blob.size(); ++i) {
      if (blob[i] != 0) blobs.push_back({static_cast<std::uint32_t>(i), scale.normals[i], scale.s});
    }
  }
  return blobs;
}

}  // namespace astrolith
