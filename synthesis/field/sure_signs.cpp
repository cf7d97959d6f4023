// Finds at which points of a block the sign of F is certain, without a sum over all spheres at each point.
//
// An expansion of the metaballs about the centre of the points bounds s at each of them (level_expansion.h).
// The layers that need no projection on the surface are evaluated as always, and the later layers change the
// elevation by at most their bounds. What stays open is bounded again by expansions about smaller groups.
#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>

#include "synthesis/body/level_expansion.h"
#include "synthesis/field/content_bounds.h"
#include "synthesis/field/field_batch_internal.h"

namespace astrolith {
namespace {

// An expansion costs about as much as the evaluation of the spheres at this many points.
constexpr int kWorthExpansion = 24;

// Writes intervals middle[i] +- half[i] that hold s at the points.
ASTROLITH_SIMD_CLONES void bound_distances(const LevelExpansion& of, float floor, int n,
                                           const float* __restrict x, const float* __restrict y,
                                           const float* __restrict z, float* __restrict middle,
                                           float* __restrict half) {
  const LevelExpansion e = of;
  const float slope = math::sqrt(math::fma(
      e.gradient.x, e.gradient.x, math::fma(e.gradient.y, e.gradient.y, e.gradient.z * e.gradient.z)));
#pragma omp simd
  for (int i = 0; i < n; ++i) {
    const float dx = x[i] - e.center.x, dy = y[i] - e.center.y, dz = z[i] - e.center.z;
    const float squared = math::fma(dx, dx, math::fma(dy, dy, dz * dz));
    const float linear =
        math::fma(e.gradient.x, dx, math::fma(e.gradient.y, dy, math::fma(e.gradient.z, dz, e.level)));
    const float low = linear - math::fma(e.below, squared, e.slack);
    const float high = linear + math::fma(e.above, squared, e.slack);
    const float turn = math::fma(e.turn, math::sqrt(squared), e.turn_slack);
    const float steepest = slope + turn, flattest = math::max(slope - turn, 0.0f);
    const float most = math::sqrt(math::fma(steepest, steepest, floor)) * (1.0f + 1e-5f);
    const float least = math::sqrt(math::fma(flattest, flattest, floor)) * (1.0f - 1e-5f);
    const float s_low = low / (low > 0.0f ? most : least), s_high = high / (high > 0.0f ? least : most);
    middle[i] = 0.5f * (s_low + s_high);
    half[i] = math::fma(0.5f + 1e-5f, s_high - s_low, 2e-6f * math::abs(middle[i]));
  }
}

// Whether a layer depends on the projections of points on the bare surface, which are not found here.
bool stands_on_body(const FieldLayer& layer) { return noise_traits(layer.noise).on_surface; }

// Writes the signs of middle[i] + elevation[i] that are certain if the sum may err by half[i] + rest, else 0.
ASTROLITH_SIMD_CLONES void decide_signs(int n, const float* __restrict middle, const float* __restrict half,
                                        const float* __restrict elevation, float rest,
                                        std::int32_t* __restrict sign) {
#pragma omp simd
  for (int i = 0; i < n; ++i) {
    const float f = middle[i] + elevation[i];
    const float rounding = 1e-6f * (math::abs(middle[i]) + math::abs(elevation[i]));
    const float doubt = half[i] + rest + rounding;
    sign[i] = f > doubt ? 1 : f < -doubt ? -1 : 0;
  }
}

// The least and the largest of n coordinates.
ASTROLITH_SIMD_CLONES void find_range(int n, const float* c, float& least, float& largest) {
  float low = c[0], high = c[0];
#pragma omp simd reduction(min : low) reduction(max : high)
  for (int i = 0; i < n; ++i) {
    low = c[i] < low ? c[i] : low;
    high = c[i] > high ? c[i] : high;
  }
  least = low;
  largest = high;
}

Box box_around(int n, const PointArrays& at) {
  Vec3f low, high;
  find_range(n, at.x, low.x, high.x);
  find_range(n, at.y, low.y, high.y);
  find_range(n, at.z, low.z, high.z);
  return {{low.x, low.y, low.z}, {high.x, high.y, high.z}};
}

// Some points of a batch whose signs are open, and what is known of them.
struct OpenPoints {
  int n = 0;
  float rest = 0.0f;  // the most by which all later layers can change an elevation, length units
  BatchPoints at;
  std::array<int, kBatch> number;          // their numbers in the batch
  std::array<float, kBatch> middle, half;  // bounds of s
  std::array<float, kBatch> elevation;     // the elevations by the layers so far

