#include "synthesis/relief/relief_values.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

constexpr double kShare = 1.0 / 3.0;  // of the room that a height may use
// With this share of the wanted room a place keeps its own height. Creases of a neck are so finely balanced
// that changes of a tenth of an edge make parts of a few triangles in them.
constexpr double kNone = 0.3;
constexpr std::size_t kSteps = 12;   // depths that are looked at on each side of the surface
constexpr std::size_t kPlaces = 64;  // looked at together

// The distance s at `kSteps` depths below (sign 1) or heights above (sign -1) some places.
class Depths {
 public:
  Depths(const BodyGround& body, const ReliefPoints& points, std::size_t first, std::size_t count,
         double most, double sign) {
    std::vector<float> x(kSteps * count), y(x), z(x), gx(x), gy(x), gz(x);
    std::size_t n = 0;
    for (std::size_t i = first; i < first + count; ++i) {
      for (std::size_t k = 1; k <= kSteps; ++k, ++n) {
        const double depth = most * static_cast<double>(k) / static_cast<double>(kSteps);
        const Vec3f p = to_float(points.at(i) - sign * depth * points.normal(i));
        x[n] = p.x, y[n] = p.y, z[n] = p.z;
      }
    }
    evaluate_body(body.body, body.arrays, body.metaballs, static_cast<int>(n), x.data(), y.data(), z.data(),
                  s_.data(), gx.data(), gy.data(), gz.data());
    for (std::size_t i = 0; i < n; ++i) s_[i] *= static_cast<float>(sign);
  }

  // The least depth at which the body, or the space above it, is not solid any more: `most` where there is
  // none, and between the steps by the straight line through both.
  double room(std::size_t place, double most) const {
    const double step = most / static_cast<double>(kSteps);
    double before = 0.0;  // how much more s is than it must be
    for (std::size_t k = 0; k < kSteps; ++k) {
      const double depth = step * static_cast<double>(k + 1),
                   more = double{s_[kSteps * place + k]} - 0.5 * depth;
      if (more < 0.0) return depth + step * (before > more ? more / (before - more) : -1.0);
      before = more;
    }
    return most;
  }

 private:
  std::array<float, kSteps * kPlaces> s_;
};

template <typename Work>
void for_each_place(std::size_t n, const Work& work) {
  constexpr std::int64_t kGrain = 256;
  parallel_for(
      0, static_cast<std::int64_t>(n), [&](std::int64_t i) { work(static_cast<std::size_t>(i)); }, kGrain);
}

}  // namespace

void keep_room(const BodyGround& body, const ReliefPoints& points, double scale,
               const std::vector<double>& own, std::vector<double>& heights) {
  double change = 0.0;
  for (std::size_t i = 0; i < own.size(); ++i) change = std::max(change, std::fabs(heights[i] - own[i]));
  if (!(change > 0.0)) return;
  const double most = scale * change / kShare;
  const std::size_t blocks = (own.size() + kPlaces - 1) / kPlaces;
  parallel_for(0, static_cast<std::int64_t>(blocks), [&](std::int64_t block) {
    const std::size_t first = kPlaces * static_cast<std::size_t>(block),
                      count = std::min(kPlaces, own.size() - first);
    const Depths below(body, points, first, count, most, 1.0), above(body, points, first, count, most, -1.0);
    for (std::size_t i = 0; i < count; ++i) {
      const double own_height = own[first + i];
      const double room = std::min(below.room(i, most), above.room(i, most)) / most,
                   share = std::max(room - kNone, 0.0) / (1.0 - kNone), free = change * share * share;
      double& height = heights[first + i];
      height = own_height + std::clamp(height - own_height, -free, free);
    }
  });
}

ReliefValues::ReliefValues(const ReliefPoints& points, const ReliefShares& shares)
    : first_(points.size() + 1, 0) {
  constexpr std::size_t kGroup = 4096;  // places whose shares are found together
  struct Rows {
    std::vector<std::uint32_t> places;
    std::vector<float> shares;
  };
  std::vector<Rows> groups((points.size() + kGroup - 1) / kGroup);
  parallel_for(0, static_cast<std::int64_t>(groups.size()), [&](std::int64_t number) {
    const auto g = static_cast<std::size_t>(number);
    Rows& rows = groups[g];
    for (std::size_t i = g * kGroup; i < std::min(points.size(), (g + 1) * kGroup); ++i) {
      shares.add(to_float(points.at(i)), rows.places, rows.shares);
      first_[i + 1] = rows.places.size();
    }
  });
  std::size_t total = 0;
  for (const Rows& rows : groups) total += rows.places.size();
  places_.reserve(total), shares_.reserve(total);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const std::size_t before = places_.size();
    places_.insert(places_.end(), groups[g].places.begin(), groups[g].places.end());
    shares_.insert(shares_.end(), groups[g].shares.begin(), groups[g].shares.end());
    groups[g] = {};
    for (std::size_t i = g * kGroup; i < std::min(points.size(), (g + 1) * kGroup); ++i)
      first_[i + 1] += before;
  }
}

std::vector<double> ReliefValues::evaluate(const std::vector<double>& coefficients) const {
  std::vector<double> values(coefficients.size());
  for_each_place(values.size(), [&](std::size_t i) {
    double sum = first_[i] == first_[i + 1] ? coefficients[i] : 0.0;
    for (std::size_t k = first_[i]; k < first_[i + 1]; ++k)
      sum += double{shares_[k]} * coefficients[places_[k]];
    values[i] = sum;
  });
  return values;
}

std::vector<double> ReliefValues::solve(const std::vector<double>& values) const {
  constexpr int kIterations = 10;
  constexpr double kDamping = 1.5;
  const std::vector<Interval> limits = neighbour_limits(values);
  std::vector<double> coefficients = values;
  for (int pass = 0; pass < kIterations; ++pass) {
    const std::vector<double> reached = evaluate(coefficients);
    for (std::size_t i = 0; i < values.size(); ++i) {
      coefficients[i] =
          std::clamp(coefficients[i] + kDamping * (values[i] - reached[i]), limits[i].low, limits[i].high);
    }
  }
  return coefficients;
}

// The values that a place takes part in, and their range once more on both sides.
std::vector<Interval> ReliefValues::neighbour_limits(const std::vector<double>& values) const {
  std::vector<Interval> limits(values.size());
  for_each_place(values.size(), [&](std::size_t i) {
    double low = values[i], high = values[i];
    for (std::size_t k = first_[i]; k < first_[i + 1]; ++k) {
      low = std::min(low, values[places_[k]]);
      high = std::max(high, values[places_[k]]);
    }
    limits[i] = {low - (high - low), high + (high - low)};
  });
  return limits;
}

}  // namespace astrolith
