#include "synthesis/relief/relief_laying.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "numerics/hash_random.h"
#include "numerics/parallel_for.h"
#include "synthesis/relief/relief_seam.h"

namespace astrolith {
namespace {

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
    constexpr std::size_t kCandidates = 16;
    const std::vector<PatchPoint> around = points_around(points_, anchor, patches_.anchor_spacing().radius());
    const std::vector<ReliefDonor> candidates = donors_.candidates(anchor, kCandidates, hash);
    if (candidates.empty()) return;
    blend(read(around, candidates[most_agreeing(around, candidates)]));
  }

 private:
  bool is_laid(std::uint32_t place) const { return laid_[place].cover[kReliefBands / 2] > 0.5f; }
  // The heights that should agree.
  double agreeing(std::uint32_t place) const { return laid_[place].sum() - double{laid_[place].height[0]}; }

  // Some of the points that have been laid already.
  std::vector<PatchPoint> overlap_of(const std::vector<PatchPoint>& around) const {
    constexpr std::size_t kEnough = 256;
    std::vector<PatchPoint> overlap, some;
    for (const PatchPoint& p : around) {
      if (is_laid(p.number)) overlap.push_back(p);
    }
    const std::size_t stride = 1 + overlap.size() / kEnough;
    for (std::size_t i = 0; i < overlap.size(); i += stride) some.push_back(overlap[i]);
    return some;
  }

  std::size_t most_agreeing(const std::vector<PatchPoint>& around,
                            const std::vector<ReliefDonor>& candidates) const {
    const std::vector<PatchPoint> overlap = overlap_of(around);
    std::vector<double> costs(candidates.size(), 0.0);
    parallel_for(0, static_cast<std::int64_t>(candidates.size()), [&](std::int64_t number) {
      const auto c = static_cast<std::size_t>(number);
      const ReliefRows rows = patches_.rows_at(overlap, candidates[c].middle, candidates[c].turn);
      double differences = 0.0, squares = 0.0;
      for (std::size_t i = 0; i < overlap.size(); ++i) {
        const double old = agreeing(overlap[i].number);
        const double own = rows.any(i) ? rows.of(agreeing_, i) : -old;
        const double weight = overlap[i].facing * overlap[i].facing;
        differences += weight * (own - old) * (own - old);
        squares += weight * (own * own + old * old);
      }
      costs[c] = squares > 0.0 ? differences / squares : 0.0;
    });
    return static_cast<std::size_t>(std::min_element(costs.begin(), costs.end()) - costs.begin());
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

  ReliefSeam seam_of(const std::vector<LaidPoint>& patch) const {
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
    const ReliefSeam seam = seam_of(patch);
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
