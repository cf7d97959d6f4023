#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "numerics/tangent_frame.h"
#include "synthesis/finish/ground_slides_internal.h"

namespace astrolith {
namespace {

constexpr std::uint32_t kNoCluster = std::numeric_limits<std::uint32_t>::max();
constexpr double kClusterRadius = 2.0;  // of a cluster, in mean lengths of the edges of its columns
// Clusters are this flat: neighbours on a body of fewer clusters have verticals of too different directions.
constexpr std::size_t kFewestClusters = 400;
constexpr double kLeastSweeps = 1.0;
// Each coarser level aims at a slope lower by this share. Its slopes are those of other directions than the
// edges of the finer level have, and what it leaves above the finer level's aim would have to slide far.
constexpr double kMargin = 0.01;
constexpr int kMostMargins = 3;
constexpr double kReach = 1.5;  // of a cluster's rise, in radii of clusters

// The neighbours of each column, one after another.
class NeighbourLists {
 public:
  NeighbourLists(std::size_t num_columns, std::span<const GroundPair> pairs)
      : first_(num_columns + 1, 0), neighbours_(2 * pairs.size()) {
    for (const GroundPair& pair : pairs) ++first_[pair.a + 1], ++first_[pair.b + 1];
    for (std::size_t v = 0; v < num_columns; ++v) first_[v + 1] += first_[v];
    std::vector<std::size_t> end(first_.begin(), first_.end() - 1);
    for (const GroundPair& pair : pairs) {
      neighbours_[end[pair.a]++] = pair.b;
      neighbours_[end[pair.b]++] = pair.a;
    }
  }
  std::span<const std::uint32_t> of(std::uint32_t column) const {
    return std::span(neighbours_).subspan(first_[column], first_[column + 1] - first_[column]);
  }

 private:
  std::vector<std::size_t> first_;  // where the neighbours of a column start
  std::vector<std::uint32_t> neighbours_;
};

// Clusters of columns: the columns of the next coarser level.
struct ColumnClusters {
  double radius = 0.0;
  std::vector<std::uint32_t> column_cluster;  // the cluster of each column, or kNoCluster
  std::vector<Vec3d> positions, up;
  std::vector<double> area;
  std::vector<GroundPair> pairs;

