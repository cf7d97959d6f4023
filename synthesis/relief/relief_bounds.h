// Bounds of the heights of a relief over a box, on the CPU and on a GPU.
//
// Over many cells they are those of the codes of the cells. In each of few cells a B-spline lies between its
// coefficients, and its slope between their differences, so that the height at the middle and the slopes
// give bounds that shrink with the box.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "numerics/interval.h"
#include "synthesis/relief/relief_noise.h"

namespace astrolith {

// The part of a box in a cell, in spacings from the corner of the cell.
struct ReliefPart {
  std::int32_t cell;
  Interval x, y, z;

  ASTROLITH_HD ReliefPoint middle() const {
    const auto of = [](const Interval& i) { return static_cast<float>(0.5 * (i.low + i.high)); };
    return {cell, of(x), of(y), of(z)};
  }
  // Its coordinates along an axis: u, v and w.
  struct Along {
    Interval u, v, w;
  };
  ASTROLITH_HD Along along(int axis) const {
    return axis == 0 ? Along{y, z, x} : axis == 1 ? Along{z, x, y} : Along{x, y, z};
  }
  ASTROLITH_HD double width() const {
    return std::max(x.high - x.low, std::max(y.high - y.low, z.high - z.low));
  }
};

// The tiles of an axis that points of a part read: two where a split passes through it, else the same twice.
struct ReliefTilePair {
  std::int32_t lower, upper;
};
ASTROLITH_HD inline ReliefTilePair part_tiles(std::int32_t tile, const ReliefSplit* splits,
                                              const ReliefPart::Along& part) {
  if (tile >= 0) return {tile, tile};
  const ReliefSplit& split = splits[-1 - tile];
  constexpr double kRounding = 1e-4;  // spacings
  const Interval by_u = scaled(split.slope_u, part.u), by_v = scaled(split.slope_v, part.v);
  const double low = split.at + by_u.low + by_v.low - kRounding,
               high = split.at + by_u.high + by_v.high + kRounding;
  return {part.w.low > high ? split.upper : split.lower, part.w.high < low ? split.lower : split.upper};
}

// Whether all points of a part belong to the sheet of a tile in full (sheet_reach).
ASTROLITH_HD inline bool reaches_part(const ReliefSheet& s, const ReliefPart::Along& part) {
  constexpr double kRounding = 1e-4;  // spacings
  const Interval by_u = scaled(s.slope_u, part.u), by_v = scaled(s.slope_v, part.v);
  const double low = part.w.low - (s.at + by_u.high + by_v.high),
               high = part.w.high - (s.at + by_u.low + by_v.low);
  return std::max(-low, high) + kRounding < s.farthest - 1.0 / s.inverse_fade;
}

// The places along one side of a tile that points in `at` read.
struct ReliefPlacesAlong {
  std::int32_t first, last;
};
ASTROLITH_HD inline ReliefPlacesAlong places_along(const Interval& at) {
  const auto first = [](double of) {
    return static_cast<std::int32_t>(clamped(std::floor(of), 0.0, static_cast<double>(kReliefCell - 1)));
  };
  return {first(at.low), first(at.high) + 3};
}

// The codes of the places with a weight that points read, and the least of all weights.
struct ReliefCodes {
  std::uint32_t least = 0xffff, greatest = 0, weight = 0xffff;
};
ASTROLITH_HD inline void extend_codes(const std::uint32_t* words, const Interval& u, const Interval& v,
                                      ReliefCodes& codes) {
  const ReliefPlacesAlong row = places_along(u), column = places_along(v);
  for (std::int32_t j = column.first; j <= column.last; ++j) {
    for (std::int32_t i = row.first; i <= row.last; ++i) {
      const std::uint32_t word = words[j * kReliefTileSide + i], weight = word >> 16, code = word & 0xffffu;
      codes.weight = weight < codes.weight ? weight : codes.weight;
      if (weight == 0) continue;
      codes.least = code < codes.least ? code : codes.least;
      codes.greatest = code > codes.greatest ? code : codes.greatest;
    }
  }
}

// A bound of how the sum of word_value(word) over a tile changes from the middle of a part on.
template <class WordValue>
ASTROLITH_HD double sum_change(const std::uint32_t* words, const Interval& u, const Interval& v,
                               const WordValue& word_value) {
  const ReliefPlacesAlong row = places_along(u), column = places_along(v);
  const auto at = [&](std::int32_t i, std::int32_t j) { return word_value(words[j * kReliefTileSide + i]); };
  double along_u = 0.0, along_v = 0.0;
  for (std::int32_t j = column.first; j <= column.last; ++j) {
    for (std::int32_t i = row.first; i <= row.last; ++i) {
      const double here = at(i, j);
      if (i > row.first) along_u = std::max(along_u, std::fabs(here - at(i - 1, j)));
      if (j > column.first) along_v = std::max(along_v, std::fabs(here - at(i, j - 1)));
    }
  }
  return 0.5 * ((u.high - u.low) * along_u + (v.high - v.low) * along_v);
}

// An interval that holds the height, before rounding, at every point of a part of a cell, length units.
ASTROLITH_HD inline Interval bound_part(const ReliefNoise& n, const ArrayView& arrays,
                                        const ReliefPart& part) {
  constexpr double kEnough = 1.001 * double{kLeastReliefWeight};  // below this weight 0 is near (relief_mean)
  constexpr double kNarrow = 1.0;  // spacings; slopes say little of wider parts
  const std::int32_t* tiles = arrays[n.tiles] + 3 * std::int64_t{part.cell};
  const std::uint32_t* words = arrays[n.words];
  ReliefTilePair axis_tiles[3];
  ReliefCodes all;
  std::uint32_t least_weight = 0;
  bool one_tile = true, in_full = true;
  for (int a = 0; a < 3; ++a) {
    const ReliefPart::Along at = part.along(a);
    const ReliefTilePair pair = axis_tiles[a] = part_tiles(tiles[a], arrays[n.splits], at);
    if (pair.lower == 0 && pair.upper == 0) continue;  // empty
    all.weight = 0xffff;
    extend_codes(words + kReliefTileSize * pair.lower, at.u, at.v, all);
    if (pair.upper != pair.lower) extend_codes(words + kReliefTileSize * pair.upper, at.u, at.v, all);
    least_weight += all.weight;
    one_tile = one_tile && pair.upper == pair.lower;
    in_full = in_full && reaches_part(arrays[n.sheets][pair.lower], at) &&
              reaches_part(arrays[n.sheets][pair.upper], at);
  }
  if (all.least > all.greatest) return {0.0, 0.0};
  const Interval hull{double{n.low} + double{n.step} * all.least,
                      double{n.low} + double{n.step} * all.greatest};
  const Interval with_zero{std::min(hull.low, 0.0), std::max(hull.high, 0.0)};
  if (!in_full) return with_zero;
  if (!one_tile || part.width() > kNarrow) return least_weight < kEnough ? with_zero : hull;
  const ReliefSums sums = sums_in_lattice(n, words, arrays, part.middle());
  const double middle = double{relief_mean(n.low, n.step, sums)};
  double weight = double{sums.weight}, change = 0.0;
  for (int a = 0; a < 3; ++a) {
    const ReliefPart::Along at = part.along(a);
    const std::uint32_t* tile_words = words + kReliefTileSize * axis_tiles[a].lower;
    weight -= sum_change(tile_words, at.u, at.v,
                         [](std::uint32_t word) { return static_cast<double>(word >> 16); });
    change += sum_change(tile_words, at.u, at.v, [&](std::uint32_t word) {
      const double height = double{n.low} + double{n.step} * static_cast<double>(word & 0xffffu);
      return static_cast<double>(word >> 16) * (height - middle);
    });
  }
  if (weight < kEnough) return least_weight < kEnough ? with_zero : hull;
  change /= weight;
  return {std::max(hull.low, middle - change), std::min(hull.high, middle + change)};
}

// A box in the cells of a relief: the first and the last of them along an axis, and its ends in cells.
struct ReliefReach {
  std::int32_t first, last;
  double low, high;

