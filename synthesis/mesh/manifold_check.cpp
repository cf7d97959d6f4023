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
LinkKind link_kind(std::span<Edge> edges) {
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
  settle_before();
  forget_components_below(last_.first);
  std::swap(before_, last_);
  last_.first = end_;
  end_ += static_cast<std::uint32_t>(vertices.size());
  last_.links.resize(vertices.size());
  last_.counts.assign(vertices.size(), 0);
  const auto known = static_cast<std::ptrdiff_t>(parent_.size());
  parent_.resize(end_ - before_.first);
  std::iota(parent_.begin() + known, parent_.end(), last_.first);
  report_.vertices += static_cast<std::int64_t>(vertices.size());
}

// Counts the components that end below vertex `first`. Each other component gets its lowest remaining vertex
// as its root.
void ManifoldCheck::forget_components_below(std::uint32_t first) {
  std::vector<std::uint32_t> lowest(parent_.size(), end_);  // lowest remaining vertex, by root
  std::vector<std::uint32_t> kept;
  for (std::uint32_t v = first; v < end_; ++v) {
    std::uint32_t& low = lowest[root(v) - before_.first];
    low = std::min(low, v);
    kept.push_back(low);
  }
  for (std::uint32_t v = before_.first; v < end_; ++v) {
    const bool is_root = parent_[v - before_.first] == v;
    report_.components += is_root && lowest[v - before_.first] == end_ ? 1 : 0;
  }
  parent_ = std::move(kept);
}

void ManifoldCheck::add_triangles(std::span<const Triangle> triangles) {
  extend_links(split_into_chunks(triangles));
  report_.triangles += static_cast<std::int64_t>(triangles.size());
}

// Cuts triangles into chunks, which a thread can pass over where they name none of its vertices.
std::vector<ManifoldCheck::Chunk> ManifoldCheck::split_into_chunks(
    std::span<const Triangle> triangles) const {
  constexpr std::size_t kChunk = 1024;
  std::vector<Chunk> chunks((triangles.size() + kChunk - 1) / kChunk);
  constexpr std::int64_t kGrain = 8;
  parallel_for(
      0, static_cast<std::int64_t>(chunks.size()),
      [&](std::int64_t i) {
        const std::size_t first = static_cast<std::size_t>(i) * kChunk;
        Chunk chunk{triangles.subspan(first, std::min(kChunk, triangles.size() - first)), end_, 0};
        for (const auto& [a, b, c] : chunk.triangles) {
          chunk.least = std::min({chunk.least, a, b, c});
          chunk.greatest = std::max({chunk.greatest, a, b, c});
        }
        if (chunk.greatest >= end_) throw WorkError("mesh: a triangle names a vertex not yet given");
        chunks[static_cast<std::size_t>(i)] = chunk;
      },
      kGrain);
  return chunks;
}

// Each thread extends the links of a range of vertices of its own, while another one unites components.
void ManifoldCheck::extend_links(const std::vector<Chunk>& chunks) {
  if (chunks.empty()) return;
  std::uint32_t least = end_;
  for (const Chunk& chunk : chunks) least = std::min(least, chunk.least);
  least = std::max(least, before_.first);
  constexpr std::uint32_t kLeastRange = 4096;
  const std::uint32_t count =
      std::clamp((end_ - least) / kLeastRange, 1u, 2 * static_cast<std::uint32_t>(thread_limit()));
  std::vector<Range> ranges(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto bound = [&](std::uint32_t k) {
      return least + static_cast<std::uint32_t>(std::uint64_t{end_ - least} * k / count);
    };
    ranges[i] = {bound(i), bound(i + 1), {}};
  }
  parallel_for(-1, std::int64_t{count}, [&](std::int64_t i) {
    if (i < 0) return unite_corners(chunks);
    extend_range_links(ranges[static_cast<std::size_t>(i)], chunks);
  });
  for (const Range& range : ranges) others_.insert(others_.end(), range.others.begin(), range.others.end());
}

