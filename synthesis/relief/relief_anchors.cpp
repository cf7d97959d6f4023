#include "synthesis/relief/relief_anchors.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "numerics/hash_random.h"
#include "numerics/tangent_frame.h"

namespace astrolith {
namespace {

// The numbers of the places in an order that looks random.
std::vector<std::uint32_t> hashed_order(std::size_t n) {
  constexpr std::uint32_t kOrder = 0x51ed270bu;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> hashed(n);
  for (std::uint32_t i = 0; i < n; ++i) hashed[i] = {hash_append(kOrder, i), i};
  std::sort(hashed.begin(), hashed.end());
  std::vector<std::uint32_t> order(n);
  for (std::size_t k = 0; k < n; ++k) order[k] = hashed[k].second;
  return order;
}

// `order` has the numbers of the anchors, the smoothest first.
void mark_unseen(const std::vector<std::size_t>& order, std::vector<ReliefAnchor>& anchors) {
  constexpr double kSmooth = 1.0 / 7.0, kLeastShare = 0.03;
  const double limit = kSmooth * anchors[order[order.size() * 3 / 4]].rms;
  std::size_t count = 0;
  while (count < order.size() && anchors[order[count]].rms < limit) ++count;
  if (static_cast<double>(count) < kLeastShare * static_cast<double>(order.size())) return;
  for (std::size_t i = 0; i < count; ++i) anchors[order[i]].unseen = true;
}

}  // namespace

ReliefAnchor anchor_at(const ReliefPoints& points, std::uint32_t place) {
  const Vec3d up = normalized(points.normal(place));
  const auto [right, ahead] = crossed_tangents(up);
  return {place, points.at(place), right, ahead, up};
}

std::vector<ReliefAnchor> relief_anchors(const ReliefPoints& points, double distance) {
  std::vector<ReliefAnchor> anchors;
  std::vector<bool> covered(points.size(), false);
  for (const std::uint32_t i : hashed_order(points.size())) {
    if (covered[i]) continue;
    covered[i] = true;
    anchors.push_back(anchor_at(points, i));
    points.for_each_near(points.at(i), points.normal(i), distance,
                         [&](std::uint32_t k, double, double) { covered[k] = true; });
  }
  return anchors;
}

void rank_roughness(const std::vector<double>& squares, std::vector<ReliefAnchor>& anchors) {
  for (ReliefAnchor& anchor : anchors) anchor.rms = std::sqrt(squares[anchor.place]);
  std::vector<std::size_t> order(anchors.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return anchors[a].rms < anchors[b].rms; });
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    anchors[order[rank]].roughness = static_cast<double>(rank) / static_cast<double>(order.size());
  }
  mark_unseen(order, anchors);
}

}  // namespace astrolith
