#include <cmath>

#include "synthesis/finish/active_edges_internal.h"
#include "synthesis/finish/ground_slides_internal.h"

namespace astrolith {
namespace {

constexpr double kSettled = 1e-3;  // relative excess over the aim that starts no slide
// Above 1: slides go beyond their aim and settle in fewer sweeps (successive over-relaxation).
constexpr double kRelaxation = 1.6;

// Lets material slide down one edge. Returns whether the edge was too high.
bool slide(const GroundEdge& edge, std::span<const double> area, std::span<double> heights) {
  const auto [a, b] = edge.ends;
  const double drop = edge.drop + (heights[a] - heights[b]);
  const double excess = std::fabs(drop) - edge.limit;
  if (!(excess > kSettled * edge.limit)) return false;
  const double volume = kRelaxation * excess / (1.0 / area[a] + 1.0 / area[b]);
  const double down = drop > 0.0 ? volume : -volume;
  heights[a] -= down / area[a];
  heights[b] += down / area[b];
  return volume != 0.0;
}

}  // namespace

Incline incline(std::span<const Vec3d> positions, std::span<const Vec3d> up, GroundPair pair) {
  const Vec3d d = positions[pair.a] - positions[pair.b];
  const Vec3d vertical = normalized(up[pair.a] + up[pair.b]);
  const double drop = dot(d, vertical);
  return {drop, norm(d - drop * vertical)};
}

std::vector<GroundEdge> ground_edges(const Ground& ground, std::span<const GroundPair> pairs, double slope) {
  std::vector<GroundEdge> edges;
  edges.reserve(pairs.size());
  for (const GroundPair& pair : pairs) {
    const Incline i = incline(ground.positions, ground.up, pair);
    edges.push_back({pair, i.drop, slope * i.length});
  }
  return edges;
}

GroundSlides slide_ground(std::span<const GroundEdge> edges, std::span<const double> area, int most_sweeps,
                          const std::function<void(int)>& after_sweep, std::span<double> heights) {
  ActiveEdges active(heights.size(), edges.size(), [&](std::size_t e) { return edges[e].ends; });
  GroundSlides done;
  while (done.sweeps < most_sweeps && !done.at_rest) {
    ++done.sweeps;
    done.at_rest = true;
    // Forwards in odd sweeps and backwards in even ones, so that no direction is preferred.
    active.sweep(done.sweeps % 2 == 1, [&](std::size_t e) {
      if (!slide(edges[e], area, heights)) return;
      active.wake(edges[e].ends.a);
      active.wake(edges[e].ends.b);
      done.at_rest = false;
      done.any = true;
    });
    after_sweep(done.sweeps);
  }
  return done;
}

}  // namespace astrolith