void ManifoldCheck::extend_range_links(Range& range, const std::vector<Chunk>& chunks) {
  for (const Chunk& chunk : chunks) {
    if (chunk.greatest < range.first || chunk.least >= range.end) continue;
    const bool whole = chunk.least >= range.first && chunk.greatest < range.end;
    for (const Triangle& t : chunk.triangles) {
      if (!whole && is_late(t)) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        if (!whole && (t[k] < range.first || t[k] >= range.end)) continue;
        add_to_link(t[k], {t[(k + 1) % 3], t[(k + 2) % 3]}, range.others);
      }
    }
  }
}

void ManifoldCheck::add_to_link(std::uint32_t vertex, OppositeEdge edge, std::vector<OtherEdge>& others) {
  Batch& batch = vertex < last_.first ? before_ : last_;
  const std::size_t at = vertex - batch.first;
  const std::uint32_t n = batch.counts[at]++;
  if (n < batch.links[at].edges.size()) {
    batch.links[at].edges[n] = edge;
  } else {
    others.push_back({vertex, edge});
  }
}

void ManifoldCheck::unite_corners(const std::vector<Chunk>& chunks) {
  for (const Chunk& chunk : chunks) {
    for (const Triangle& t : chunk.triangles) {
      if (chunk.least < before_.first && is_late(t)) {
        ++report_.late_triangles;
        continue;
      }
      unite(t[0], t[1]);
      unite(t[1], t[2]);
    }
  }
}

// Judges the links of the batch before the last, whose triangles have all come.
void ManifoldCheck::settle_before() {
  std::stable_sort(others_.begin(), others_.end(),
                   [](const OtherEdge& a, const OtherEdge& b) { return a.vertex < b.vertex; });
  const auto judge = [&](std::size_t at) {
    const std::size_t n = before_.counts[at], most = before_.links[at].edges.size();
    if (n <= most) return link_kind(std::span(before_.links[at].edges).first(n));
    std::vector<Edge> all(before_.links[at].edges.begin(), before_.links[at].edges.end());
    const auto vertex = static_cast<std::uint32_t>(before_.first + at);
    auto other = std::lower_bound(others_.begin(), others_.end(), vertex,
                                  [](const OtherEdge& o, std::uint32_t v) { return o.vertex < v; });
    for (; other != others_.end() && other->vertex == vertex; ++other) all.push_back(other->edge);
    return link_kind(std::span(all));
  };
  std::vector<LinkKind> kinds(before_.counts.size());
  constexpr std::int64_t kGrain = 1024;
  parallel_for(
      0, static_cast<std::int64_t>(kinds.size()),
      [&](std::int64_t i) { kinds[static_cast<std::size_t>(i)] = judge(static_cast<std::size_t>(i)); },
      kGrain);
  report_.open_vertices += std::count(kinds.begin(), kinds.end(), LinkKind::kOpen);
  report_.non_manifold_vertices += std::count(kinds.begin(), kinds.end(), LinkKind::kNonManifold);
  std::erase_if(others_, [this](const OtherEdge& o) { return o.vertex < last_.first; });
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
  const auto parent = [this](std::uint32_t v) -> std::uint32_t& { return parent_[v - before_.first]; };
  while (parent(vertex) != vertex) {
    parent(vertex) = parent(parent(vertex));
    vertex = parent(vertex);
  }
  return vertex;
}

void ManifoldCheck::unite(std::uint32_t a, std::uint32_t b) {
  if (parent_[a - before_.first] == parent_[b - before_.first]) return;
  const std::uint32_t root_a = root(a), root_b = root(b);
  // The lower number becomes the root. Later batches then hang below earlier ones, and paths stay short.
  if (root_a != root_b) parent_[std::max(root_a, root_b) - before_.first] = std::min(root_a, root_b);
}

}  // namespace astrolith