  // Makes point `from` the point `to`.
  void move(std::size_t from, std::size_t to) {
    number[to] = number[from];
    at.move(from, to);
    for (auto* a : {&middle, &half, &elevation}) (*a)[to] = (*a)[from];
  }
};

class SignFinder {
 public:
  SignFinder(const FieldModel& model, const BatchLists& lists, float tolerance, std::int8_t* sign)
      : model_(model),
        lists_(lists),
        metaballs_{model.tables.leaf(0).metaballs,
                   {lists.metaballs.spheres + lists.metaballs.first[0],
                    lists.metaballs.first[1] - lists.metaballs.first[0]}},
        tolerance_(tolerance),
        sign_(sign) {}

  void find(int n, const PointArrays& at) {
    OpenPoints open;
    open.n = n;
    std::iota(open.number.begin(), open.number.begin() + n, 0);
    open.at.copy(n, at);
    leave_out_boulders(at, open);
    if (open.n == 0 || !bound(open)) return;
    decide(open);
    add_layers(open);
    split(open, 2);
  }

 private:
  // Nothing is said about points that boulders reach.
  void leave_out_boulders(const PointArrays& at, OpenPoints& open) const {
    const std::vector<std::uint32_t> boulders = boulders_around(model_, open.n, at);
    if (boulders.empty()) return;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(open.n); ++i) {
      if (!is_reached(model_, boulders, open.at.x[i], open.at.y[i], open.at.z[i])) open.move(i, kept++);
    }
    open.n = static_cast<int>(kept);
  }

  // Bounds s at the points by one expansion, and the elevations where no layer has been evaluated. Returns
  // false where there is none.
  bool bound(OpenPoints& open) const {
    const Box box = box_around(open.n, open.at.arrays());
    const std::optional<LevelExpansion> expansion = expand_level(metaballs_, box);
    if (!expansion) return false;
    bound_distances(*expansion, metaballs_.parameters.gradient_floor, open.n, open.at.x.data(),
                    open.at.y.data(), open.at.z.data(), open.middle.data(), open.half.data());
    if (num_evaluated_ == 0) bound_layers(*expansion, box, open);
    return true;
  }

  // Bounds the elevations at all points by those over their box.
  void bound_layers(const LevelExpansion& expansion, const Box& box, OpenPoints& open) const {
    Interval over;
    if (!model_.layers.empty()) {
      const ExpansionBounds bounds = bound_expansion(expansion, metaballs_.parameters, box);
      const Box projected = projected_box(expansion, bounds, metaballs_.parameters, box,
                                          model_.height_bound * (1.0 + kHeightSlack));
      over = elevations_over(model_, lists_.spots, box, projected);
    }
    std::fill_n(open.elevation.data(), open.n, static_cast<float>(0.5 * (over.low + over.high)));
    open.rest = static_cast<float>((0.5 + 1e-6) * (over.high - over.low));
  }

  // Sets the signs of the points that are certain, and drops these points. Calls moved(from, to) for the
  // others.
  template <typename Moved>
  void decide(OpenPoints& open, const Moved& moved) const {
    std::array<std::int32_t, kBatch> signs;
    decide_signs(open.n, open.middle.data(), open.half.data(), open.elevation.data(), open.rest,
                 signs.data());
    std::size_t kept = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(open.n); ++i) {
      if (signs[i] != 0) {
        sign_[open.number[i]] = static_cast<std::int8_t>(signs[i]);
        continue;
      }
      if (i != kept) {
        open.move(i, kept);
        moved(i, kept);
      }
      ++kept;
    }
    open.n = static_cast<int>(kept);
  }
  void decide(OpenPoints& open) const {
    decide(open, [](std::size_t, std::size_t) {});
  }

