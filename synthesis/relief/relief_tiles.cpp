#include "synthesis/relief/relief_tiles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "numerics/scalar_math.h"

namespace astrolith {
namespace {

// The weights of the four places next to a point, which lies t in [0, 1] beyond the second.
std::array<double, 4> spline_weights(double t) {
  const double s = 1.0 - t;
  return {s * s * s / 6.0, 2.0 / 3.0 + t * t * (0.5 * t - 1.0), 2.0 / 3.0 + s * s * (0.5 * s - 1.0),
          t * t * t / 6.0};
}

std::int32_t containing_cell(std::int32_t line) {
  return line >= 0 ? line / kReliefCell : -((-line + kReliefCell - 1) / kReliefCell);
}

// The places of one axis by their lines.
class Lines {
 public:
  Lines(const std::vector<ReliefPlace>& places, int axis) : places_(places) {
    const auto on_axis = [axis](const ReliefPlace& p) { return p.axis == axis; };
    const auto first = std::find_if(places.begin(), places.end(), on_axis);
    const auto end = std::find_if_not(first, places.end(), on_axis);
    begin_ = static_cast<std::uint32_t>(first - places.begin());
    if (first == end) return;
    low_v_ = first->v, high_v_ = (end - 1)->v;
    const auto [least, most] =
        std::minmax_element(first, end, [](const ReliefPlace& a, const ReliefPlace& b) { return a.u < b.u; });
    low_u_ = least->u, high_u_ = most->u;
    const auto lines =
        static_cast<std::size_t>(high_u_ - low_u_ + 1) * static_cast<std::size_t>(high_v_ - low_v_ + 1);
    first_.assign(lines + 1, 0);
    for (auto p = first; p != end; ++p) ++first_[number(p->u, p->v) + 1];
    for (std::size_t i = 0; i < lines; ++i) first_[i + 1] += first_[i];
  }

  // The places on a line, ascending, as a range of numbers.
  std::pair<std::uint32_t, std::uint32_t> on(std::int32_t u, std::int32_t v) const {
    if (first_.empty() || u < low_u_ || u > high_u_ || v < low_v_ || v > high_v_) return {0, 0};
    const std::size_t n = number(u, v);
    return {begin_ + first_[n], begin_ + first_[n + 1]};
  }
  const ReliefPlace& place(std::uint32_t i) const { return places_[i]; }

 private:
  std::size_t number(std::int32_t u, std::int32_t v) const {
    return static_cast<std::size_t>(v - low_v_) * static_cast<std::size_t>(high_u_ - low_u_ + 1) +
           static_cast<std::size_t>(u - low_u_);
  }

  const std::vector<ReliefPlace>& places_;
  std::uint32_t begin_ = 0;
  std::int32_t low_u_ = 0, high_u_ = -1, low_v_ = 0, high_v_ = -1;
  std::vector<std::uint32_t> first_;
};

// How much w grows from a place to the next line, by the tangent plane of the place.
float slope(const ReliefPlace& p, int du, int dv) {
  return -(p.normal.y * static_cast<float>(du) + p.normal.z * static_cast<float>(dv)) / p.normal.x;
}

// A sheet of the surface within the lines of a tile.
struct Sheet {
  std::array<std::uint32_t, kReliefTileSize> places;
  int seeds = 0;
};

// The sheets of one axis that pass through one cell.
class CellSheets {
 public:
  CellSheets(const Lines& lines, std::int32_t u, std::int32_t v, std::int32_t w)
      : lines_(lines), u_(u), v_(v), w_(w) {}

  // The two that pass it in most lines, the greatest first; fewer where there are fewer.
  std::vector<Sheet> find() const {
    std::vector<Sheet> sheets;
    for (int j = 0; j <= kReliefCell; ++j) {
      for (int i = 0; i <= kReliefCell; ++i) {
        const auto [first, end] = lines_.on(u_ + i, v_ + j);
        for (std::uint32_t p = first; p < end; ++p) {
          if (!is_seed(lines_.place(p)) || is_in(sheets, i, j, p)) continue;
          sheets.push_back(grown_from(i, j, p));
        }
      }
    }
    std::stable_sort(sheets.begin(), sheets.end(),
                     [](const Sheet& a, const Sheet& b) { return a.seeds > b.seeds; });
    if (sheets.size() > 2) sheets.resize(2);
    return sheets;
  }

 private:
  // Points that are projected a little beside the surface may lie in the next cell.
  static constexpr float kMargin = 1.0f;

