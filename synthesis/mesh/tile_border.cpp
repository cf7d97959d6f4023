#include "synthesis/mesh/tile_border.h"

#include <algorithm>
#include <bit>

#include "numerics/files/sha256.h"

namespace astrolith {
namespace {

using Word = std::vector<std::uint64_t>;

// Turns the word so that it becomes the least of its rotations (two candidates; linear time).
void rotate_to_least(Word& word) {
  const std::size_t n = word.size();
  std::size_t a = 0, b = 1, length = 0;
  while (a < n && b < n && length < n) {
    const std::uint64_t at_a = word[(a + length) % n], at_b = word[(b + length) % n];
    if (at_a == at_b) {
      ++length;
      continue;
    }
    (at_a > at_b ? a : b) += length + 1;
    if (a == b) ++b;
    length = 0;
  }
  std::rotate(word.begin(), word.begin() + static_cast<std::ptrdiff_t>(std::min(a, b)), word.end());
}

std::string hash_loops(float z, const std::vector<Word>& loops) {
  Sha256 hash;
  hash.update(&z, sizeof z);
  for (const Word& loop : loops) {
    const std::uint64_t size = loop.size();
    hash.update(&size, sizeof size);
    hash.update(loop.data(), loop.size() * sizeof loop[0]);
  }
  return hash.hex();
}

}  // namespace

void PlaneEdges::add_vertices(std::uint32_t first, std::span<const MeshVertex> vertices) {
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vec3f& p = vertices[i].position;
    if (p.z == z_) vertices_.push_back({first + static_cast<std::uint32_t>(i), p.x, p.y});
  }
}

bool PlaneEdges::holds(std::uint32_t vertex) const {
  if (vertices_.empty() || vertex < vertices_.front().number || vertex > vertices_.back().number)
    return false;
  return std::binary_search(vertices_.begin(), vertices_.end(), PlaneVertex{vertex, 0.0f, 0.0f},
                            [](const PlaneVertex& a, const PlaneVertex& b) { return a.number < b.number; });
}

void PlaneEdges::add_triangle(const Triangle& triangle) {
  const bool in_plane[] = {holds(triangle[0]), holds(triangle[1]), holds(triangle[2])};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    if (!in_plane[k] || !in_plane[next]) continue;
    edges_.push_back(is_lower_ ? Edge{triangle[next], triangle[k]} : Edge{triangle[k], triangle[next]});
  }
}

// Leaves the edges of one triangle, sorted. False where an edge has three triangles, or two on one side.
bool PlaneEdges::keep_open_edges() {
  const auto unordered = [](const Edge& e) { return Edge{std::min(e[0], e[1]), std::max(e[0], e[1])}; };
  std::sort(edges_.begin(), edges_.end(),
            [&](const Edge& a, const Edge& b) { return unordered(a) < unordered(b); });
  std::vector<Edge> open;
  for (std::size_t first = 0, end = 0; first < edges_.size(); first = end) {
    while (end < edges_.size() && unordered(edges_[end]) == unordered(edges_[first])) ++end;
    if (end - first == 1) {
      open.push_back(edges_[first]);
    } else if (end - first > 2 || edges_[first] == edges_[first + 1]) {
      return false;
    }
  }
  std::sort(open.begin(), open.end());
  edges_ = std::move(open);
  return true;
}

std::uint64_t PlaneEdges::plane_place(std::uint32_t vertex) const {
  const auto found =
      std::lower_bound(vertices_.begin(), vertices_.end(), vertex,
                       [](const PlaneVertex& v, std::uint32_t number) { return v.number < number; });
  return std::uint64_t{std::bit_cast<std::uint32_t>(found->y)} << 32 | std::bit_cast<std::uint32_t>(found->x);
}

// The loops of the open edges in their canonical order; nothing where some edge is on no loop.
std::vector<PlaneEdges::Loop> PlaneEdges::loops() const {
  std::vector<Loop> loops;
  std::vector<char> passed(edges_.size(), 0);
  for (std::size_t start = 0; start < edges_.size(); ++start) {
    if (passed[start] != 0) continue;
    if (start > 0 && edges_[start][0] == edges_[start - 1][0]) return {};
    Loop loop;
    std::size_t at = start;
    while (passed[at] == 0) {
      passed[at] = 1;
      const auto [from, to] = edges_[at];
      loop.push_back(plane_place(from));
      at = static_cast<std::size_t>(std::lower_bound(edges_.begin(), edges_.end(), Edge{to, 0}) -
                                    edges_.begin());
      if (at == edges_.size() || edges_[at][0] != to) return {};
    }
    if (at != start) return {};
    rotate_to_least(loop);
    loops.push_back(std::move(loop));
  }
  std::sort(loops.begin(), loops.end());
  return loops;
}

std::optional<TileSide> PlaneEdges::side() {
  if (!keep_open_edges()) return std::nullopt;
  const std::vector<Loop> all = loops();
  if (all.empty() && !edges_.empty()) return std::nullopt;
  return TileSide{z_, static_cast<std::int64_t>(edges_.size()), static_cast<std::int64_t>(all.size()),
                  hash_loops(z_, all)};
}

TileBorder::TileBorder(std::optional<float> lower, std::optional<float> upper) {
  if (lower) lower_.emplace(*lower, true);
  if (upper) upper_.emplace(*upper, false);
}

void TileBorder::add_vertices(std::span<const MeshVertex> vertices) {
  const auto first = static_cast<std::uint32_t>(figures_.vertices);
  if (lower_) lower_->add_vertices(first, vertices);
  if (upper_) upper_->add_vertices(first, vertices);
  first_ += static_cast<std::uint32_t>(before_.size());
  before_.swap(now_);
  now_.clear();
  for (const MeshVertex& v : vertices) now_.push_back(v.position);
  figures_.vertices += static_cast<std::int64_t>(vertices.size());
}

void TileBorder::add_triangles(std::span<const Triangle> triangles) {
  const auto now_first = first_ + static_cast<std::uint32_t>(before_.size());
  const auto position = [&](std::uint32_t v) {
    const Vec3f& p = v < now_first ? before_[v - first_] : now_[v - now_first];
    return Vec3d{p.x, p.y, p.z};
  };
  for (const Triangle& t : triangles) {
    if (lower_) lower_->add_triangle(t);
    if (upper_) upper_->add_triangle(t);
    late_ = late_ || std::min({t[0], t[1], t[2]}) < first_;
    if (!late_) figures_.volume += dot(position(t[0]), cross(position(t[1]), position(t[2]))) / 6.0;
  }
  figures_.triangles += static_cast<std::int64_t>(triangles.size());
}

std::optional<TileFigures> TileBorder::figures() {
  if (late_) return std::nullopt;
  if (lower_) figures_.lower = lower_->side();
  if (upper_) figures_.upper = upper_->side();
  if (lower_.has_value() != figures_.lower.has_value() || upper_.has_value() != figures_.upper.has_value())
    return std::nullopt;
  return figures_;
}

}  // namespace astrolith
