#include "synthesis/relief/relief_seam.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "numerics/portable_angles.h"

namespace astrolith {
namespace {

constexpr std::size_t kSeamRings = 24, kFirstCut = 7, kLastCut = 22, kCuts = kLastCut - kFirstCut + 1;
constexpr std::size_t kAll = ReliefSeam::kAngles;
constexpr double kAngle = 2.0 * std::numbers::pi / static_cast<double>(kAll);

std::size_t next(std::size_t angle) { return angle + 1 == kAll ? 0 : angle + 1; }
std::size_t before(std::size_t angle) { return angle == 0 ? kAll - 1 : angle - 1; }

// The angle of a point in cells, 0 <= angle <= kAll.
double angle_of(double x, double y) {
  const double angle = portable::atan2(y, x) / kAngle;
  return angle < 0.0 ? angle + static_cast<double>(kAll) : angle;
}

// The mismatch in cells of angle and ring. A cell without older heights is new on both sides of a seam.
struct SeamCell {
  double all = 0.0, laid = 0.0, mismatch = 0.0;

  void add(double by, const SeamCell& c) {
    all += by * c.all, laid += by * c.laid, mismatch += by * c.mismatch;
  }
  bool is_laid() const { return laid > 0.5 * all; }
  double mean() const { return laid > 0.0 ? mismatch / laid : 0.0; }
};
using Column = std::array<SeamCell, kSeamRings>;

std::vector<Column> cells_of(const std::vector<SeamPoint>& points) {
  std::vector<Column> sums(kAll), cells(kAll);
  for (const SeamPoint& p : points) {
    const auto ring = static_cast<std::size_t>(std::sqrt(p.x * p.x + p.y * p.y) * kSeamRings);
    const auto angle = std::min(static_cast<std::size_t>(angle_of(p.x, p.y)), kAll - 1);
    if (ring < kSeamRings) sums[angle][ring].add(1.0, {1.0, p.laid ? 1.0 : 0.0, p.laid ? p.mismatch : 0.0});
  }
  for (std::size_t a = 0; a < kAll; ++a) {
    for (std::size_t r = 0; r < kSeamRings; ++r) {
      cells[a][r].add(2.0, sums[a][r]);
      cells[a][r].add(1.0, sums[next(a)][r]);
      cells[a][r].add(1.0, sums[before(a)][r]);
    }
  }
  return cells;
}

bool is_new(const Column& column, std::size_t cut, std::size_t ring) {
  return ring < cut || !column[ring].is_laid();
}

// The mismatch along the borders between rings for a cut.
double along_rings(const Column& column, std::size_t cut) {
  double sum = 0.0;
  for (std::size_t r = kFirstCut - 1; r + 1 < kSeamRings; ++r) {
    if (is_new(column, cut, r) != is_new(column, cut, r + 1))
      sum += static_cast<double>(r + 1) * kAngle * (column[r].mean() + column[r + 1].mean());
  }
  return sum;
}

// The mismatch along the border between columns with two cuts.
double between_columns(const Column& a, std::size_t cut_a, const Column& b, std::size_t cut_b) {
  double sum = 0.0;
  for (std::size_t r = kFirstCut; r < kSeamRings; ++r) {
    if (is_new(a, cut_a, r) != is_new(b, cut_b, r)) sum += a[r].mean() + b[r].mean();
  }
  return sum;
}

using Costs = std::array<double, kCuts>;

// The costs of each column and of each pair of cuts in neighbouring columns.
struct SeamCosts {
  std::array<Costs, kAll> own;
  std::array<std::array<Costs, kCuts>, kAll> to_next;  // [angle][cut][cut of the next angle]

  explicit SeamCosts(const std::vector<Column>& cells) {
    for (std::size_t a = 0; a < kAll; ++a) {
      for (std::size_t i = 0; i < kCuts; ++i) {
        own[a][i] = along_rings(cells[a], kFirstCut + i);
        for (std::size_t k = 0; k < kCuts; ++k)
          to_next[a][i][k] = between_columns(cells[a], kFirstCut + i, cells[next(a)], kFirstCut + k);
      }
    }
  }
};

struct ClosedSeam {
  double cost = std::numeric_limits<double>::infinity();
  std::array<std::size_t, kAll> cuts{};
};

// The best seam whose first cut is given, by dynamic programming. Wider seams win ties.
ClosedSeam best_from(const SeamCosts& costs, std::size_t first) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  std::array<std::array<std::size_t, kCuts>, kAll> from{};
  Costs least;
  least.fill(kNever);
  least[first] = costs.own[0][first];
  for (std::size_t a = 1; a < kAll; ++a) {
    Costs best;
    best.fill(kNever);
    for (std::size_t i = kCuts; i-- > 0;) {
      if (least[i] == kNever) continue;
      for (std::size_t k = 0; k < kCuts; ++k) {
        const double cost = least[i] + costs.to_next[a - 1][i][k] + costs.own[a][k];
        if (cost < best[k]) best[k] = cost, from[a][k] = i;
      }
    }
    least = best;
  }
  ClosedSeam seam;
  for (std::size_t i = kCuts; i-- > 0;) {
    const double cost = least[i] + costs.to_next[kAll - 1][i][first];
    if (cost < seam.cost) seam.cost = cost, seam.cuts[kAll - 1] = i;
  }
  for (std::size_t a = kAll - 1; a > 0; --a) seam.cuts[a - 1] = from[a][seam.cuts[a]];
  return seam;
}

}  // namespace

ReliefSeam::ReliefSeam(const std::vector<SeamPoint>& points) {
  const SeamCosts costs(cells_of(points));
  ClosedSeam best;
  for (std::size_t first = kCuts; first-- > 0;) {
    const ClosedSeam seam = best_from(costs, first);
    if (seam.cost < best.cost) best = seam;
  }
  for (std::size_t a = 0; a < kAngles; ++a)
    radii_[a] = static_cast<double>(kFirstCut + best.cuts[a]) / static_cast<double>(kSeamRings);
}

ReliefSeam ReliefSeam::smoothed(double width) const {
  constexpr double kMiddle = 0.6;  // radii: where most seams lie
  const double cells = width / kMiddle / kAngle;
  ReliefSeam smooth = *this;
  // A pass with the weights 1/4, 1/2, 1/4 adds half a squared cell to the variance.
  for (int pass = 0; pass < static_cast<int>(2.0 * cells * cells + 0.5); ++pass) {
    const std::array<double, kAngles> r = smooth.radii_;
    for (std::size_t a = 0; a < kAngles; ++a)
      smooth.radii_[a] = 0.5 * r[a] + 0.25 * (r[next(a)] + r[before(a)]);
  }
  return smooth;
}

double ReliefSeam::margin(double x, double y) const {
  const double at = angle_of(x, y) - 0.5, cell = std::floor(at), t = at - cell;
  const std::size_t a = cell < 0.0 ? kAngles - 1 : std::min(static_cast<std::size_t>(cell), kAngles - 1);
  return (1.0 - t) * radii_[a] + t * radii_[next(a)] - std::sqrt(x * x + y * y);
}

}  // namespace astrolith