  bool is_seed(const ReliefPlace& p) const {
    const float w = p.w - static_cast<float>(w_);
    return w >= -kMargin && w <= static_cast<float>(kReliefCell) + kMargin;
  }
  static std::size_t index(int i, int j) {
    return static_cast<std::size_t>((j + 1) * kReliefTileSide + i + 1);
  }
  static bool is_in(const std::vector<Sheet>& sheets, int i, int j, std::uint32_t place) {
    return std::any_of(sheets.begin(), sheets.end(),
                       [&](const Sheet& s) { return s.places[index(i, j)] == place; });
  }

  // From a place, the sheet is followed from line to line, breadth first.
  Sheet grown_from(int i, int j, std::uint32_t place) const {
    Sheet sheet;
    sheet.places.fill(kNoPlace);
    std::array<std::array<int, 2>, kReliefTileSize> open;
    std::size_t next = 0, end = 0;
    const auto add = [&](int at_i, int at_j, std::uint32_t p) {
      sheet.places[index(at_i, at_j)] = p;
      open[end++] = {at_i, at_j};
      const bool inside = at_i >= 0 && at_i <= kReliefCell && at_j >= 0 && at_j <= kReliefCell;
      sheet.seeds += inside && is_seed(lines_.place(p));
    };
    add(i, j, place);
    while (next < end) {
      const auto [from_i, from_j] = open[next++];
      const ReliefPlace& from = lines_.place(sheet.places[index(from_i, from_j)]);
      for (const auto& [di, dj] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
        const int to_i = from_i + di, to_j = from_j + dj;
        if (to_i < -1 || to_i > kReliefCell + 1 || to_j < -1 || to_j > kReliefCell + 1) continue;
        if (sheet.places[index(to_i, to_j)] != kNoPlace) continue;
        const std::uint32_t to = continued(from, di, dj);
        if (to != kNoPlace) add(to_i, to_j, to);
      }
    }
    return sheet;
  }

  // The place on the next line at which the surface goes on; kNoPlace where it does not.
  std::uint32_t continued(const ReliefPlace& from, int du, int dv) const {
    constexpr float kNearEnough = 1.0f;  // spacings
    const auto [first, end] = lines_.on(from.u + du, from.v + dv);
    std::uint32_t nearest = kNoPlace;
    float least = kNearEnough;
    for (std::uint32_t p = first; p < end; ++p) {
      const ReliefPlace& to = lines_.place(p);
      if ((to.normal.x > 0.0f) != (from.normal.x > 0.0f)) continue;
      const float expected = from.w + 0.5f * (slope(from, du, dv) + slope(to, du, dv));
      const float error = std::abs(to.w - expected);
      if (error < least) least = error, nearest = p;
    }
    return nearest;
  }

