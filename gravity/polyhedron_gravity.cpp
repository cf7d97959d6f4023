#include "gravity/polyhedron_gravity.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "numerics/portable_double.h"
#include "numerics/reported_loop.h"

namespace astrolith {
namespace {

constexpr double kCrudeOpening = 0.6;
constexpr int kCrudeOrder = 3;
constexpr double kRoughOpening = 0.7;  // radius of a node over its distance
constexpr double kLeastAcceleration = 0.05;

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
  std::nth_element(targets.begin(), targets.begin() + static_cast<std::ptrdiff_t>(half), targets.end(),
                   [axis](const Target& a, const Target& b) {
                     return a.point.*axis != b.point.*axis ? a.point.*axis < b.point.*axis
                                                           : a.place < b.place;
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

// A batch with its ball. Places behind the last point repeat that point.
struct Batch {
  GravityBatch points;
  Vec3d center;
  double radius = 0.0;
};

Batch make_batch(std::span<const Target> targets) {
  Batch batch;
  Box box;
  for (std::size_t i = 0; i < kPointBatch; ++i) {
    const Vec3d& p = targets[std::min(i, targets.size() - 1)].point;
    batch.points.x[i] = p.x, batch.points.y[i] = p.y, batch.points.z[i] = p.z;
    box.extend(p);
  }
  batch.center = box.center();
  for (const Target& t : targets) batch.radius = std::max(batch.radius, norm(t.point - batch.center));
  return batch;
}

// The least order whose error at distance d of the node's centre is at most `allowed`; -1 where there is
// none.
int least_order(const GravityNode& node, int most_order, double d, double allowed) {
  if (!(d > node.radius)) return -1;
  const double inverse = 1.0 / d, limit = allowed * (d - node.radius);
  double power = 1.0;
  for (int order = 0; order <= most_order; ++order) {
    power *= inverse;
    if (node.spread[static_cast<std::size_t>(order)] * power <= limit) return order;
  }
  return -1;
}

// Walks the tree. order_of(node, distance of the batch from the node's centre) says to what order a node's
// multipoles may be taken, or -1 where the node must be opened. A leaf of 12 to 24 facets costs more by its
// facets than by its multipoles of the highest order.
template <typename OrderOf>
GravitySums walk(const GravityTree& tree, const Batch& batch, const OrderOf& order_of) {
  GravitySums sums;
  for (std::uint32_t i = 0; i < tree.nodes.size();) {
    const GravityNode& node = tree.nodes[i];
    const int order = order_of(node, norm(node.center - batch.center) - batch.radius);
    if (order >= 0) {
      add_multipoles(node, tree.multipoles[i], order, batch.points, sums);
      i = node.next;
    } else if (node.leaf != 0) {
      add_facets(std::span(tree.facets).subspan(node.first, node.count), batch.points, sums);
      i = node.next;
    } else {
      ++i;
    }
  }
  return sums;
}

// Takes all nodes whose radius is below `opening` times their distance by few multipoles.
GravitySums sums_opened_at(const GravityTree& tree, const Batch& batch, double opening) {
  const int order = std::min(kCrudeOrder, tree.most_order);
  return walk(tree, batch, [opening, order](const GravityNode& node, double d) {
    return node.radius < opening * d ? order : -1;
  });
}

// The acceleration that tolerances refer to: the least of a batch, within some ten percent.
double least_acceleration(const GravityTree& tree, const Batch& batch) {
  const GravitySums sums = sums_opened_at(tree, batch, kCrudeOpening);
  const double radius = portable::cbrt(std::fabs(tree.volume) * 0.75 / std::numbers::pi);
  double least = 1e300;
  for (std::size_t i = 0; i < kPointBatch; ++i) {
    const Vec3d g{sums.layers[0][i], sums.layers[1][i], sums.layers[2][i]};
    const Vec3d p{batch.points.x[i], batch.points.y[i], batch.points.z[i]};
    const double ball = std::fabs(tree.volume) / std::max(squared_norm(p), radius * radius);
    least = std::min(least, std::max(norm(g), kLeastAcceleration * ball));
  }
  return least;
}

GravitySums sums_within(const GravityTree& tree, const Batch& batch, double tolerance) {
  const double allowed = tolerance * least_acceleration(tree, batch) / tree.area;
  return walk(tree, batch, [&](const GravityNode& node, double d) {
    return least_order(node, tree.most_order, d, allowed * node.area);
  });
}

GravitySums exact_sums(const GravityTree& tree, const Batch& batch) {
  GravitySums sums;
  add_facets(tree.facets, batch.points, sums);
  return sums;
}

template <typename Sums>
std::vector<Attraction> evaluate(const GravityTree& tree, std::span<const Vec3d> points,
                                 const Progress& progress, const Sums& sums_of) {
  const std::vector<Target> targets = ordered_targets(tree, points);
  std::vector<Attraction> values(points.size());
  const auto batches = static_cast<std::int64_t>((points.size() + kPointBatch - 1) / kPointBatch);
  reported_parallel_for({0, batches, batches}, progress, "sums of gravity", [&](std::int64_t i) {
    const std::size_t first = static_cast<std::size_t>(i) * kPointBatch;
    const std::span own =
        std::span(targets).subspan(first, std::min<std::size_t>(kPointBatch, targets.size() - first));
    const GravitySums sums = sums_of(make_batch(own));
    for (std::size_t k = 0; k < own.size(); ++k) {
      values[own[k].place] = {0.5 * tree.scale * tree.scale * sums.work[k],
                              -tree.scale * Vec3d{sums.layers[0][k], sums.layers[1][k], sums.layers[2][k]}};
    }
  });
  return values;
}

}  // namespace

std::vector<Attraction> PolyhedronGravity::at(std::span<const Vec3d> points, double tolerance,
                                              const Progress& progress) const {
  return evaluate(tree_, points, progress,
                  [&](const Batch& batch) { return sums_within(tree_, batch, tolerance); });
}

std::vector<Attraction> PolyhedronGravity::roughly_at(std::span<const Vec3d> points) const {
  return evaluate(tree_, points, {},
                  [&](const Batch& batch) { return sums_opened_at(tree_, batch, kRoughOpening); });
}

std::vector<Attraction> PolyhedronGravity::exactly_at(std::span<const Vec3d> points,
                                                      const Progress& progress) const {
  return evaluate(tree_, points, progress, [&](const Batch& batch) { return exact_sums(tree_, batch); });
}

AchievedError achieved_error(const PolyhedronGravity& gravity, std::span<const Vec3d> points,
                             std::span<const Attraction> values, int sample, std::uint64_t seed,
                             const Progress& progress) {
  AchievedError error;
  if (points.empty()) return error;
  std::vector<Vec3d> chosen;
  std::vector<std::size_t> places;
  for (int i = 0; i < sample; ++i) {
    const auto unit =
        static_cast<double>(hash_cell(static_cast<std::uint32_t>(seed), i, 0, 0)) / 4294967296.0;
    places.push_back(
        std::min(static_cast<std::size_t>(unit * static_cast<double>(points.size())), points.size() - 1));
    chosen.push_back(points[places.back()]);
  }
  const std::vector<Attraction> exact = gravity.exactly_at(chosen, progress);
  double sum = 0.0;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const Attraction &truth = exact[i], &value = values[places[i]];
    const double size = norm(truth.acceleration);
    const double off = size > 0.0 ? norm(value.acceleration - truth.acceleration) / size : 0.0;
    error.largest = std::max(error.largest, off);
    error.largest_of_potential =
        std::max(error.largest_of_potential,
                 std::fabs(value.potential - truth.potential) / std::fabs(truth.potential));
    sum += off * off;
  }
  error.points = sample;
  error.rms = std::sqrt(sum / sample);
  return error;
}

}  // namespace astrolith
