#include "synthesis/relief/relief_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <tuple>
#include <utility>

#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "synthesis/body/body_bounds.h"

namespace astrolith {
namespace {

// The lattice is searched in blocks of cells. A block gathers its metaballs once.
constexpr int kBlockNodes = 16;
constexpr int kCellNodes = 4;  // spacings along the edge of a cell
constexpr int kNodes = kBlockNodes + 1;

// A box of blocks, and the metaballs that reach it.
struct BlockBox {
  std::array<std::int64_t, 3> low, count;  // blocks along each axis
  ReachingMetaballs metaballs;

  bool is_block() const { return count[0] * count[1] * count[2] == 1; }
};

// The metaballs of leaves, as bounds of the body read them.
struct BoundedLists {
  LeafLists lists;
  MetaballList metaballs(std::uint32_t leaf) const {
    return {lists.spheres + lists.first[leaf], nullptr, lists.first[leaf + 1] - lists.first[leaf]};
  }
};

// Whether s keeps one sign over a box, which holds the points at which the metaballs are evaluated.
bool keeps_sign(const BodyGround& ground, const ReachingMetaballs& reaching, const Box& box) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const BoundedLists lists{reaching.lists()};
  std::vector<KernelInterval> scratch(reaching.spheres.size());
  if (ground.body.plain()) {
    const MetaballParameters<float>& leaf = ground.arrays[ground.body.leaves][0].metaballs;
    const MetaballInterval level = bound_metaballs(leaf, lists.metaballs(0), box, kInfinity, scratch.data());
    return level.level_max < 0.0 || level.level_min > 0.0;
  }
  const Interval s = bound_distance(ground.body, ground.arrays, lists, box, 0.0, scratch.data());
  return s.high < 0.0 || s.low > 0.0;
}

// Values of s at a box of nodes, and the metaballs that reach it.
class NodeBlock {
 public:
  NodeBlock(const BodyGround& ground, const ReachingMetaballs& reaching, double spacing,
            const std::array<std::int64_t, 3>& low, int nodes, int stride)
      : ground_(ground), reaching_(reaching), spacing_(spacing), low_(low), nodes_(nodes), stride_(stride) {}

  // The values at the nodes that are marked, x fastest; the others keep theirs.
  void evaluate(const std::vector<char>& marked, std::vector<float>& s) const {
    std::vector<float> x, y, z;
    std::vector<std::size_t> numbers;
    std::size_t number = 0;
    for (int k = 0; k < nodes_; ++k) {
      for (int j = 0; j < nodes_; ++j) {
        for (int i = 0; i < nodes_; ++i, ++number) {
          if (marked[number] == 0) continue;
          numbers.push_back(number);
          x.push_back(static_cast<float>(at(0, i)));
          y.push_back(static_cast<float>(at(1, j)));
          z.push_back(static_cast<float>(at(2, k)));
        }
      }
    }
    const std::size_t total = numbers.size();
    std::vector<float> values(total), gx(total), gy(total), gz(total);
    evaluate(total, x, y, z, values, gx, gy, gz);
    for (std::size_t i = 0; i < total; ++i) s[numbers[i]] = values[i];
  }
  void evaluate(std::size_t n, const std::vector<float>& x, const std::vector<float>& y,
                const std::vector<float>& z, std::vector<float>& s, std::vector<float>& gx,
                std::vector<float>& gy, std::vector<float>& gz) const {
    constexpr std::size_t kMost = 1024;  // points that the body is evaluated at together
    for (std::size_t i = 0; i < n; i += kMost) {
      const int count = static_cast<int>(std::min(kMost, n - i));
      evaluate_body(ground_.body, ground_.arrays, reaching_.lists(), count, x.data() + i, y.data() + i,
                    z.data() + i, s.data() + i, gx.data() + i, gy.data() + i, gz.data() + i);
    }
  }
  double at(int axis, int node) const {
    return static_cast<double>(low_[static_cast<std::size_t>(axis)] + std::int64_t{stride_} * node) *
           spacing_;
  }