  const Lines& lines_;
  std::int32_t u_, v_, w_;
};

// The plane through the middle of a sheet within its cell, and how far the places there are from it. The
// corner of the cell is (u0, v0, w0).
ReliefSheet middle_plane(const Lines& lines, const Sheet& sheet, std::int32_t u0, std::int32_t v0,
                         std::int32_t w0) {
  constexpr float kNear = 0.5f, kFade = 0.5f;  // spacings; twice what feet of samples miss the surface by
  const auto for_each = [&](const auto& visit) {
    for (const std::uint32_t number : sheet.places) {
      if (number == kNoPlace) continue;
      const ReliefPlace& p = lines.place(number);
      const std::int32_t u = p.u - u0, v = p.v - v0;
      if (u < 0 || u > kReliefCell || v < 0 || v > kReliefCell) continue;
      visit(p, static_cast<float>(u), static_cast<float>(v), p.w - static_cast<float>(w0));
    }
  };
  ReliefSheet plane{};
  float u = 0, v = 0, w = 0, n = 0;
  for_each([&](const ReliefPlace& p, float at_u, float at_v, float at_w) {
    u += at_u, v += at_v, w += at_w;
    plane.slope_u += slope(p, 1, 0), plane.slope_v += slope(p, 0, 1);
    n += 1.0f;
  });
  plane.slope_u /= n, plane.slope_v /= n;
  plane.at = w / n - plane.slope_u * (u / n) - plane.slope_v * (v / n);
  float off = 0.0f;
  for_each([&](const ReliefPlace&, float at_u, float at_v, float at_w) {
    off = std::max(off, std::abs(at_w - (plane.at + plane.slope_u * at_u + plane.slope_v * at_v)));
  });
  const float steep = math::sqrt(1.0f + plane.slope_u * plane.slope_u + plane.slope_v * plane.slope_v);
  plane.farthest = off + (kNear + kFade) * steep;
  plane.inverse_fade = 1.0f / (kFade * steep);
  return plane;
}

float middle_value(const ReliefSheet& plane) {
  return plane.at + 0.5f * static_cast<float>(kReliefCell) * (plane.slope_u + plane.slope_v);
}

// The cells that a line passes, along one of its two axes: one, or two where it lies on their border.
struct LineCells {
  std::int32_t first, last;
  explicit LineCells(std::int32_t line) : first(containing_cell(line)), last(first) {
    if (line - first * kReliefCell == 0) --first;
  }
};

// The sheets of the cells along one axis.
struct FoundSheets {
  std::size_t slot;  // cell and axis, as in ReliefTiles::tiles
  std::vector<Sheet> sheets;
  std::array<std::int32_t, 3> corner;  // u, v, w
};

void add_cell(const Lines& lines, const FoundSheets& found, ReliefTiles& to) {
  const std::int32_t u = found.corner[0], v = found.corner[1], w = found.corner[2];
  const auto add_tile = [&](const Sheet& sheet) {
    to.places.insert(to.places.end(), sheet.places.begin(), sheet.places.end());
    to.sheets.push_back(middle_plane(lines, sheet, u, v, w));
    return static_cast<std::int32_t>(to.num_tiles() - 1);
  };
  const std::int32_t first = add_tile(found.sheets[0]);
  to.tiles[found.slot] = first;
  if (found.sheets.size() < 2) return;
  const std::int32_t second = add_tile(found.sheets[1]);
  const ReliefSheet &a = to.sheets[static_cast<std::size_t>(first)],
                    &b = to.sheets[static_cast<std::size_t>(second)];
  const bool first_is_upper = middle_value(a) > middle_value(b);
  to.tiles[found.slot] = -1 - static_cast<std::int32_t>(to.splits.size());
  to.splits.push_back({0.5f * (a.at + b.at), 0.5f * (a.slope_u + b.slope_u), 0.5f * (a.slope_v + b.slope_v),
                       first_is_upper ? second : first, first_is_upper ? first : second});
}

}  // namespace

void ReliefShares::add(const Vec3f& p, std::vector<std::uint32_t>& places, std::vector<float>& shares) const {
  TiledPoint point;
  if (!find_in_tiles(tiles_, {p.x * inverse_spacing_, p.y * inverse_spacing_, p.z * inverse_spacing_}, point))
    return;
  const std::size_t begin = shares.size();
  double total = 0.0;
  for (std::size_t a = 0; a < 3; ++a) {
    if (point.tiles[a] == 0) continue;
    total += add_tile(static_cast<std::size_t>(point.tiles[a]), point.u(a), point.v(a), places, shares);
  }
  if (!(total > 0.0)) {
    places.resize(begin), shares.resize(begin);
    return;
  }
  for (std::size_t i = begin; i < shares.size(); ++i) shares[i] = static_cast<float>(shares[i] / total);
}

double ReliefShares::add_tile(std::size_t tile, double u, double v, std::vector<std::uint32_t>& places,
                              std::vector<float>& shares) const {
  const int i = std::min(static_cast<int>(u), kReliefCell - 1),
            j = std::min(static_cast<int>(v), kReliefCell - 1);
  const std::array<double, 4> wu = spline_weights(u - i), wv = spline_weights(v - j);
  double total = 0.0;
  for (std::size_t row = 0; row < 4; ++row) {
    for (std::size_t column = 0; column < 4; ++column) {
      const std::size_t at =
          (static_cast<std::size_t>(j) + row) * kReliefTileSide + static_cast<std::size_t>(i) + column;
      const std::uint32_t number = tiles_.places[tile * kReliefTileSize + at];
      if (number == kNoPlace) continue;
      const double share = wu[column] * wv[row] * places_[number].weight;
      places.push_back(number);
      shares.push_back(static_cast<float>(share));
      total += share;
    }
  }
  return total;
}

bool find_in_tiles(const ReliefTiles& tiles, const std::array<double, 3>& at, TiledPoint& point) {
  std::array<std::int64_t, 3> cell;
  for (std::size_t a = 0; a < 3; ++a) {
    const double number = std::floor(at[a] / kReliefCell);
    cell[a] = static_cast<std::int64_t>(number) - tiles.low[a];
    if (cell[a] < 0 || cell[a] >= tiles.count[a]) return false;
    point.at[a] = at[a] - number * kReliefCell;
  }
  point.cell = cell[0] + tiles.count[0] * (cell[1] + tiles.count[1] * cell[2]);
  for (std::size_t a = 0; a < 3; ++a) {
    std::int32_t tile = tiles.tiles[3 * static_cast<std::size_t>(point.cell) + a];
    if (tile < 0) {
      const ReliefSplit& s = tiles.splits[static_cast<std::size_t>(-1 - tile)];
      tile = point.at[a] > s.at + s.slope_u * point.u(a) + s.slope_v * point.v(a) ? s.upper : s.lower;
    }
    point.tiles[a] = tile;
  }
  return true;
}

ReliefTiles make_relief_tiles(const std::vector<ReliefPlace>& places, const std::string& where) {
  ReliefTiles made;
  made.places.assign(kReliefTileSize, kNoPlace);
  made.sheets.push_back({});
  if (places.empty()) return made;
  std::array<std::int32_t, 3> high;
  made.low.fill(std::numeric_limits<std::int32_t>::max());
  high.fill(std::numeric_limits<std::int32_t>::min());
  const auto extend = [&](std::size_t axis, std::int32_t low_cell, std::int32_t high_cell) {
    made.low[axis] = std::min(made.low[axis], low_cell);
    high[axis] = std::max(high[axis], high_cell);
  };
  for (const ReliefPlace& p : places) {
    const auto a = static_cast<std::size_t>(p.axis);
    const LineCells u(p.u), v(p.v);
    const auto w = static_cast<std::int32_t>(std::floor(p.w));
    extend((a + 1) % 3, u.first, u.last);
    extend((a + 2) % 3, v.first, v.last);
    extend(a, containing_cell(w - 1), containing_cell(w + 2));
  }
  double cells = 1.0;
  for (std::size_t a = 0; a < 3; ++a) {
    made.count[a] = high[a] - made.low[a] + 1;
    cells *= made.count[a];
  }
  if (cells > kMostReliefCells) throw InputError(where + ".spacing: too small for this body; make it larger");
  made.tiles.assign(3 * static_cast<std::size_t>(cells), 0);

  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis), au = (a + 1) % 3, av = (a + 2) % 3;
    const Lines lines(places, axis);
    std::vector<char> has_place(static_cast<std::size_t>(cells), 0);
    for (const ReliefPlace& p : places) {
      if (p.axis != axis) continue;
      const LineCells u(p.u), v(p.v);
      const auto w = static_cast<std::int32_t>(std::floor(p.w));
      for (std::int32_t cv = v.first; cv <= v.last; ++cv) {
        for (std::int32_t cu = u.first; cu <= u.last; ++cu) {
          for (std::int32_t cw = containing_cell(w - 1); cw <= containing_cell(w + 2); ++cw) {
            std::array<std::int64_t, 3> cell;
            cell[a] = cw - made.low[a], cell[au] = cu - made.low[au], cell[av] = cv - made.low[av];
            has_place[static_cast<std::size_t>(cell[0] +
                                               made.count[0] * (cell[1] + made.count[1] * cell[2]))] = 1;
          }
        }
      }
    }
    std::vector<std::int64_t> keys;  // of the cells with a place
    for (std::size_t i = 0; i < has_place.size(); ++i) {
      if (has_place[i] != 0) keys.push_back(static_cast<std::int64_t>(i));
    }
    std::vector<FoundSheets> found(keys.size());
    parallel_for(0, static_cast<std::int64_t>(keys.size()), [&](std::int64_t i) {
      const std::int64_t key = keys[static_cast<std::size_t>(i)];
      const std::array<std::int32_t, 3> cell{
          static_cast<std::int32_t>(key % made.count[0]) + made.low[0],
          static_cast<std::int32_t>(key / made.count[0] % made.count[1]) + made.low[1],
          static_cast<std::int32_t>(key / (std::int64_t{made.count[0]} * made.count[1])) + made.low[2]};
      FoundSheets& found_cell = found[static_cast<std::size_t>(i)];
      found_cell.slot = 3 * static_cast<std::size_t>(key) + a;
      found_cell.corner = {cell[au] * kReliefCell, cell[av] * kReliefCell, cell[a] * kReliefCell};
      found_cell.sheets =
          CellSheets(lines, found_cell.corner[0], found_cell.corner[1], found_cell.corner[2]).find();
    });
    for (const FoundSheets& found_cell : found) {
      if (!found_cell.sheets.empty()) add_cell(lines, found_cell, made);
    }
  }
  return made;
}

}  // namespace astrolith
