#include "synthesis/relief/relief_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "numerics/errors.h"
#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

// The lattice is searched in blocks of cells. A block gathers its metaballs once.
constexpr int kBlockNodes = 16;
constexpr int kCellNodes = 4;  // spacings along the edge of a cell

struct NodeRange {
  std::array<std::int64_t, 3> low, count;  // nodes of the lattice along each axis
};

// Values of s at a box of nodes, and the metaballs that reach it.
class BlockOfNodes {
 public:
  BlockOfNodes(const BodyGround& ground, double spacing, const std::array<std::int64_t, 3>& low, int nodes,
               int stride)
      : ground_(ground), spacing_(spacing), low_(low), nodes_(nodes), stride_(stride) {
    const Vec3d corner{at(0, 0), at(1, 0), at(2, 0)};
    const double side = spacing * stride * (nodes - 1);
    const Box box = widened(Box{corner, {corner.x + side, corner.y + side, corner.z + side}}, spacing);
    reaching_ = metaballs_reaching(ground.body, ground.arrays, ground.metaballs, box);
  }

  void evaluate(std::vector<float>& s) const {
    const auto total = static_cast<std::size_t>(nodes_) * nodes_ * nodes_;
    std::vector<float> x(total), y(total), z(total);
    std::size_t number = 0;
    for (int k = 0; k < nodes_; ++k) {
      for (int j = 0; j < nodes_; ++j) {
        for (int i = 0; i < nodes_; ++i, ++number) {
          x[number] = static_cast<float>(at(0, i));
          y[number] = static_cast<float>(at(1, j));
          z[number] = static_cast<float>(at(2, k));
        }
      }
    }
    s.resize(total);
    std::vector<float> gx(total), gy(total), gz(total);
    evaluate(total, x, y, z, s, gx, gy, gz);
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
  double spacing_;
  std::array<std::int64_t, 3> low_;
  int nodes_, stride_;
  ReachingMetaballs reaching_;
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
  PlaceFinder(const BodyGround& ground, double spacing) : ground_(ground), spacing_(spacing) {}

  std::vector<ReliefPlace> find(const NodeRange& blocks) const {
    const std::int64_t total = blocks.count[0] * blocks.count[1] * blocks.count[2];
    std::vector<std::vector<ReliefPlace>> found(static_cast<std::size_t>(total));
    parallel_for(0, total, [&](std::int64_t number) {
      const std::array<std::int64_t, 3> block{number % blocks.count[0],
                                              number / blocks.count[0] % blocks.count[1],
                                              number / (blocks.count[0] * blocks.count[1])};
      std::array<std::int64_t, 3> low;
      for (std::size_t a = 0; a < 3; ++a) low[a] = (blocks.low[a] + block[a]) * kBlockNodes;
      if (may_cross(low)) found[static_cast<std::size_t>(number)] = places_in(low);
    });
    std::vector<ReliefPlace> places;
    for (const std::vector<ReliefPlace>& of_block : found)
      places.insert(places.end(), of_block.begin(), of_block.end());
    std::sort(places.begin(), places.end(), [](const ReliefPlace& a, const ReliefPlace& b) {
      return std::tie(a.axis, a.v, a.u, a.w) < std::tie(b.axis, b.v, b.u, b.w);
    });
    return places;
  }

 private:
  // Whether the surface may pass through any cell of a block.
  bool may_cross(const std::array<std::int64_t, 3>& low) const {
    constexpr int kCorners = kBlockNodes / kCellNodes + 1;
    std::vector<float> s;
    BlockOfNodes(ground_, spacing_, low, kCorners, kCellNodes).evaluate(s);
    const auto corner = [&](int i, int j, int k) {
      return s[static_cast<std::size_t>(i + kCorners * (j + kCorners * k))] / static_cast<float>(spacing_);
    };
    for (int k = 0; k + 1 < kCorners; ++k) {
      for (int j = 0; j + 1 < kCorners; ++j) {
        for (int i = 0; i + 1 < kCorners; ++i) {
          std::array<float, 8> corners;
          for (int c = 0; c < 8; ++c) {
            corners[static_cast<std::size_t>(c)] = corner(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2));
          }
          if (may_hold_surface(corners)) return true;
        }
      }
    }
    return false;
  }

  // The places on edges of the lattice that begin in a block.
  std::vector<ReliefPlace> places_in(const std::array<std::int64_t, 3>& low) const {
    constexpr int kNodes = kBlockNodes + 1;
    const BlockOfNodes block(ground_, spacing_, low, kNodes, 1);
    std::vector<float> s;
    block.evaluate(s);
    const std::array<std::size_t, 3> step{1, kNodes, kNodes * kNodes};
    std::vector<Crossing> crossings;
    for (int k = 0; k < kBlockNodes; ++k) {
      for (int j = 0; j < kBlockNodes; ++j) {
        for (int i = 0; i < kBlockNodes; ++i) {
          const std::size_t node = static_cast<std::size_t>(i + kNodes * (j + kNodes * k));
          for (int a = 0; a < 3; ++a) {
            const float here = s[node], next = s[node + step[static_cast<std::size_t>(a)]];
            if ((here > 0.0f) == (next > 0.0f)) continue;
            crossings.push_back({a, {i, j, k}, here / (here - next)});
          }
        }
      }
    }
    return with_normals(low, block, crossings);
  }

  std::vector<ReliefPlace> with_normals(const std::array<std::int64_t, 3>& low, const BlockOfNodes& block,
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
      const std::uint16_t weight = weight_of(normal.x);
      if (weight == 0) continue;
      const auto node = [&](std::size_t axis) { return static_cast<std::int32_t>(low[axis] + c.node[axis]); };
      places.push_back({c.axis, node(u), node(v), static_cast<float>(node(a)) + c.share, normal, weight});
    }
    return places;
  }

  // ((n_a^2 - least) / (1 - least))^2 as a share of 65535.
  static std::uint16_t weight_of(float along) {
    const float over = (along * along - kLeastReliefSlant) / (1.0f - kLeastReliefSlant);
    const float share = over > 0.0f ? std::min(over * over, 1.0f) : 0.0f;
    return static_cast<std::uint16_t>(math::floor(math::fma(share, 65535.0f, 0.5f)));
  }

  const BodyGround& ground_;
  double spacing_;
};

}  // namespace

std::vector<ReliefPlace> find_relief_places(const BodyGround& ground, double spacing,
                                            const std::string& where) {
  const Box& box = ground.body.supports;
  if (box.empty()) return {};
  const double block = spacing * kBlockNodes;
  NodeRange blocks;
  double total = 1.0;
  const Vec3d low = box.min, high = box.max;
  const std::array<double, 3> lows{low.x, low.y, low.z}, highs{high.x, high.y, high.z};
  for (std::size_t a = 0; a < 3; ++a) {
    const double first = std::floor(lows[a] / block), last = std::floor(highs[a] / block);
    total *= last - first + 1.0;
    if (!(std::abs(first) < 1e6 && std::abs(last) < 1e6)) total = 1e30;
    if (total > 1e6) break;
    blocks.low[a] = static_cast<std::int64_t>(first);
    blocks.count[a] = static_cast<std::int64_t>(last - first) + 1;
  }
  const auto refuse = [&] {
    throw InputError(where +
                     ".spacing: would take more than 16 million heights on this body; make it larger");
  };
  if (total > 1e6) refuse();
  std::vector<ReliefPlace> places = PlaceFinder(ground, spacing).find(blocks);
  if (places.size() > kMostReliefPlaces) refuse();
  return places;
}

}  // namespace astrolith
