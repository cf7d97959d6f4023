#include "descriptor/surface/height_bands.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include "geometry/points/point_tree_internal.h"
#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "numerics/sample_statistics.h"
#include "numerics/tangent_frame.h"

namespace astrolith {
namespace {

// Steps that make each of kBandScales.
constexpr std::array<int, kBandScales.size()> kStepsOfScale{1, 4, 16, 64, 256};
constexpr std::int64_t kGrain = 512;
// Wide enough that points of the nominal mean square distance keep a third for themselves.
constexpr double kStepReach = 2.2;  // edges

struct Share {
  std::uint32_t point;
  double share;
};

// A neighbour of a point: its offset along two tangents, its squared distance and its weight.
struct Neighbour {
  std::uint32_t point;
  double x, y, squared, weight;
};

std::vector<Neighbour> neighbours_of(const EvenedSurface& even, const PointTree& tree, std::size_t i) {
  const double reach = kStepReach * even.edge;
  const Tangents<double> along = crossed_tangents(even.normals[i]);
  std::vector<Neighbour> neighbours;
  for (const auto& [j, squared] : tree.within(even.points[i], reach)) {
    if (j == i || dot(even.normals[i], even.normals[j]) <= 0.0) continue;
    const Vec3d offset = even.points[j] - even.points[i];
    neighbours.push_back({j, dot(offset, along.first), dot(offset, along.second), squared,
                          std::max(0.0, 1.0 - squared / (reach * reach))});
  }
  return neighbours;
}

// Makes the weighted mean of the offsets 0, by weights times 1 - lean . offset. Where that is impossible, as
// at a border, the mean comes near 0, since no weight becomes negative.
void center(std::vector<Neighbour>& neighbours) {
  double xx = 0.0, xy = 0.0, yy = 0.0, x = 0.0, y = 0.0;
  for (const Neighbour& n : neighbours) {
    xx += n.weight * n.x * n.x, xy += n.weight * n.x * n.y, yy += n.weight * n.y * n.y;
    x += n.weight * n.x, y += n.weight * n.y;
  }
  const double determinant = xx * yy - xy * xy;
  if (!(determinant > 1e-6 * xx * yy)) return;
  const double lean_x = (yy * x - xy * y) / determinant, lean_y = (xx * y - xy * x) / determinant;
  for (Neighbour& n : neighbours) n.weight *= std::max(0.0, 1.0 - lean_x * n.x - lean_y * n.y);
}

// Shares of the neighbours whose mean is the point itself, and whose mean square distance is the nominal one;
// the rest is the point's own. Uneven points then neither drift nor blur more at one place than at another.
std::vector<Share> shares_around(const EvenedSurface& even, const PointTree& tree, std::size_t i) {
  std::vector<Neighbour> neighbours = neighbours_of(even, tree, i);
  center(neighbours);
  double squares = 0.0, weights = 0.0;
  for (const Neighbour& n : neighbours) {
    squares += n.weight * n.squared;
    weights += n.weight;
  }
  // No share is negative, else the steps would grow without bound where points are crowded, as in a crease.
  const double factor =
      weights > 0.0 ? std::min(kMeanSquare * even.edge * even.edge / squares, 1.0 / weights) : 0.0;
  std::vector<Share> shares;
  double own = 1.0;
  for (const Neighbour& n : neighbours) {
    shares.push_back({n.point, factor * n.weight});
    own -= factor * n.weight;
  }
  shares.push_back({static_cast<std::uint32_t>(i), own});
  return shares;
}

// One smoothing step as a table: each point's neighbours and their shares of its mean.
class SmoothingStep {
 public:
  explicit SmoothingStep(const EvenedSurface& even) : starts_(even.points.size() + 1, 0) {
    const std::size_t n = even.points.size();
    const PointTree tree(even.points);
    std::vector<std::vector<Share>> shares(n);
    parallel_for(0, static_cast<std::int64_t>(n), [&](std::int64_t index) {
      const auto i = static_cast<std::size_t>(index);
      shares[i] = shares_around(even, tree, i);
    });
    for (std::size_t i = 0; i < n; ++i) {
      shares_.insert(shares_.end(), shares[i].begin(), shares[i].end());
      starts_[i + 1] = shares_.size();
    }
  }

  template <typename Value>
  std::vector<Value> operator()(const std::vector<Value>& values) const {
    std::vector<Value> means(values.size());
    parallel_for(
        0, static_cast<std::int64_t>(values.size()),
        [&](std::int64_t index) {
          const auto i = static_cast<std::size_t>(index);
          Value mean{};
          for (std::size_t k = starts_[i]; k < starts_[i + 1]; ++k) {
            mean += shares_[k].share * values[shares_[k].point];
          }
          means[i] = mean;
        },
        kGrain);
    return means;
  }

 private:
  std::vector<std::size_t> starts_;
  std::vector<Share> shares_;
};

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
  const int last = 3 * kStepsOfScale[scales - 1];
  for (int done = 1; done <= last; ++done) {
    if (done > 1) surface = step(surface);
    if (done > 1 && 3 * done <= last) normals = step(normals);
    for (std::size_t s = 0; s < scales; ++s) {
      if (done == kStepsOfScale[s]) result.normals[s] = normals;
      for (int power = 1; power <= 3; ++power) {
        if (done == power * kStepsOfScale[s]) {
          add_scaled(kFactors[static_cast<std::size_t>(power - 1)], surface, result.surfaces[s]);
        }
      }
    }
    if (!report(progress, 0.0, "bands of heights")) throw WorkError("bands of heights: stopped");
  }
  return result;
}

double mean_product(const std::vector<double>& a, const std::vector<double>& b) {
  return sum_of_products(a, b) / static_cast<double>(a.size());
}

void subtract_mean(std::vector<double>& values) {
  const double mean = mean_of(values);
  for (double& v : values) v -= mean;
}

// The heights of the band from one scale to the next, in edges.
std::vector<double> heights_of_band(const Smoothings& smooth, std::size_t band, double edge) {
  std::vector<double> heights;
  heights.reserve(smooth.surfaces[band].size());
  for (std::size_t i = 0; i < smooth.surfaces[band].size(); ++i) {
    const Vec3d normal = normalized(smooth.normals[band + 1][i]);
    heights.push_back(dot(normal, smooth.surfaces[band][i] - smooth.surfaces[band + 1][i]) / edge);
  }
  subtract_mean(heights);
  return heights;
}

std::optional<double> coupling_of(const std::vector<double>& a, const std::vector<double>& b,
                                  const SmoothingStep& step) {
  std::vector<double> envelope, size;
  for (const double v : a) envelope.push_back(v * v);
  for (int k = 0; k < kStepsOfScale[3]; ++k) envelope = step(envelope);
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
  while (scales < kBandScales.size() && kBandScales[scales] <= kMostOfBody * body_radius) ++scales;
  HeightBands result;
  if (scales < 2) return result;
  const SmoothingStep step(even);
  const Smoothings smooth = smoothings(even, step, scales, progress);
  std::vector<std::vector<double>> heights;
  for (std::size_t band = 0; band + 1 < scales; ++band) {
    heights.push_back(heights_of_band(smooth, band, even.edge));
    result.bands.push_back(
        {kBandScales[band], kBandScales[band + 1], std::sqrt(mean_product(heights.back(), heights.back()))});
  }
  if (heights.size() == kBandScales.size() - 1) result.coupling = coupling_of(heights[2], heights[3], step);
  return result;
}

}  // namespace astrolith