  // Evaluates the layers at the points, up to the first layer that stands on the body. Craters change the
  // elevation without a bound of the change, so that no layer before them tells anything.
  void add_layers(OpenPoints& open) {
    const bool bounded = !model_.layers.empty() &&
                         model_.layers.front().join.remaining_change < std::numeric_limits<float>::max();
    if (open.n == 0 || !bounded || stands_on_body(model_.layers.front())) return;
    Batch b;
    b.body.at = open.at;
    std::fill_n(b.elevation.data(), open.n, 0.0f);
    b.kept.resize(model_.num_kept_heights);
    for (std::size_t l = 0; l < model_.layers.size() && open.n > 0; ++l) {
      if (stands_on_body(model_.layers[l])) return;
      b.n = open.n;
      b.spots = find_spots(lists_.spots, l);
      apply_layer(model_, model_.layers[l], b);
      ++num_evaluated_;
      open.rest = l + 1 < model_.layers.size() ? model_.layers[l + 1].join.remaining_change : 0.0f;
      std::copy_n(b.elevation.data(), open.n, open.elevation.data());
      decide(open, [&](std::size_t from, std::size_t to) {
        b.body.at.move(from, to);
        b.elevation[to] = b.elevation[from];
        if (b.is_displaced) b.displacement.move(from, to);
        for (auto& heights : b.kept) heights[to] = heights[from];
      });
    }
  }

  // Bounds s again for the groups of points in the octants of their box, where that is worth it.
  void split(const OpenPoints& open, int depth) const {
    if (depth == 0 || open.n < kWorthExpansion) return;
    const float widest = *std::max_element(open.half.begin(), open.half.begin() + open.n);
    if (!(widest > tolerance_ + 0.5f * open.rest)) return;
    const Vec3f c = to_float(box_around(open.n, open.at.arrays()).center());
    std::array<std::uint8_t, kBatch> octant;
    std::array<int, 8> count{};
    for (std::size_t i = 0; i < static_cast<std::size_t>(open.n); ++i) {
      octant[i] = static_cast<std::uint8_t>((open.at.x[i] > c.x ? 1 : 0) | (open.at.y[i] > c.y ? 2 : 0) |
                                            (open.at.z[i] > c.z ? 4 : 0));
      ++count[octant[i]];
    }
    OpenPoints group;
    group.rest = open.rest;
    for (std::uint8_t k = 0; k < 8; ++k) {
      if (count[k] < kWorthExpansion) continue;
      group.n = 0;
      for (std::size_t i = 0; i < static_cast<std::size_t>(open.n); ++i) {
        if (octant[i] != k) continue;
        const auto to = static_cast<std::size_t>(group.n++);
        group.number[to] = open.number[i];
        group.at.x[to] = open.at.x[i], group.at.y[to] = open.at.y[i], group.at.z[to] = open.at.z[i];
        group.elevation[to] = open.elevation[i];
      }
      if (!bound(group)) continue;
      decide(group);
      split(group, depth - 1);
    }
  }

  const FieldModel& model_;
  const BatchLists& lists_;
  MetaballsView metaballs_;
  float tolerance_;
  std::int8_t* sign_;
  std::size_t num_evaluated_ = 0;  // layers that have been evaluated
};

}  // namespace

void find_sure_signs(const FieldModel& model, const BatchLists& lists, int n, const PointArrays& at,
                     float tolerance, std::int8_t* sign) {
  std::fill_n(sign, n, std::int8_t{0});
  if (!model.body.plain() || model.tables.leaf(0).warped || model.patch) return;
  SignFinder(model, lists, tolerance, sign).find(n, at);
}

}  // namespace astrolith
