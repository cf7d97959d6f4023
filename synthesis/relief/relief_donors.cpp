#include "synthesis/relief/relief_donors.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "numerics/hash_random.h"

namespace astrolith {
namespace {

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

// The rank of each value among all, from 0 up to 1.
std::vector<double> find_ranks(const std::vector<double>& values) {
  std::vector<std::uint32_t> order(values.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return values[a] < values[b]; });
  std::vector<double> ranks(values.size());
  for (std::size_t k = 0; k < order.size(); ++k)
    ranks[order[k]] = static_cast<double>(k) / static_cast<double>(order.size());
  return ranks;
}

}  // namespace

ReliefDonors::ReliefDonors(const ReliefPatches& patches, const std::vector<ReliefAnchor>& anchors,
                           double reach, bool fill)
    : patches_(patches),
      from_(box_around(anchors)),
      to_(box_around(patches.anchors())),
      reach_(reach * to_.diagonal()),
      ranks_(find_ranks(patches.squares_around())) {
  for (const ReliefAnchor& anchor : patches.anchors()) {
    if (fill && anchor.unseen) unseen_.push_back(anchor.at);
  }
}

const ReliefAnchor& ReliefDonors::own_anchor(const Vec3d& own) const {
  const auto nearer = [&](const ReliefAnchor& a, const ReliefAnchor& b) {
    return squared_norm(a.at - own) < squared_norm(b.at - own);
  };
  return *std::min_element(patches_.anchors().begin(), patches_.anchors().end(), nearer);
}

// 0 for a place within all limits.
double ReliefDonors::beyond_limits(std::uint32_t place, const Vec3d& own,
                                   const ReliefAnchor& near_own) const {
  constexpr double kLikeRanks = 0.1, kOwn = 1e6, kUnseen = 1e4, kFar = 100.0;
  const Vec3d& at = patches_.points().at(place);
  const double distance = norm(at - own), apart = patches_.anchor_spacing().distance();
  double cost = distance < apart ? kOwn : 0.0;
  const auto is_near = [&](const Vec3d& unseen) { return squared_norm(unseen - at) < 4.0 * apart * apart; };
  if (std::any_of(unseen_.begin(), unseen_.end(), is_near)) cost += kUnseen;
  if (!unseen_.empty() && near_own.unseen) return cost;
  cost += kFar * std::max(distance / reach_ - 1.0, 0.0);
  return cost + std::max(std::fabs(ranks_[place] - ranks_[near_own.place]) / kLikeRanks - 1.0, 0.0);
}

std::vector<ReliefDonor> ReliefDonors::candidates(const ReliefAnchor& anchor, std::size_t count,
                                                  std::uint32_t hash) const {
  constexpr std::uint32_t kMostDraws = 1024;
  const Vec3d own = moved_along(anchor.at, from_, to_);
  const ReliefAnchor& near_own = own_anchor(own);
  std::vector<std::pair<double, std::uint32_t>> drawn;  // cost, place; the least first, in the order of draws
  std::size_t within = 0;
  for (std::uint32_t k = 0; k < kMostDraws && within < count; ++k) {
    const std::uint64_t random = hash_append(hash, k);
    const auto place = static_cast<std::uint32_t>(random * ranks_.size() >> 32);
    drawn.emplace_back(beyond_limits(place, own, near_own), place);
    within += drawn.back().first == 0.0;
  }
  std::stable_sort(drawn.begin(), drawn.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  drawn.resize(std::min(count, drawn.size()));
  std::vector<ReliefDonor> donors;
  for (const auto& [cost, place] : drawn) {
    const auto number = static_cast<std::uint32_t>(donors.size());
    donors.push_back({anchor_at(patches_.points(), place),
                      hash_to_turn(hash_append(hash_append(hash, kMostDraws), number))});
  }
  return donors;
}

}  // namespace astrolith
