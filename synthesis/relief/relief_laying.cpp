#include "synthesis/relief/relief_laying.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "numerics/hash_random.h"
#include "numerics/parallel_for.h"
#include "numerics/portable_angles.h"

namespace astrolith {
namespace {

constexpr std::size_t kSeamRings = 24, kFirstCut = 7, kLastCut = 22, kCuts = kLastCut - kFirstCut + 1;
constexpr std::size_t kAll = ReliefSeam::kAngles;
constexpr double kAngle = 2.0 * std::numbers::pi / static_cast<double>(kAll);

std::size_t next(std::size_t angle) { return angle + 1 == kAll ? 0 : angle + 1; }
std::size_t before(std::size_t angle) { return angle == 0 ? kAll - 1 : angle - 1; }

// The angle of a point in cells, 0 <= angle <= kAll.
double angle_step(double x, double y) {
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

std::vector<Column> make_seam_cells(const std::vector<SeamPoint>& points) {
  std::vector<Column> sums(kAll), cells(kAll);
  for (const SeamPoint& p : points) {
    const auto ring = static_cast<std::size_t>(std::sqrt(p.x * p.x + p.y * p.y) * kSeamRings);
    const auto angle = std::min(static_cast<std::size_t>(angle_step(p.x, p.y)), kAll - 1);
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

// In mean edges of the measured model: standard deviations of smoothing, and half widths of seams.
constexpr std::array<double, kReliefBands> kBandCuts = {0.8, 1.6, 3.2, 6.4, 12.8},
                                           kSeamWidths = {1.0, 1.4, 2.4, 4.8, 10.0};

// A point of a patch, and what the patch has there; nothing where the donor's surface is missed.
struct LaidPoint {
  PatchPoint at;
  bool any;
  std::array<float, kReliefBands> height;
};

// The points around an anchor.
std::vector<PatchPoint> points_around(const ReliefPoints& points, const ReliefAnchor& anchor, double radius) {
  std::vector<PatchPoint> around;
  points.for_each_near(anchor.at, anchor.up, radius, [&](std::uint32_t k, double squared, double facing) {
    const Vec3d offset = points.at(k) - anchor.at;
    const double x = dot(offset, anchor.right), y = dot(offset, anchor.ahead);
    const double across = std::sqrt(x * x + y * y), scale = across > 0.0 ? norm(offset) / across : 0.0;
    around.push_back({k, scale * x, scale * y, 1.0 - squared / (radius * radius), facing});
  });
  return around;
}

// 0 below -1, 1 above 1, with a continuous slope.
double step(double x) {
  const double t = std::clamp(0.5 * (x + 1.0), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

class PatchLaying {
 public:
  PatchLaying(const ReliefPatches& patches, const BandHeights& bands, const ReliefPoints& points,
              const ReliefDonors& donors, std::vector<LaidHeights>& laid)
      : patches_(patches), bands_(bands), points_(points), donors_(donors), laid_(laid) {
    agreeing_.assign(bands[0].size(), 0.0);
    for (std::size_t b = 1; b < kReliefBands; ++b)
      for (std::size_t i = 0; i < agreeing_.size(); ++i) agreeing_[i] += bands[b][i];
  }

  void lay(const ReliefAnchor& anchor, std::uint32_t hash) {
    constexpr std::size_t kCandidates = 16, kSomePoints = 64, kEnoughPoints = 256;
    const std::vector<PatchPoint> around = points_around(points_, anchor, patches_.anchor_spacing().radius());
    const std::vector<ReliefDonor> candidates = donors_.candidates(anchor, kCandidates, hash);
    if (candidates.empty()) return;
    const std::vector<ReliefDonor> better = most_agreeing(around, kSomePoints, candidates, kCandidates / 4);
    blend(read(around, most_agreeing(around, kEnoughPoints, better, 1)[0]));
  }

 private:
  bool is_laid(std::uint32_t place) const { return laid_[place].cover[kReliefBands / 2] > 0.5f; }
  // The heights that should agree.
  double agreeing(std::uint32_t place) const { return laid_[place].sum() - double{laid_[place].height[0]}; }

  // Some of the points that have been laid already.
  std::vector<PatchPoint> find_overlap(const std::vector<PatchPoint>& around, std::size_t enough) const {
    std::vector<PatchPoint> overlap, some;
    for (const PatchPoint& p : around) {
      if (is_laid(p.number)) overlap.push_back(p);
    }
    const std::size_t stride = 1 + overlap.size() / enough;
    for (std::size_t i = 0; i < overlap.size(); i += stride) some.push_back(overlap[i]);
    return some;
  }

  // How much a donor differs from the heights that have been laid, over the squares of both.
  double difference(const std::vector<PatchPoint>& overlap, const ReliefDonor& donor) const {
    const ReliefRows rows = patches_.rows_at(overlap, donor.middle, donor.turn);
    double differences = 0.0, squares = 0.0;
    for (std::size_t i = 0; i < overlap.size(); ++i) {
      const double old = agreeing(overlap[i].number);
      const double own = rows.any(i) ? rows.of(agreeing_, i) : -old;
      const double weight = overlap[i].facing * overlap[i].facing;
      differences += weight * (own - old) * (own - old);
      squares += weight * (own * own + old * old);
    }
    return squares > 0.0 ? differences / squares : 0.0;
  }

  // The `count` donors that differ least at some of the points around an anchor, the best first.
  std::vector<ReliefDonor> most_agreeing(const std::vector<PatchPoint>& around, std::size_t enough,
                                         const std::vector<ReliefDonor>& donors, std::size_t count) const {
    const std::vector<PatchPoint> overlap = find_overlap(around, enough);
    std::vector<std::pair<double, std::size_t>> costs(donors.size());
    parallel_for(0, static_cast<std::int64_t>(donors.size()), [&](std::int64_t number) {
      const auto d = static_cast<std::size_t>(number);
      costs[d] = {difference(overlap, donors[d]), d};
    });
    std::sort(costs.begin(), costs.end());
    std::vector<ReliefDonor> best;
    for (std::size_t k = 0; k < std::min(count, costs.size()); ++k) best.push_back(donors[costs[k].second]);
    return best;
  }

  std::vector<LaidPoint> read(const std::vector<PatchPoint>& around, const ReliefDonor& donor) const {
    constexpr std::size_t kTogether = 256;
    std::vector<LaidPoint> patch(around.size());
    const std::size_t groups = (around.size() + kTogether - 1) / kTogether;
    parallel_for(0, static_cast<std::int64_t>(groups), [&](std::int64_t number) {
      const std::size_t first = static_cast<std::size_t>(number) * kTogether,
                        end = std::min(around.size(), first + kTogether);
      const ReliefRows rows =
          patches_.rows_at({around.data() + first, around.data() + end}, donor.middle, donor.turn);
      for (std::size_t i = first; i < end; ++i) {
        patch[i] = {around[i], rows.any(i - first), {}};
        for (std::size_t b = 0; b < kReliefBands; ++b)
          patch[i].height[b] = static_cast<float>(rows.of(bands_[b], i - first));
      }
    });
    return patch;
  }

  ReliefSeam find_seam(const std::vector<LaidPoint>& patch) const {
    const double scale = 1.0 / patches_.anchor_spacing().radius();
    std::vector<SeamPoint> points;
    for (const LaidPoint& p : patch) {
      const double old = agreeing(p.at.number);
      double own = 0.0;
      for (std::size_t b = 1; b < kReliefBands; ++b) own += double{p.height[b]};
      const double difference = (p.any ? own : -old) - old;
      points.push_back({scale * p.at.x, scale * p.at.y, is_laid(p.at.number), difference * difference});
    }
    return ReliefSeam(points);
  }

  void blend(const std::vector<LaidPoint>& patch) {
    constexpr double kLeast = 1e-3;   // so that ground without older heights is covered
    constexpr double kMargin = 0.13;  // of 1 - d^2: beyond all seams
    const AnchorSpacing& apart = patches_.anchor_spacing();
    const double scale = 1.0 / apart.radius();
    const ReliefSeam seam = find_seam(patch);
    for (std::size_t b = 0; b < kReliefBands; ++b) {
      const double width = std::min(kSeamWidths[b] * apart.edge * scale, 0.4);
      const ReliefSeam smooth = seam.smoothed(0.5 * width);
      for (const LaidPoint& p : patch) {
        if (!p.any) continue;
        const double margin = smooth.margin(scale * p.at.x, scale * p.at.y) / width;
        const double inside = std::min(p.at.near / kMargin, 1.0) * p.at.facing * p.at.facing;
        LaidHeights& place = laid_[p.at.number];
        const double share = std::max(step(margin), kLeast * (1.0 - double{place.cover[b]})) * inside;
        const double left = (1.0 - share) * double{place.cover[b]}, all = share + left;
        place.height[b] =
            static_cast<float>((share * double{p.height[b]} + left * double{place.height[b]}) / all);
        place.cover[b] = static_cast<float>(all);
      }
    }
  }

  const ReliefPatches& patches_;
  const BandHeights& bands_;
  const ReliefPoints& points_;
  const ReliefDonors& donors_;
  std::vector<LaidHeights>& laid_;
  std::vector<double> agreeing_;
};

}  // namespace

ReliefSeam::ReliefSeam(const std::vector<SeamPoint>& points) {
  const SeamCosts costs(make_seam_cells(points));
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
  const double at = angle_step(x, y) - 0.5, cell = std::floor(at), t = at - cell;
  const std::size_t a = cell < 0.0 ? kAngles - 1 : std::min(static_cast<std::size_t>(cell), kAngles - 1);
  return (1.0 - t) * radii_[a] + t * radii_[next(a)] - std::sqrt(x * x + y * y);
}

ReliefBands::ReliefBands(const ReliefPoints& points, const std::vector<double>& heights, double edge)
    : rest(heights) {
  for (std::size_t band = 0; band < kReliefBands; ++band) {
    std::vector<double> smooth = smoothed_heights(points, rest, kBandCuts[band] * edge);
    for (std::size_t i = 0; i < rest.size(); ++i) rest[i] -= smooth[i];
    bands[band] = std::exchange(rest, std::move(smooth));
  }
}

void lay_patches(const ReliefPatches& patches, const BandHeights& bands, const ReliefPoints& points,
                 const std::vector<ReliefAnchor>& anchors, const ReliefDonors& donors, std::uint32_t hash,
                 std::vector<LaidHeights>& laid) {
  std::vector<std::pair<double, std::uint32_t>> order;
  for (std::uint32_t a = 0; a < anchors.size(); ++a)
    order.emplace_back(squared_norm(anchors[a].at - anchors[0].at), a);
  std::sort(order.begin(), order.end());
  PatchLaying laying(patches, bands, points, donors, laid);
  for (const auto& [distance, a] : order) laying.lay(anchors[a], hash_append(hash, a));
}

}  // namespace astrolith
