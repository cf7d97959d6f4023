#include "synthesis/mesh/manifold_check.h"

#include <algorithm>
#include <numeric>

#include "numerics/errors.h"
#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

enum class Link : std::uint8_t { kCycle, kOpen, kNonManifold };

// The edge of a vertex's link that begins at vertex `from`; the end of the span where there is none. The
// edges are sorted by `from`.
template <typename Corner>
auto edge_from(std::span<const Corner> corners, std::uint32_t from) {
  const auto edge = std::lower_bound(corners.begin(), corners.end(), from,
                                     [](const Corner& c, std::uint32_t f) { return c.from < f; });
  return edge != corners.end() && edge->from == from ? edge : corners.end();
}

// Whether an open link is one path, as around a vertex of a border. Two paths touch in their vertex only.
template <typename Corner>
bool is_path(std::span<const Corner> corners) {
  std::vector<std::uint32_t> ends;
  for (const Corner& c : corners) ends.push_back(c.to);
  std::sort(ends.begin(), ends.end());
  auto edge = std::find_if(corners.begin(), corners.end(), [&](const Corner& c) {
    return !std::binary_search(ends.begin(), ends.end(), c.from);
  });
  std::size_t steps = 0;
  for (; edge != corners.end() && steps < corners.size(); ++steps) edge = edge_from(corners, edge->to);
  return edge == corners.end() && steps == corners.size();
}

// Whether the few edges of a link form one cycle, found without sorting them. Each step takes the first edge
// that begins where the last one ended, so that a walk which is back after as many steps as there are edges
// has taken each edge once.
template <typename Corner>
bool is_short_cycle(std::span<const Corner> corners) {
  constexpr std::size_t kFew = 16;
  if (corners.size() > kFew) return false;
  std::size_t at = 0, steps = 0;
  do {
    const std::uint32_t to = corners[at].to;
    for (at = 0; at < corners.size() && corners[at].from != to;) ++at;
  } while (++steps < corners.size() && at != 0 && at < corners.size());
  return at == 0 && steps == corners.size();
}

// Finds out whether the directed edges (from, to) opposite a vertex form one cycle or one path. May sort them
// by `from`.
template <typename Corner>
Link classify_link(std::span<Corner> corners) {
  if (corners.empty()) return Link::kNonManifold;
  if (is_short_cycle(std::span<const Corner>(corners))) return Link::kCycle;
  std::sort(corners.begin(), corners.end(), [](const Corner& a, const Corner& b) { return a.from < b.from; });
  for (std::size_t i = 1; i < corners.size(); ++i) {
    if (corners[i].from == corners[i - 1].from) return Link::kNonManifold;
  }
  const std::span<const Corner> sorted = corners;
  auto edge = sorted.begin();
  for (std::size_t steps = 1; steps <= sorted.size(); ++steps) {
    edge = edge_from(sorted, edge->to);
    if (edge == sorted.end()) return is_path(sorted) ? Link::kOpen : Link::kNonManifold;
    if (edge == sorted.begin()) return steps == sorted.size() ? Link::kCycle : Link::kNonManifold;
  }
  return Link::kNonManifold;
}

}  // namespace

void ManifoldCheck::add_vertices(std::span<const MeshVertex> vertices) {
  settle(window_, window_first_, batch_first_);
  window_.swap(batch_);
  batch_.clear();
  forget_components_below(batch_first_);
  window_first_ = batch_first_;
  batch_first_ = end_;
  end_ += static_cast<std::uint32_t>(vertices.size());
  parent_.resize(end_ - window_first_);
  std::iota(parent_.begin() + (batch_first_ - window_first_), parent_.end(), batch_first_);
  report_.vertices += static_cast<std::int64_t>(vertices.size());
}

// Counts the components that end below vertex `first`. Each other component gets its lowest remaining vertex
// as its root.
void ManifoldCheck::forget_components_below(std::uint32_t first) {
  std::vector<std::uint32_t> lowest(parent_.size(), end_);  // lowest remaining vertex, by root
  std::vector<std::uint32_t> kept;
  for (std::uint32_t v = first; v < end_; ++v) {
    std::uint32_t& low = lowest[root(v) - window_first_];
    low = std::min(low, v);
    kept.push_back(low);
  }
  for (std::uint32_t v = window_first_; v < end_; ++v) {
    const bool is_root = parent_[v - window_first_] == v;
    report_.components += is_root && lowest[v - window_first_] == end_ ? 1 : 0;
  }
  parent_ = std::move(kept);
}

void ManifoldCheck::add_triangles(std::span<const Triangle> triangles) {
  for (const Triangle& t : triangles) {
    if (*std::max_element(t.begin(), t.end()) >= end_) {
      throw WorkError("mesh: a triangle names a vertex not yet given");
    }
    if (*std::min_element(t.begin(), t.end()) < window_first_) {
      ++report_.late_triangles;
      continue;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      (t[k] < batch_first_ ? window_ : batch_).push_back({t[k], t[(k + 1) % 3], t[(k + 2) % 3]});
    }
    unite(t[0], t[1]);
    unite(t[1], t[2]);
  }
  report_.triangles += static_cast<std::int64_t>(triangles.size());
}

// Groups corners by vertex (a counting sort) and classifies each group.
void ManifoldCheck::settle(std::vector<Corner>& corners, std::uint32_t first, std::uint32_t end) {
  std::vector<std::size_t> starts(end - first + 1, 0);
  std::erase_if(corners, [first](const Corner& c) { return c.vertex < first; });
  for (const Corner& c : corners) ++starts[c.vertex - first + 1];
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  std::vector<Corner> sorted(corners.size());
  std::vector<std::size_t> next(starts.begin(), starts.end() - 1);
  for (const Corner& c : corners) sorted[next[c.vertex - first]++] = c;
  std::vector<Link> links(end - first);
  constexpr std::int64_t kGrain = 1024;
  parallel_for(
      0, static_cast<std::int64_t>(links.size()),
      [&](std::int64_t i) {
        const auto v = static_cast<std::size_t>(i);
        links[v] = classify_link(std::span(sorted).subspan(starts[v], starts[v + 1] - starts[v]));
      },
      kGrain);
  report_.open_vertices += std::count(links.begin(), links.end(), Link::kOpen);
  report_.non_manifold_vertices += std::count(links.begin(), links.end(), Link::kNonManifold);
}

ManifoldReport ManifoldCheck::finish() {
  add_vertices({});
  add_vertices({});
  if (report_.closed() && report_.manifold()) {
    // V - E + F = 2 (components - genus) with E = 3F/2.
    report_.genus = report_.components - (report_.vertices - report_.triangles / 2) / 2;
  }
  return report_;
}

std::uint32_t ManifoldCheck::root(std::uint32_t vertex) {
  const auto parent = [this](std::uint32_t v) -> std::uint32_t& { return parent_[v - window_first_]; };
  while (parent(vertex) != vertex) {
    parent(vertex) = parent(parent(vertex));
    vertex = parent(vertex);
  }
  return vertex;
}

void ManifoldCheck::unite(std::uint32_t a, std::uint32_t b) {
  const std::uint32_t root_a = root(a), root_b = root(b);
  // The lower number becomes the root. Later batches then hang below earlier ones, and paths stay short.
  if (root_a != root_b) parent_[std::max(root_a, root_b) - window_first_] = std::min(root_a, root_b);
}

}  // namespace astrolith