  Ground ground() const { return {positions, up, area, pairs}; }
};

double mean_length(const Ground& ground) {
  double sum = 0.0;
  for (const GroundPair& pair : ground.pairs)
    sum += norm(ground.positions[pair.a] - ground.positions[pair.b]);
  return ground.pairs.empty() ? 0.0 : sum / double(ground.pairs.size());
}

// A column that no cluster covers becomes the seed of one. A cluster takes the columns that lie within its
// radius and are nearer to its seed than to an earlier one, as far as they hang together. Returns the number
// of clusters.
std::uint32_t assign_clusters(const Ground& ground, ColumnClusters& clusters) {
  const std::size_t n = ground.positions.size();
  const NeighbourLists neighbours(n, ground.pairs);
  std::vector<float> distance(n, std::numeric_limits<float>::max());  // squared, in squared radii
  const double scale = 1.0 / (clusters.radius * clusters.radius);
  clusters.column_cluster.assign(n, kNoCluster);
  std::vector<std::uint32_t> queue;
  std::uint32_t count = 0;
  for (std::uint32_t seed = 0; seed < n; ++seed) {
    if (!(ground.area[seed] > 0.0) || clusters.column_cluster[seed] != kNoCluster) continue;
    queue.assign(1, seed);
    clusters.column_cluster[seed] = count;
    distance[seed] = 0.0f;
    for (std::size_t i = 0; i < queue.size(); ++i) {
      for (const std::uint32_t v : neighbours.of(queue[i])) {
        const auto d = static_cast<float>(scale * squared_norm(ground.positions[v] - ground.positions[seed]));
        if (!(d < 1.0f && d < distance[v])) continue;
        distance[v] = d;
        clusters.column_cluster[v] = count;
        queue.push_back(v);
      }
    }
    ++count;
  }
  return count;
}

// A cluster stands at the mean position of its columns, along their mean vertical.
void sum_columns(const Ground& ground, std::uint32_t count, ColumnClusters& clusters) {
  clusters.area.assign(count, 0.0);
  clusters.positions.assign(count, {});
  clusters.up.assign(count, {});
  for (std::size_t v = 0; v < clusters.column_cluster.size(); ++v) {
    const std::uint32_t c = clusters.column_cluster[v];
    if (c == kNoCluster) continue;
    clusters.area[c] += ground.area[v];
    clusters.positions[c] += ground.area[v] * ground.positions[v];
    clusters.up[c] += ground.area[v] * ground.up[v];
  }
  for (std::uint32_t c = 0; c < count; ++c) {
    clusters.positions[c] *= 1.0 / clusters.area[c];
    clusters.up[c] = normalized(clusters.up[c]);
  }
}

void join_neighbours(const Ground& ground, ColumnClusters& clusters) {
  for (const GroundPair& pair : ground.pairs) {
    const auto [a, b] = std::minmax(clusters.column_cluster[pair.a], clusters.column_cluster[pair.b]);
    if (a != b && b != kNoCluster) clusters.pairs.push_back({a, b});
  }
  std::sort(clusters.pairs.begin(), clusters.pairs.end());
  clusters.pairs.erase(std::unique(clusters.pairs.begin(), clusters.pairs.end()), clusters.pairs.end());
}

ColumnClusters make_clusters(const Ground& ground) {
  ColumnClusters clusters;
  clusters.radius = kClusterRadius * mean_length(ground);
  if (!(clusters.radius > 0.0)) return clusters;
  const std::uint32_t count = assign_clusters(ground, clusters);
  sum_columns(ground, count, clusters);
  join_neighbours(ground, clusters);
  return clusters;
}

// The pairs of clusters that are neighbours or have one in common. With these edges in some sixteen
// directions, slopes are limited nearly alike in all directions.
std::vector<GroundPair> wide_pairs(std::size_t count, const NeighbourLists& neighbours) {
  std::vector<GroundPair> pairs;
  std::vector<std::uint32_t> seen(count, kNoCluster);
  for (std::uint32_t c = 0; c < count; ++c) {
    seen[c] = c;
    const auto add = [&](std::uint32_t d) {
      if (seen[d] == c) return;
      seen[d] = c;
      if (d > c) pairs.push_back({c, d});
    };
    for (const std::uint32_t d : neighbours.of(c)) add(d);
    for (const std::uint32_t d : neighbours.of(c)) {
      for (const std::uint32_t e : neighbours.of(d)) add(e);
    }
  }
  return pairs;
}

// The horizontal gradient of the rises at each cluster: the least-squares one over its neighbours.
std::vector<Vec3d> gradients(const ColumnClusters& clusters, const NeighbourLists& neighbours,
                             std::span<const double> rises) {
  std::vector<Vec3d> result(rises.size());
  for (std::uint32_t c = 0; c < rises.size(); ++c) {
    const Tangents<double> frame = crossed_tangents(clusters.up[c]);
    double xx = 0.0, xy = 0.0, yy = 0.0, xr = 0.0, yr = 0.0;
    for (const std::uint32_t d : neighbours.of(c)) {
      const Vec3d to = clusters.positions[d] - clusters.positions[c];
      const double x = dot(to, frame.first), y = dot(to, frame.second), rise = rises[d] - rises[c];
      xx += x * x, xy += x * y, yy += y * y;
      xr += x * rise, yr += y * rise;
    }
    // Neighbours in a row leave the direction across it open. A small term makes the gradient 0 there.
    const double small = 1e-3 * (xx + yy);
    xx += small, yy += small;
    const double determinant = xx * yy - xy * xy;
    if (!(determinant > 0.0)) continue;
    result[c] = ((yy * xr - xy * yr) / determinant) * frame.first +
                ((xx * yr - xy * xr) / determinant) * frame.second;
  }
  return result;
}

// Spreads values of clusters smoothly over the columns of all clusters that have moved. The columns of the
// others stay: ground that is to reach them slides there in the end.
class SmoothSpread {
 public:
  SmoothSpread(const Ground& ground, const ColumnClusters& clusters, const NeighbourLists& neighbours,
               std::span<const double> rises)
      : ground_(ground), clusters_(clusters), neighbours_(neighbours), rises_(rises) {}

