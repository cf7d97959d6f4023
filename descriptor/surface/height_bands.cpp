#include "descriptor/surface/height_bands.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "descriptor/surface/smoothing_step.h"
#include "numerics/errors.h"
#include "numerics/sample_statistics.h"

namespace astrolith {
namespace {

// Steps that make each of kBandScales.
constexpr std::array<int, kBandScales.size()> kScaleSteps{1, 4, 16, 64, 256};
// What the scales need of the smoothed surface: S_s of each, and the normals smoothed by G_s.
struct Smoothings {
  std::array<std::vector<Vec3d>, kBandScales.size()> surfaces, normals;
};

void add_scaled(double factor, const std::vector<Vec3d>& from, std::vector<Vec3d>& to) {
  to.resize(from.size());
  for (std::size_t i = 0; i < from.size(); ++i) to[i] += factor * from[i];
}

Smoothings smoothings(const EvenedSurface& even, const SmoothingStep& step, std::size_t scales,
                      const Progress& progress) {
  constexpr std::array<double, 3> kFactors{3.0, -3.0, 1.0};
  Smoothings result;
  // The first step leads from the mesh to the points.
  std::vector<Vec3d> surface = even.means, normals = even.normals;
  const int last = 3 * kScaleSteps[scales - 1];
  for (int done = 1; done <= last; ++done) {
    if (done > 1) surface = step(surface);
    if (done > 1 && 3 * done <= last) normals = step(normals);
    for (std::size_t s = 0; s < scales; ++s) {
      if (done == kScaleSteps[s]) result.normals[s] = normals;
      for (int power = 1; power <= 3; ++power) {
        if (done == power * kScaleSteps[s]) {
          add_scaled(kFactors[static_cast<std::size_t>(power - 1)], surface, result.surfaces[s]);
        }
      }
    }
    if (!report(progress, 0.0, "bands of heights")) throw WorkError("bands of heights: stopped");
  }
  return result;
}

double mean_product(const std::vector<double>& a, const std::vector<double>& b) {
  return dot_product(a, b) / static_cast<double>(a.size());
}

void subtract_mean(std::vector<double>& values) {
  const double mean = sample_mean(values);
  for (double& v : values) v -= mean;
}

// The heights of the band from one scale to the next, in edges.
std::vector<double> band_heights(const Smoothings& smooth, std::size_t band, double edge) {
  std::vector<double> heights;
  heights.reserve(smooth.surfaces[band].size());
  for (std::size_t i = 0; i < smooth.surfaces[band].size(); ++i) {
    const Vec3d normal = normalized(smooth.normals[band + 1][i]);
    heights.push_back(dot(normal, smooth.surfaces[band][i] - smooth.surfaces[band + 1][i]) / edge);
  }
  subtract_mean(heights);
  return heights;
}

std::optional<double> band_coupling(const std::vector<double>& a, const std::vector<double>& b,
                                    const SmoothingStep& step) {
  std::vector<double> envelope, size;
  for (const double v : a) envelope.push_back(v * v);
  for (int k = 0; k < kScaleSteps[3]; ++k) envelope = step(envelope);
  for (double& v : envelope) v = std::sqrt(v);
  for (const double v : b) size.push_back(std::fabs(v));
  subtract_mean(envelope);
  subtract_mean(size);
  const double both = mean_product(envelope, envelope) * mean_product(size, size);
  if (!(both > 0.0)) return std::nullopt;
  return mean_product(envelope, size) / std::sqrt(both);
}

}  // namespace

HeightBands height_bands(const EvenedSurface& even, const Progress& progress) {
  const double body_radius = std::sqrt(even.area / (4.0 * std::numbers::pi)) / even.edge;
  std::size_t scales = 1;
  while (scales < kBandScales.size() && kBandScales[scales] <= kMostBodyShare * body_radius) ++scales;
  HeightBands result;
  if (scales < 2) return result;
  const SmoothingStep step(even);
  const Smoothings smooth = smoothings(even, step, scales, progress);
  std::vector<std::vector<double>> heights;
  for (std::size_t band = 0; band + 1 < scales; ++band) {
    heights.push_back(band_heights(smooth, band, even.edge));
    result.bands.push_back(
        {kBandScales[band], kBandScales[band + 1], std::sqrt(mean_product(heights.back(), heights.back()))});
  }
  if (heights.size() == kBandScales.size() - 1) result.coupling = band_coupling(heights[2], heights[3], step);
  return result;
}

}  // namespace astrolith