 private:
  const BodyGround& ground_;
  const ReachingMetaballs& reaching_;
  double spacing_;
  std::array<std::int64_t, 3> low_;
  int nodes_, stride_;
};

// Whether the surface may pass through a cell whose corners have these values of s, in spacings.
bool may_hold_surface(const std::array<float, 8>& s) {
  constexpr float kDiagonal = 1.7321f * kCellNodes;
  const auto [least, most] = std::minmax_element(s.begin(), s.end());
  if (*least <= 0.0f && *most >= 0.0f) return true;
  return std::min(std::abs(*least), std::abs(*most)) <= kDiagonal;
}

// Where an edge of the lattice crosses the surface: the edge begins at the node, along the axis.
struct Crossing {
  int axis;
  std::array<std::int32_t, 3> node;
  float share;
};

class PlaceFinder {
 public:
  PlaceFinder(const BodyGround& ground, double spacing, const std::string& where)
      : ground_(ground), spacing_(spacing), where_(where) {}

  // Halves the boxes until those through which the surface may pass are blocks.
  std::vector<ReliefPlace> find(BlockBox root) const {
    constexpr std::size_t kMostBoxes = std::size_t{1} << 18;  // twice those of sixteen million heights
    std::vector<BlockBox> boxes{narrowed(std::move(root))};
    while (std::any_of(boxes.begin(), boxes.end(), [](const BlockBox& b) { return !b.is_block(); })) {
      std::vector<std::vector<BlockBox>> parts(boxes.size());
      parallel_for(0, static_cast<std::int64_t>(boxes.size()), [&](std::int64_t i) {
        parts[static_cast<std::size_t>(i)] = split(boxes[static_cast<std::size_t>(i)]);
      });
      boxes.clear();
      for (std::vector<BlockBox>& part : parts) {
        boxes.insert(boxes.end(), std::move_iterator(part.begin()), std::move_iterator(part.end()));
      }
      if (boxes.size() > kMostBoxes) refuse();
    }
    std::vector<std::vector<ReliefPlace>> found(boxes.size());
    parallel_for(0, static_cast<std::int64_t>(boxes.size()), [&](std::int64_t number) {
      const auto i = static_cast<std::size_t>(number);
      found[i] = places_in(boxes[i]);
    });
    return sorted(found);
  }

  [[noreturn]] void refuse() const {
    throw InputError(where_ +
                     ".spacing: would take more than 16 million heights on this body; make it larger");
  }

 private:
  // All places in their order. Those of an axis and v are gathered first.
  std::vector<ReliefPlace> sorted(std::vector<std::vector<ReliefPlace>>& found) const {
    std::int64_t low = std::numeric_limits<std::int64_t>::max(), high = -low;
    std::size_t total = 0;
    for (const std::vector<ReliefPlace>& block_places : found) {
      total += block_places.size();
      for (const ReliefPlace& p : block_places) {
        low = std::min<std::int64_t>(low, p.v), high = std::max<std::int64_t>(high, p.v);
      }
    }
    if (total == 0) return {};
    if (total > kMostReliefPlaces) refuse();
    const auto row = [&](const ReliefPlace& p) {
      return static_cast<std::size_t>(p.axis * (high - low + 1) + p.v - low);
    };
    std::vector<std::size_t> first(3 * static_cast<std::size_t>(high - low + 1) + 1, 0);
    for (const std::vector<ReliefPlace>& block_places : found) {
      for (const ReliefPlace& p : block_places) ++first[row(p) + 1];
    }
    for (std::size_t i = 0; i + 1 < first.size(); ++i) first[i + 1] += first[i];
    std::vector<ReliefPlace> places(total);
    std::vector<std::size_t> next(first.begin(), first.end() - 1);
    for (std::vector<ReliefPlace>& block_places : found) {
      for (const ReliefPlace& p : block_places) places[next[row(p)]++] = p;
      std::vector<ReliefPlace>().swap(block_places);
    }
    parallel_for(0, static_cast<std::int64_t>(first.size()) - 1, [&](std::int64_t number) {
      const auto at = [&](std::size_t i) { return places.begin() + static_cast<std::ptrdiff_t>(first[i]); };
      const auto i = static_cast<std::size_t>(number);
      std::sort(at(i), at(i + 1), [](const ReliefPlace& a, const ReliefPlace& b) {
        return std::tie(a.u, a.w) < std::tie(b.u, b.w);
      });
    });
    return places;
  }