  // The part of it in a cell, in spacings from the corner of the cell.
  ASTROLITH_HD Interval in(std::int32_t cell) const {
    const double corner = static_cast<double>(cell), width = static_cast<double>(kReliefCell);
    return {width * clamped(low - corner, 0.0, 1.0), width * clamped(high - corner, 0.0, 1.0)};
  }
};

// Bounds of the codes in the cells; of the heights, these are not those of places without weight.
ASTROLITH_HD inline Interval bound_cells(const ReliefNoise& n, const ArrayView& arrays, const ReliefReach& x,
                                         const ReliefReach& y, const ReliefReach& z) {
  const ReliefCodeRange* ranges = arrays[n.ranges];
  std::uint16_t least = 0xffff, greatest = 0;
  for (std::int32_t k = z.first; k <= z.last; ++k) {
    for (std::int32_t j = y.first; j <= y.last; ++j) {
      for (std::int32_t i = x.first; i <= x.last; ++i) {
        const ReliefCodeRange& r = ranges[i + std::int64_t{n.count_x} * (j + std::int64_t{n.count_y} * k)];
        least = r.least < least ? r.least : least;
        greatest = r.greatest > greatest ? r.greatest : greatest;
      }
    }
  }
  if (least > greatest) return {0.0, 0.0};
  // 0 where no place has a weight
  return {std::min(double{n.low} + double{n.step} * least, 0.0),
          std::max(double{n.low} + double{n.step} * greatest, 0.0)};
}

// Bounds of the heights, part by part of a box in few cells.
ASTROLITH_HD inline Interval bound_parts(const ReliefNoise& n, const ArrayView& arrays, const ReliefReach& x,
                                         const ReliefReach& y, const ReliefReach& z) {
  Interval bound{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (std::int32_t k = z.first; k <= z.last; ++k) {
    for (std::int32_t j = y.first; j <= y.last; ++j) {
      for (std::int32_t i = x.first; i <= x.last; ++i) {
        const Interval part =
            bound_part(n, arrays, {i + n.count_x * (j + n.count_y * k), x.in(i), y.in(j), z.in(k)});
        bound = {std::min(bound.low, part.low), std::max(bound.high, part.high)};
      }
    }
  }
  return bound;
}

// An interval that holds n(p) for every point of a box, length units.
ASTROLITH_HD inline Interval bound_heights(const ReliefNoise& n, const ArrayView& arrays, const Box& box) {
  if (n.count_x == 0) return {0.0, 0.0};
  constexpr double kMostCells = 4096;  // beyond them the bound of all heights is as good
  constexpr double kFewCells = 8;
  const double scale = n.inverse_spacing / static_cast<double>(kReliefCell);
  const auto reach = [&](double from, double to, float origin, std::int32_t count) {
    constexpr double kSlack = 1e-3;  // of a cell, for the rounding of lattice coordinates
    const double corner = origin / static_cast<double>(kReliefCell), end = static_cast<double>(count);
    const double low = clamped(from * scale + corner - kSlack, 0.0, end),
                 high = clamped(to * scale + corner + kSlack, 0.0, end);
    const auto cell = [&](double at) {
      return static_cast<std::int32_t>(std::min(std::floor(at), end - 1.0));
    };
    return ReliefReach{cell(low), cell(high), low, high};
  };
  const ReliefReach x = reach(box.min.x, box.max.x, n.origin.x, n.count_x),
                    y = reach(box.min.y, box.max.y, n.origin.y, n.count_y),
                    z = reach(box.min.z, box.max.z, n.origin.z, n.count_z);
  const double cells = (x.last - x.first + 1.0) * (y.last - y.first + 1.0) * (z.last - z.first + 1.0);
  if (!(cells <= kMostCells)) return {-n.height_bound, n.height_bound};
  const Interval bound =
      cells <= kFewCells ? bound_parts(n, arrays, x, y, z) : bound_cells(n, arrays, x, y, z);
  const double slack = 1e-5 * n.height_bound;
  return {bound.low + n.below.least - slack, bound.high + n.below.greatest + slack};
}

}  // namespace astrolith
