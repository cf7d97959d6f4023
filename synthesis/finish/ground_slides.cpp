#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "synthesis/finish/ground_slides_internal.h"

namespace astrolith {
namespace {

// Chooses the edges of a mesh that have a turn in a sweep: those at vertices that moved in the last sweep or
// have moved in this one. A sweep then costs as much as moves, and vertices at rest cost nothing.
class ActiveEdges {
 public:
  // ends(edge) gives the two vertices a and b of an edge. All edges have a turn in the first sweep.
  template <typename Ends>
  ActiveEdges(std::size_t num_vertices, std::size_t num_edges, const Ends& ends)
      : first_(num_vertices + 1, 0),
        incident_(2 * num_edges),
        now_((num_edges + 63) / 64, ~std::uint64_t{0}),
        next_(now_.size(), 0) {
    if (num_edges % 64 != 0) now_.back() = (std::uint64_t{1} << (num_edges % 64)) - 1;
    for (std::size_t e = 0; e < num_edges; ++e) {
      const auto [a, b] = ends(e);
      ++first_[a + 1], ++first_[b + 1];
    }
    for (std::size_t v = 0; v < num_vertices; ++v) first_[v + 1] += first_[v];
    std::vector<std::size_t> end(first_.begin(), first_.end() - 1);
    for (std::size_t e = 0; e < num_edges; ++e) {
      const auto [a, b] = ends(e);
      for (const std::uint32_t v : {a, b}) incident_[end[v]++] = static_cast<std::uint32_t>(e);
    }
  }

  // Gives the edges around a vertex a turn in the next sweep. Edges whose place in the present sweep is still
  // to come have a turn in it too.
  void wake(std::uint32_t vertex) {
    for (std::size_t i = first_[vertex]; i < first_[vertex + 1]; ++i) {
      const std::uint64_t bit = std::uint64_t{1} << (incident_[i] % 64);
      now_[incident_[i] / 64] |= bit;
      next_[incident_[i] / 64] |= bit;
    }
  }

  // Makes one sweep, in the order of the edges or in the reverse order. visit(edge) may wake vertices.
  template <typename Visit>
  void sweep(bool forwards, const Visit& visit) {
    for (std::size_t i = 0; i < now_.size(); ++i) {
      const std::size_t word = forwards ? i : now_.size() - 1 - i;
      for (std::uint64_t ahead = ~std::uint64_t{0}; (now_[word] & ahead) != 0;) {
        const std::uint64_t bits = now_[word] & ahead;
        const int bit = forwards ? std::countr_zero(bits) : 63 - std::countl_zero(bits);
        const std::uint64_t below = (std::uint64_t{1} << bit) - 1;
        ahead = forwards ? ~(below | std::uint64_t{1} << bit) : below;
        visit(64 * word + static_cast<std::size_t>(bit));
      }
    }
    now_.swap(next_);
    next_.assign(next_.size(), 0);
  }

 private:
  std::vector<std::size_t> first_;  // where the edges of a vertex start in incident_
  std::vector<std::uint32_t> incident_;
  std::vector<std::uint64_t> now_, next_;  // one bit for each edge
};

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