  // The box of the nodes of blocks, widened by a spacing.
  Box node_box(const BlockBox& blocks) const {
    const auto at = [&](std::int64_t block) { return static_cast<double>(block * kBlockNodes) * spacing_; };
    const auto& [low, count, metaballs] = blocks;
    return widened(Box{{at(low[0]), at(low[1]), at(low[2])},
                       {at(low[0] + count[0]), at(low[1] + count[1]), at(low[2] + count[2])}},
                   spacing_);
  }
  BlockBox narrowed(BlockBox blocks) const {
    blocks.metaballs =
        metaballs_reaching(ground_.body, ground_.arrays, blocks.metaballs.lists(), node_box(blocks));
    return blocks;
  }

  // The halves of a box along its longest side through which the surface may pass; a block itself.
  std::vector<BlockBox> split(const BlockBox& blocks) const {
    if (blocks.is_block()) return {blocks};
    const auto axis = static_cast<std::size_t>(std::max_element(blocks.count.begin(), blocks.count.end()) -
                                               blocks.count.begin());
    const std::int64_t half = blocks.count[axis] / 2;
    std::vector<BlockBox> parts;
    for (const bool upper : {false, true}) {
      BlockBox part = blocks;
      part.count[axis] = upper ? blocks.count[axis] - half : half;
      part.low[axis] += upper ? half : 0;
      part = narrowed(std::move(part));
      if (!keeps_sign(ground_, part.metaballs, node_box(part))) parts.push_back(std::move(part));
    }
    return parts;
  }

  static std::array<std::int64_t, 3> first_node(const BlockBox& block) {
    return {block.low[0] * kBlockNodes, block.low[1] * kBlockNodes, block.low[2] * kBlockNodes};
  }

  // Marks the nodes of the cells of a block through which the surface may pass. Returns whether there are
  // any.
  bool mark_nodes(const BlockBox& block, std::vector<char>& marked) const {
    constexpr int kCells = kBlockNodes / kCellNodes, kCorners = kCells + 1;
    std::vector<float> s(kCorners * kCorners * kCorners);
    NodeBlock(ground_, block.metaballs, spacing_, first_node(block), kCorners, kCellNodes)
        .evaluate(std::vector<char>(s.size(), 1), s);
    bool any = false;
    for (int cell = 0; cell < kCells * kCells * kCells; ++cell) {
      const int i = cell % kCells, j = cell / kCells % kCells, k = cell / (kCells * kCells);
      std::array<float, 8> corners;
      for (int c = 0; c < 8; ++c) {
        const int corner = i + (c & 1) + kCorners * (j + (c >> 1 & 1) + kCorners * (k + (c >> 2)));
        corners[static_cast<std::size_t>(c)] =
            s[static_cast<std::size_t>(corner)] / static_cast<float>(spacing_);
      }
      if (!may_hold_surface(corners)) continue;
      any = true;
      for (int w = kCellNodes * k; w <= kCellNodes * (k + 1); ++w) {
        for (int v = kCellNodes * j; v <= kCellNodes * (j + 1); ++v) {
          const auto first = static_cast<std::ptrdiff_t>(kCellNodes * i + kNodes * (v + kNodes * w));
          std::fill_n(marked.begin() + first, kCellNodes + 1, char{1});
        }
      }
    }
    return any;
  }

  // The places on edges of the lattice that begin in a block.
  std::vector<ReliefPlace> places_in(const BlockBox& block_box) const {
    constexpr std::size_t kAll = std::size_t{kNodes} * kNodes * kNodes;
    std::vector<char> marked(kAll, 0);
    if (!mark_nodes(block_box, marked)) return {};
    const std::array<std::int64_t, 3> low = first_node(block_box);
    const NodeBlock block(ground_, block_box.metaballs, spacing_, low, kNodes, 1);
    std::vector<float> s(kAll);
    block.evaluate(marked, s);
    constexpr std::array<std::size_t, 3> kStep{1, kNodes, kNodes * kNodes};
    std::vector<Crossing> crossings;
    for (int k = 0; k < kBlockNodes; ++k) {
      for (int j = 0; j < kBlockNodes; ++j) {
        for (int i = 0; i < kBlockNodes; ++i) {
          const std::size_t node = static_cast<std::size_t>(i + kNodes * (j + kNodes * k));
          if (marked[node] == 0) continue;
          for (int a = 0; a < 3; ++a) {
            const std::size_t after = node + kStep[static_cast<std::size_t>(a)];
            const float here = s[node], next = s[after];
            if (marked[after] == 0 || (here > 0.0f) == (next > 0.0f)) continue;
            crossings.push_back({a, {i, j, k}, here / (here - next)});
          }
        }
      }
    }
    return with_normals(low, block, crossings);
  }

