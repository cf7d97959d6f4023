// Chooses the edges of a mesh that have a turn in a sweep: those at vertices that moved in the last sweep or
// have moved in this one. A sweep then costs as much as moves, and vertices at rest cost nothing.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace astrolith {

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

}  // namespace astrolith
