#include "synthesis/mesh/manifold_check.h"

#include <algorithm>
#include <numeric>

#include "numerics/errors.h"
#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

using Edge = ManifoldCheck::OppositeEdge;

enum class LinkKind : std::uint8_t { kCycle, kOpen, kNonManifold };

// The edge of a vertex's link that begins at vertex `from`; the end of the span where there is none. The
// edges are sorted by `from`.
auto edge_from(std::span<const Edge> edges, std::uint32_t from) {
  const auto edge = std::lower_bound(edges.begin(), edges.end(), from,
                                     [](const Edge& c, std::uint32_t f) { return c.from < f; });
  return edge != edges.end() && edge->from == from ? edge : edges.end();
}

// Whether an open link is one path, as around a vertex of a border. Two paths touch in their vertex only.
bool is_path(std::span<const Edge> edges) {
  std::vector<std::uint32_t> ends;
  for (const Edge& c : edges) ends.push_back(c.to);
  std::sort(ends.begin(), ends.end());
  auto edge = std::find_if(edges.begin(), edges.end(), [&](const Edge& c) {
    return !std::binary_search(ends.begin(), ends.end(), c.from);
  });
  std::size_t steps = 0;
  for (; edge != edges.end() && steps < edges.size(); ++steps) edge = edge_from(edges, edge->to);
  return edge == edges.end() && steps == edges.size();
}

// Whether the few edges of a link form one cycle, found without sorting them. Each step takes the first edge
// that begins where the last one ended, so that a walk which is back after as many steps as there are edges
// has taken each edge once.
bool is_short_cycle(std::span<const Edge> edges) {
  constexpr std::size_t kFew = 16;
  if (edges.size() > kFew) return false;
  std::size_t at = 0, steps = 0;
  do {
    const std::uint32_t to = edges[at].to;
    for (at = 0; at < edges.size() && edges[at].from != to;) ++at;
  } while (++steps < edges.size() && at != 0 && at < edges.size());
  return at == 0 && steps == edges.size();
}

// Finds out whether the directed edges (from, to) opposite a vertex form one cycle or one path. May sort them
// by `from`.
LinkKind kind_of_link(std::span<Edge> edges) {
  if (edges.empty()) return LinkKind::kNonManifold;
  if (is_short_cycle(std::span<const Edge>(edges))) return LinkKind::kCycle;
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.from < b.from; });
  for (std::size_t i = 1; i < edges.size(); ++i) {
    if (edges[i].from == edges[i - 1].from) return LinkKind::kNonManifold;
  }
  const std::span<const Edge> sorted = edges;
  auto edge = sorted.begin();
  for (std::size_t steps = 1; steps <= sorted.size(); ++steps) {
    edge = edge_from(sorted, edge->to);
    if (edge == sorted.end()) return is_path(sorted) ? LinkKind::kOpen : LinkKind::kNonManifold;
    if (edge == sorted.begin()) return steps == sorted.size() ? LinkKind::kCycle : LinkKind::kNonManifold;
  }
  return LinkKind::kNonManifold;
}

}  // namespace

void ManifoldCheck::add_vertices(std::span<const MeshVertex> vertices) {
  settle(batch_first_);
  forget_components_below(batch_first_);
  window_first_ = batch_first_;
  batch_first_ = end_;
  end_ += static_cast<std::uint32_t>(vertices.size());
  links_.resize(end_ - window_first_);
  counts_.resize(end_ - window_first_, 0);
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
    add_to_link(t[0], {t[1], t[2]});
    add_to_link(t[1], {t[2], t[0]});
    add_to_link(t[2], {t[0], t[1]});
    unite(t[0], t[1]);
    unite(t[1], t[2]);
  }
  report_.triangles += static_cast<std::int64_t>(triangles.size());
}

void ManifoldCheck::add_to_link(std::uint32_t vertex, OppositeEdge edge) {
  const std::size_t at = vertex - window_first_;
  const std::uint32_t n = counts_[at]++;
  if (n < links_[at].edges.size()) {
    links_[at].edges[n] = edge;
  } else {
    others_.push_back({vertex, edge});
  }
}

// Judges the links of the vertices below `end`, and drops them.
void ManifoldCheck::settle(std::uint32_t end) {
  std::stable_sort(others_.begin(), others_.end(),
                   [](const OtherEdge& a, const OtherEdge& b) { return a.vertex < b.vertex; });
  const auto judge = [&](std::size_t at) {
    const std::size_t n = counts_[at], most = links_[at].edges.size();
    if (n <= most) return kind_of_link(std::span(links_[at].edges).first(n));
    std::vector<Edge> all(links_[at].edges.begin(), links_[at].edges.end());
    const auto vertex = static_cast<std::uint32_t>(window_first_ + at);
    auto other = std::lower_bound(others_.begin(), others_.end(), vertex,
                                  [](const OtherEdge& o, std::uint32_t v) { return o.vertex < v; });
    for (; other != others_.end() && other->vertex == vertex; ++other) all.push_back(other->edge);
    return kind_of_link(std::span(all));
  };
  const std::size_t settled = end - window_first_;
  std::vector<LinkKind> kinds(settled);
  constexpr std::int64_t kGrain = 1024;
  parallel_for(
      0, static_cast<std::int64_t>(settled),
      [&](std::int64_t i) { kinds[static_cast<std::size_t>(i)] = judge(static_cast<std::size_t>(i)); },
      kGrain);
  report_.open_vertices += std::count(kinds.begin(), kinds.end(), LinkKind::kOpen);
  report_.non_manifold_vertices += std::count(kinds.begin(), kinds.end(), LinkKind::kNonManifold);
  const auto left = static_cast<std::ptrdiff_t>(settled);
  links_.erase(links_.begin(), links_.begin() + left);
  counts_.erase(counts_.begin(), counts_.begin() + left);
  std::erase_if(others_, [end](const OtherEdge& o) { return o.vertex < end; });
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
  if (parent_[a - window_first_] == parent_[b - window_first_]) return;
  const std::uint32_t root_a = root(a), root_b = root(b);
  // The lower number becomes the root. Later batches then hang below earlier ones, and paths stay short.
  if (root_a != root_b) parent_[std::max(root_a, root_b) - window_first_] = std::min(root_a, root_b);
}

}  // namespace astrolith