  std::vector<ReliefPlace> with_normals(const std::array<std::int64_t, 3>& low, const NodeBlock& block,
                                        const std::vector<Crossing>& crossings) const {
    const std::size_t n = crossings.size();
    std::array<std::vector<float>, 3> p, g;
    for (int a = 0; a < 3; ++a) {
      auto& coordinate = p[static_cast<std::size_t>(a)];
      coordinate.resize(n);
      g[static_cast<std::size_t>(a)].resize(n);
      for (std::size_t i = 0; i < n; ++i) {
        const Crossing& c = crossings[i];
        const double along = c.axis == a ? double{c.share} * spacing_ : 0.0;
        coordinate[i] = static_cast<float>(block.at(a, c.node[static_cast<std::size_t>(a)]) + along);
      }
    }
    std::vector<float> s(n);
    block.evaluate(n, p[0], p[1], p[2], s, g[0], g[1], g[2]);
    std::vector<ReliefPlace> places;
    for (std::size_t i = 0; i < n; ++i) {
      const Crossing& c = crossings[i];
      const auto a = static_cast<std::size_t>(c.axis), u = (a + 1) % 3, v = (a + 2) % 3;
      const float length =
          math::sqrt(math::fma(g[0][i], g[0][i], math::fma(g[1][i], g[1][i], g[2][i] * g[2][i])));
      if (!(length > 0.0f)) continue;
      const Vec3f normal{-g[a][i] / length, -g[u][i] / length, -g[v][i] / length};
      const std::uint16_t weight = sheet_weight(normal.x);
      if (weight == 0) continue;
      const auto node = [&](std::size_t axis) { return static_cast<std::int32_t>(low[axis] + c.node[axis]); };
      places.push_back({c.axis, node(u), node(v), static_cast<float>(node(a)) + c.share, normal, weight});
    }
    return places;
  }

  // ((n_a^2 - least) / (1 - least))^2 as a share of 65535.
  static std::uint16_t sheet_weight(float along) {
    const float over = (along * along - kLeastReliefSlant) / (1.0f - kLeastReliefSlant);
    const float share = over > 0.0f ? std::min(over * over, 1.0f) : 0.0f;
    return static_cast<std::uint16_t>(math::floor(math::fma(share, 65535.0f, 0.5f)));
  }

  const BodyGround& ground_;
  double spacing_;
  const std::string& where_;
};

}  // namespace

std::vector<ReliefPlace> find_relief_places(const BodyGround& ground, double spacing,
                                            const std::string& where) {
  const Box& box = ground.body.supports;
  if (box.empty()) return {};
  const PlaceFinder finder(ground, spacing, where);
  const double block = spacing * kBlockNodes;
  BlockBox blocks;
  const std::array<double, 3> lows{box.min.x, box.min.y, box.min.z}, highs{box.max.x, box.max.y, box.max.z};
  for (std::size_t a = 0; a < 3; ++a) {
    const double first = std::floor(lows[a] / block), last = std::floor(highs[a] / block);
    if (!(std::abs(first) < 1e6 && std::abs(last) < 1e6)) finder.refuse();
    blocks.low[a] = static_cast<std::int64_t>(first);
    blocks.count[a] = static_cast<std::int64_t>(last - first) + 1;
  }
  for (std::uint32_t leaf = 0; leaf < ground.body.leaves.count; ++leaf) {
    const std::uint32_t first = ground.metaballs.first[leaf];
    blocks.metaballs.add({ground.metaballs.spheres + first, ground.metaballs.first[leaf + 1] - first});
  }
  return finder.find(std::move(blocks));
}

}  // namespace astrolith