  // Adds to the heights the mean of the planes values[c] + gradients[c] . (p - position of c) of the clusters
  // c around a column at p, each weighted by its distance. Without gradients the planes are level.
  void add(std::span<const double> values, std::span<const Vec3d> gradients,
           std::span<double> heights) const {
    const double scale = 1.0 / ((kReach * clusters_.radius) * (kReach * clusters_.radius));
    for (std::size_t v = 0; v < heights.size(); ++v) {
      const std::uint32_t own = clusters_.column_cluster[v];
      if (own == kNoCluster || rises_[own] == 0.0) continue;
      double sum = 0.0, weights = 0.0;
      const auto add_plane = [&](std::uint32_t c) {
        const Vec3d to = ground_.positions[v] - clusters_.positions[c];
        const double inside = std::max(1.0 - squared_norm(to) * scale, 0.0);
        const double weight = inside * inside;
        weights += weight;
        sum += weight * (values[c] + (gradients.empty() ? 0.0 : dot(gradients[c], to)));
      };
      add_plane(own);
      for (const std::uint32_t c : neighbours_.of(own)) add_plane(c);
      heights[v] += weights > 0.0 ? sum / weights : values[own];
    }
  }

 private:
  const Ground& ground_;
  const ColumnClusters& clusters_;
  const NeighbourLists& neighbours_;
  std::span<const double> rises_;
};

// The rises of the columns. What they lack of the volume of their cluster is spread too.
std::vector<double> column_rises(const Ground& ground, const ColumnClusters& clusters,
                                 const NeighbourLists& neighbours, std::span<const double> rises) {
  const SmoothSpread spread(ground, clusters, neighbours, rises);
  std::vector<double> heights(ground.positions.size(), 0.0);
  spread.add(rises, gradients(clusters, neighbours, rises), heights);
  std::vector<double> lacking(rises.begin(), rises.end());
  for (std::size_t v = 0; v < heights.size(); ++v) {
    const std::uint32_t c = clusters.column_cluster[v];
    if (c != kNoCluster) lacking[c] -= ground.area[v] * heights[v] / clusters.area[c];
  }
  spread.add(lacking, {}, heights);
  return heights;
}

std::vector<double> level_slides(const Ground& ground, double slope, double most_sweeps, int margins,
                                 const std::function<void(int)>& after_sweep) {
  const auto loose =
      double(std::count_if(ground.area.begin(), ground.area.end(), [](double a) { return a > 0.0; }));
  std::vector<double> none(ground.positions.size(), 0.0);
  if (!(loose >= double(kFewestClusters)) || !(most_sweeps >= 3.0 * kLeastSweeps)) return none;
  const ColumnClusters clusters = make_clusters(ground);
  const std::size_t count = clusters.positions.size();
  const double sweeps = most_sweeps * double(count) / loose;
  if (count < kFewestClusters || double(count) > 0.7 * loose || !(sweeps >= kLeastSweeps)) return none;
  const double aim = margins < kMostMargins ? slope * (1.0 - kMargin) : slope;
  std::vector<double> rises = level_slides(clusters.ground(), aim, sweeps, margins + 1, after_sweep);
  const NeighbourLists neighbours(count, clusters.pairs);
  const GroundSlides done = slide_ground(ground_edges(clusters.ground(), wide_pairs(count, neighbours), aim),
                                         clusters.area, static_cast<int>(sweeps), after_sweep, rises);
  if (!done.any && std::all_of(rises.begin(), rises.end(), [](double r) { return r == 0.0; })) return none;
  return column_rises(ground, clusters, neighbours, rises);
}

}  // namespace

std::vector<double> coarse_slides(const Ground& ground, double slope, double most_sweeps,
                                  const std::function<void(int)>& after_sweep) {
  return level_slides(ground, slope, most_sweeps, 0, after_sweep);
}

}  // namespace astrolith
