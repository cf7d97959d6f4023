#include "gravity/polyhedron_gravity.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "numerics/host_device.h"
#include "numerics/portable_double.h"
#include "numerics/reported_loop.h"
#include "numerics/split_at_rank.h"

namespace astrolith {
namespace {

constexpr double kCrudeOpening = 0.6;
constexpr int kCrudeOrder = 3;
constexpr double kRoughOpening = 0.5;  // radius of a node over its distance
constexpr double kLeastAcceleration = 0.05;
constexpr double kRoundOff = 0x1p-53;
constexpr double kDeviations = 5.0;  // errors of sums are nearly always below so many of their deviations
constexpr double kProductRoundOffs = 10.0;  // round-offs of what every value is multiplied by

// Points in the tables' units, and their indices in the caller's array.
struct Target {
  Vec3d point;
  std::uint32_t place;
};

// Orders the targets such that each run of kPointBatch is compact.
void order_targets(std::span<Target> targets) {
  if (targets.size() <= kPointBatch) return;
  Box box;
  for (const Target& t : targets) box.extend(t.point);
  double Vec3d::*const axis = longest_axis(box.extent());
  const std::size_t batches = (targets.size() + kPointBatch - 1) / kPointBatch,
                    half = batches / 2 * kPointBatch;
  split_at_rank(targets.begin(), targets.begin() + static_cast<std::ptrdiff_t>(half), targets.end(),
                [axis](const Target& a, const Target& b) {
                  return a.point.*axis != b.point.*axis ? a.point.*axis < b.point.*axis : a.place < b.place;
                });
  order_targets(targets.first(half));
  order_targets(targets.subspan(half));
}

std::vector<Target> ordered_targets(const GravityTree& tree, std::span<const Vec3d> points) {
  std::vector<Target> targets(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    targets[i] = {(points[i] - tree.origin) * (1.0 / tree.scale), static_cast<std::uint32_t>(i)};
  }
  order_targets(targets);
  return targets;
}

// Places behind the last point repeat that point.
GravityBatch make_batch(std::span<const Target> targets) {
  GravityBatch batch;
  for (std::size_t i = 0; i < kPointBatch; ++i) {
    const Vec3d& p = targets[std::min(i, targets.size() - 1)].point;
    batch.x[i] = p.x, batch.y[i] = p.y, batch.z[i] = p.z;
  }
  return batch;
}

PointRow distances_from(const Vec3d& center, const GravityBatch& points) {
  PointRow distances;
  for (std::size_t i = 0; i < kPointBatch; ++i) {
    const double x = points.x[i] - center.x, y = points.y[i] - center.y, z = points.z[i] - center.z;
    distances[i] = std::sqrt(x * x + y * y + z * z);
  }
  return distances;
}

// For each point the least order at which the error of a node is at most `allowed`; -1 where there is none.
ASTROLITH_SIMD_CLONES void least_orders(const GravityNode& node, int most_order, const PointRow& allowed,
                                        const GravityBatch& points, PointRow& orders) {
  PointRow power, inverse, limit;
  orders.fill(-1.0);
#pragma omp simd
  for (int i = 0; i < kPointBatch; ++i) {
    const double x = points.x[i] - node.center.x, y = points.y[i] - node.center.y,
                 z = points.z[i] - node.center.z, d = __builtin_sqrt(x * x + y * y + z * z);
    inverse[i] = 1.0 / d;
    power[i] = 1.0;
    limit[i] = d > node.radius ? allowed[i] * (d - node.radius) : -1.0;
  }
  for (int order = 0; order <= most_order; ++order) {
    const double spread = node.spread[static_cast<std::size_t>(order)];
#pragma omp simd
    for (int i = 0; i < kPointBatch; ++i) {
      power[i] *= inverse[i];
      orders[i] = orders[i] < 0.0 && spread * power[i] <= limit[i] ? order : orders[i];
    }
  }
}

// Walks the tree for points that are on. find_orders(node, orders) says to what order each point may take the
// node's multipoles, or -1 where it must open the node. Each point goes its own way, so that its sums do not
// depend on the points beside it. A leaf of 12 to 24 facets costs more by its facets than by its multipoles
// of the highest order.
template <typename FindOrders>
void walk(const GravityTree& tree, const GravityBatch& points, const PointRow& on,
          const FindOrders& find_orders, GravitySums& sums) {
  const auto end = static_cast<std::uint32_t>(tree.nodes.size());
  std::array<std::uint32_t, kPointBatch> from;  // the node where a point goes on
  for (std::size_t k = 0; k < kPointBatch; ++k) from[k] = on[k] > 0.0 ? 0 : end;
  for (std::uint32_t i = *std::min_element(from.begin(), from.end()); i < end;) {
    const GravityNode& node = tree.nodes[i];
    PointRow orders, open{};
    find_orders(node, orders);
    bool taken = false, opened = false;
    for (std::size_t k = 0; k < kPointBatch; ++k) {
      if (i < from[k]) {
        orders[k] = -1.0;
      } else if (orders[k] >= 0.0) {
        from[k] = node.next;
        taken = true;
      } else {
        open[k] = 1.0;
        opened = true;
      }
    }
    if (taken) add_multipoles(node, tree.multipoles[i], orders, points, sums);
    if (!opened) {
      i = *std::min_element(from.begin(), from.end());
    } else if (node.leaf != 0) {
      add_facets(std::span(tree.facets).subspan(node.first, node.count), points, open, sums);
      i = node.next;
    } else {
      ++i;
    }
  }
}

constexpr PointRow every_point() {
  PointRow on{};
  on.fill(1.0);
  return on;
}

// Takes all nodes whose radius is below `opening` times their distance by few multipoles.
GravitySums sums_opened_at(const GravityTree& tree, const GravityBatch& points, double opening) {
  const double order = std::min(kCrudeOrder, tree.most_order);
  GravitySums sums;
  walk(
      tree, points, every_point(),
      [&](const GravityNode& node, PointRow& orders) {
        orders = distances_from(node.center, points);
        for (double& at : orders) at = node.radius < opening * at ? order : -1.0;
      },
      sums);
  return sums;
}

// The accelerations that tolerances refer to, within some ten percent.
PointRow reference_accelerations(const GravityTree& tree, const GravityBatch& points) {
  const GravitySums sums = sums_opened_at(tree, points, kCrudeOpening);
  const double radius = portable::cbrt(std::fabs(tree.volume) * 0.75 / std::numbers::pi);
  PointRow least;
  for (std::size_t i = 0; i < kPointBatch; ++i) {
    const Vec3d g{sums.layers[0][i], sums.layers[1][i], sums.layers[2][i]};
    const Vec3d p{points.x[i], points.y[i], points.z[i]};
    const double ball = std::fabs(tree.volume) / std::max(squared_norm(p), radius * radius);
    least[i] = std::max(norm(g), kLeastAcceleration * ball);
  }
  return least;
}

// Bounds what the multipoles of the whole body cut off at distance d of its centre, over the acceleration.
// With q = radius / d a term of degree l is at most (l + 1) q^l of the first; the acceleration is at least
// the first term less all others.
double far_bound(const GravityTree& tree, double d) {
  const int first = tree.most_order;
  const double q = tree.nodes.front().radius / d;
  const double rest = 1.0 - q, least = 2.0 - 1.0 / (rest * rest);
  if (first == 0 || !(q < 1.0) || !(least > 0.0)) return std::numeric_limits<double>::infinity();
  double power = 1.0;
  for (int l = 0; l < first; ++l) power *= q;
  return power * ((first + 1) / rest + q / (rest * rest)) / least;
}

// Estimates what they cut off, relative: terms as strong as the last known ones, at the direction where they
// are largest. Those of the potential begin one degree later than those of the acceleration.
double far_error(const GravityTree& tree, double d) {
  return std::sqrt(2.0 * tree.most_order + 1.0) * tree.far_strength * far_bound(tree, d);
}
double far_potential_error(const GravityTree& tree, double d) {
  return far_error(tree, d) * tree.nodes.front().radius / (d * (tree.most_order + 1));
}

// 1 for points where is_far(distance from the centre) lets multipoles of the whole body be taken.
template <typename IsFar>
PointRow far_points(const GravityTree& tree, const GravityBatch& points, const IsFar& is_far) {
  PointRow on = distances_from(tree.nodes.front().center, points);
  for (double& at : on) at = is_far(at) ? 1.0 : 0.0;
  return on;
}

PointRow others(const PointRow& on) {
  PointRow off;
  for (std::size_t i = 0; i < kPointBatch; ++i) off[i] = 1.0 - on[i];
  return off;
}

bool any(const PointRow& on) { return *std::max_element(on.begin(), on.end()) > 0.0; }

GravitySums sums_within(const GravityTree& tree, const GravityBatch& points, double tolerance) {
  GravitySums sums;
  const PointRow far = far_points(tree, points, [&](double d) { return far_bound(tree, d) <= tolerance; });
  if (any(far)) add_far_body(tree, far, points, sums);
  const PointRow near = others(far);
  if (!any(near)) return sums;
  PointRow share = reference_accelerations(tree, points);
  for (double& bound : share) bound *= tolerance / tree.area;
  walk(
      tree, points, near,
      [&](const GravityNode& node, PointRow& orders) {
        PointRow allowed;
        for (std::size_t k = 0; k < kPointBatch; ++k) allowed[k] = share[k] * node.area;
        least_orders(node, tree.most_order, allowed, points, orders);
      },
      sums);
  return sums;
}

// What rounding leaves in sums over facets at distance d, relative, as `rounded` would estimate it for facets
// as wide as long. It grows with the square of the distance.
double facet_error(const GravityTree& tree, double d) {
  return 2.6 * kDeviations * kRoundOff * std::sqrt(tree.area) * d * d / std::fabs(tree.volume);
}

// Sums and estimates of their errors.
struct ExactSums {
  GravitySums sums;
  PointRow off_layers{}, off_work{};
};

// Over facets, for points that are on. The others have infinite errors.
ExactSums facet_sums(const GravityTree& tree, const PointRow& on, const GravityBatch& points) {
  ExactSums exact;
  RoundedSquares rounded;
  if (any(on)) add_facets(tree.facets, points, on, exact.sums, rounded);
  for (std::size_t i = 0; i < kPointBatch; ++i) {
    const double infinite = on[i] > 0.0 ? 0.0 : std::numeric_limits<double>::infinity();
    exact.off_layers[i] = kDeviations * kRoundOff * std::sqrt(rounded.layers[i]) + infinite;
    exact.off_work[i] = kDeviations * kRoundOff * std::sqrt(rounded.work[i]) + infinite;
  }
  return exact;
}

// Takes multipoles of the whole body where these are in error by less than sums over facets.
ExactSums exact_sums(const GravityTree& tree, const GravityBatch& points) {
  const PointRow far =
      far_points(tree, points, [&](double d) { return far_error(tree, d) < facet_error(tree, d); });
  ExactSums exact = facet_sums(tree, others(far), points);
  GravitySums by_body;
  add_far_body(tree, every_point(), points, by_body);
  const PointRow distances = distances_from(tree.nodes.front().center, points);
  for (std::size_t i = 0; i < kPointBatch; ++i) {
    const auto layers = [i](const GravitySums& s) {
      return norm(Vec3d{s.layers[0][i], s.layers[1][i], s.layers[2][i]});
    };
    if (const double off = far_error(tree, distances[i]) * layers(by_body); off < exact.off_layers[i]) {
      for (std::size_t k = 0; k < 3; ++k) exact.sums.layers[k][i] = by_body.layers[k][i];
      exact.off_layers[i] = off;
    }
    if (const double off = far_potential_error(tree, distances[i]) * std::fabs(by_body.work[i]);
        off < exact.off_work[i]) {
      exact.sums.work[i] = by_body.work[i];
      exact.off_work[i] = off;
    }
    exact.off_layers[i] += kProductRoundOffs * kRoundOff * layers(exact.sums);
    exact.off_work[i] += kProductRoundOffs * kRoundOff * std::fabs(exact.sums.work[i]);
  }
  return exact;
}

// Calls use(evaluate_sums(batch), index in the batch, place) for every point.
template <typename Sums, typename Use>
void evaluate(const GravityTree& tree, std::span<const Vec3d> points, const Progress& progress,
              const Sums& evaluate_sums, const Use& use) {
  const std::vector<Target> targets = ordered_targets(tree, points);
  const auto batches = static_cast<std::int64_t>((points.size() + kPointBatch - 1) / kPointBatch);
  reported_parallel_for({0, batches, batches}, progress, "sums of gravity", [&](std::int64_t i) {
    const std::size_t first = static_cast<std::size_t>(i) * kPointBatch;
    const std::span own =
        std::span(targets).subspan(first, std::min<std::size_t>(kPointBatch, targets.size() - first));
    const auto sums = evaluate_sums(make_batch(own));
    for (std::size_t k = 0; k < own.size(); ++k) use(sums, k, own[k].place);
  });
}

Attraction to_attraction(const GravityTree& tree, const GravitySums& sums, std::size_t k) {
  return {0.5 * tree.scale * tree.scale * sums.work[k],
          -tree.scale * Vec3d{sums.layers[0][k], sums.layers[1][k], sums.layers[2][k]}};
}

template <typename Sums>
std::vector<Attraction> attractions(const GravityTree& tree, std::span<const Vec3d> points,
                                    const Progress& progress, const Sums& evaluate_sums) {
  std::vector<Attraction> values(points.size());
  evaluate(tree, points, progress, evaluate_sums,
           [&](const GravitySums& sums, std::size_t k, std::uint32_t place) {
             values[place] = to_attraction(tree, sums, k);
           });
  return values;
}

// All places where there are at most `sample`, else as many at random.
std::vector<std::size_t> sampled_places(std::size_t count, int sample, std::uint64_t seed) {
  std::vector<std::size_t> places;
  if (count <= static_cast<std::size_t>(sample)) {
    places.resize(count);
    std::iota(places.begin(), places.end(), std::size_t{0});
    return places;
  }
  for (int i = 0; i < sample; ++i) {
    const auto unit =
        static_cast<double>(hash_cell(static_cast<std::uint32_t>(seed), i, 0, 0)) / 4294967296.0;
    places.push_back(std::min(static_cast<std::size_t>(unit * static_cast<double>(count)), count - 1));
  }
  return places;
}

}  // namespace

std::vector<Attraction> PolyhedronGravity::at(std::span<const Vec3d> points, double tolerance,
                                              const Progress& progress) const {
  return attractions(tree_, points, progress,
                     [&](const GravityBatch& batch) { return sums_within(tree_, batch, tolerance); });
}

std::vector<Attraction> PolyhedronGravity::roughly_at(std::span<const Vec3d> points) const {
  return attractions(tree_, points, {},
                     [&](const GravityBatch& batch) { return sums_opened_at(tree_, batch, kRoughOpening); });
}

ExactAttractions PolyhedronGravity::exactly_at(std::span<const Vec3d> points,
                                               const Progress& progress) const {
  ExactAttractions exact;
  exact.values.resize(points.size());
  exact.errors.resize(points.size());
  evaluate(
      tree_, points, progress, [&](const GravityBatch& batch) { return exact_sums(tree_, batch); },
      [&](const ExactSums& sums, std::size_t k, std::uint32_t place) {
        exact.values[place] = to_attraction(tree_, sums.sums, k);
        exact.errors[place] = {0.5 * tree_.scale * tree_.scale * sums.off_work[k],
                               tree_.scale * sums.off_layers[k]};
      });
  return exact;
}

AchievedError achieved_error(const PolyhedronGravity& gravity, std::span<const Vec3d> points,
                             std::span<const Attraction> values, int sample, std::uint64_t seed,
                             const Progress& progress) {
  AchievedError error;
  const std::vector<std::size_t> places = sampled_places(points.size(), sample, seed);
  if (places.empty()) return error;
  std::vector<Vec3d> chosen;
  for (const std::size_t place : places) chosen.push_back(points[place]);
  const ExactAttractions exact = gravity.exactly_at(chosen, progress);
  double sum = 0.0;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const Attraction &truth = exact.values[i], &value = values[places[i]];
    const double size = norm(truth.acceleration), potential = std::fabs(truth.potential);
    const double off = norm(value.acceleration - truth.acceleration) + exact.errors[i].acceleration,
                 off_potential = std::fabs(value.potential - truth.potential) + exact.errors[i].potential;
    const double relative = size > 0.0 ? off / size : 0.0;
    error.largest = std::max(error.largest, relative);
    if (potential > 0.0)
      error.largest_of_potential = std::max(error.largest_of_potential, off_potential / potential);
    sum += relative * relative;
  }
  error.points = static_cast<int>(places.size());
  error.rms = std::sqrt(sum / error.points);
  return error;
}

}  // namespace astrolith
