#include "synthesis/relief/relief_anchors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "numerics/hash_random.h"
#include "numerics/parallel_for.h"
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

ReliefAnchor anchor_at(const Vec3d& at, const Vec3d& normal) {
  const Vec3d up = normalized(normal);
  const auto [right, ahead] = crossed_tangents(up);
  return {at, right, ahead, up};
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

void rank_roughness(const ReliefPoints& points, const std::vector<double>& heights, double radius,
                    std::vector<ReliefAnchor>& anchors) {
  parallel_for(0, static_cast<std::int64_t>(anchors.size()), [&](std::int64_t number) {
    ReliefAnchor& anchor = anchors[static_cast<std::size_t>(number)];
    double total = 0.0, squares = 0.0;
    points.for_each_near(anchor.at, anchor.up, radius, [&](std::uint32_t k, double, double) {
      total += points.weight(k);
      squares += points.weight(k) * heights[k] * heights[k];
    });
    anchor.rms = total > 0.0 ? std::sqrt(squares / total) : 0.0;
  });
  std::vector<std::size_t> order(anchors.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return anchors[a].rms < anchors[b].rms; });
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    anchors[order[rank]].roughness = static_cast<double>(rank) / static_cast<double>(order.size());
  }
  mark_unseen(order, anchors);
}

Box box_around(const std::vector<ReliefAnchor>& anchors) {
  Box box;
  for (const ReliefAnchor& anchor : anchors) box.extend(anchor.at);
  return box;
}

// The point of one box that lies in it as p lies in another.
Vec3d moved_along(const Vec3d& p, const Box& from, const Box& to) {
  const auto along = [](double at, double low, double high, double new_low, double new_high) {
    return high > low ? new_low + (at - low) * ((new_high - new_low) / (high - low)) : new_low;
  };
  return {along(p.x, from.min.x, from.max.x, to.min.x, to.max.x),
          along(p.y, from.min.y, from.max.y, to.min.y, to.max.y),
          along(p.z, from.min.z, from.max.z, to.min.z, to.max.z)};
}

std::uint32_t nearest_to(const Vec3d& p, const std::vector<ReliefAnchor>& anchors) {
  std::uint32_t nearest = 0;
  for (std::uint32_t i = 1; i < anchors.size(); ++i) {
    if (squared_norm(anchors[i].at - p) < squared_norm(anchors[nearest].at - p)) nearest = i;
  }
  return nearest;
}

// Whether each anchor may give a patch: with `fill` where the nearest six anchors and it have been seen, or
// if that is so nowhere, where it has.
std::vector<bool> possible_donors(const std::vector<ReliefAnchor>& measured, bool fill) {
  constexpr std::size_t kAround = 7;  // with the anchor itself
  std::vector<bool> possible(measured.size(), true), seen(measured.size());
  if (!fill) return possible;
  std::vector<std::size_t> order(measured.size());
  for (std::size_t a = 0; a < measured.size(); ++a) {
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto last = order.begin() + static_cast<std::ptrdiff_t>(std::min(kAround, order.size()));
    std::partial_sort(order.begin(), last, order.end(), [&](std::size_t i, std::size_t k) {
      const double of_i = squared_norm(measured[i].at - measured[a].at),
                   of_k = squared_norm(measured[k].at - measured[a].at);
      return of_i != of_k ? of_i < of_k : i < k;
    });
    seen[a] = !measured[a].unseen;
    possible[a] = std::none_of(order.begin(), last, [&](std::size_t i) { return measured[i].unseen; });
  }
  return std::count(possible.begin(), possible.end(), true) > 1 ? possible : seen;
}

}  // namespace

std::vector<ReliefAnchor> relief_anchors(const ReliefPoints& points, const std::vector<double>& heights,
                                         double distance, double radius) {
  std::vector<ReliefAnchor> anchors;
  std::vector<bool> covered(points.size(), false);
  for (const std::uint32_t i : hashed_order(points.size())) {
    if (covered[i]) continue;
    covered[i] = true;
    anchors.push_back(anchor_at(points.at(i), points.normal(i)));
    points.for_each_near(points.at(i), points.normal(i), distance,
                         [&](std::uint32_t k, double, double) { covered[k] = true; });
  }
  if (!heights.empty()) rank_roughness(points, heights, radius, anchors);
  return anchors;
}

std::vector<std::uint32_t> relief_donors(const std::vector<ReliefAnchor>& anchors,
                                         const std::vector<ReliefAnchor>& measured, double reach, bool fill,
                                         std::uint32_t hash) {
  constexpr double kFar = 100.0;          // worse than any difference of roughness
  constexpr double kLikeRoughness = 0.1;  // of all ranks: as bad as the worst hash
  const Box from = box_around(anchors), to = box_around(measured);
  const double length = reach * to.diagonal();
  const std::vector<bool> possible = possible_donors(measured, fill);
  std::vector<std::uint32_t> donors(anchors.size());
  parallel_for(0, static_cast<std::int64_t>(anchors.size()), [&](std::int64_t number) {
    const auto a = static_cast<std::uint32_t>(number);
    const Vec3d place = moved_along(anchors[a].at, from, to);
    const std::uint32_t own = nearest_to(place, measured);
    const bool any = fill && measured[own].unseen;
    double least = std::numeric_limits<double>::infinity();
    for (std::uint32_t b = 0; b < measured.size(); ++b) {
      if (b == own || !possible[b]) continue;
      const double beyond = std::max(norm(measured[b].at - place) / length - 1.0, 0.0);
      const double unlike = std::fabs(measured[b].roughness - measured[own].roughness) / kLikeRoughness;
      const double by_chance = double{unit_float(hash_append(hash_append(hash, a), b))};
      const double cost = any ? by_chance : kFar * beyond + unlike + by_chance;
      if (cost < least) least = cost, donors[a] = b;
    }
  });
  return donors;
}

}  // namespace astrolith
