#include "geometry/ear_cutter.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace astrolith {
namespace {

// Twice the area of the polygon, along its normal.
Vec3d newell_normal(std::span<const Triangle> fan, const std::vector<Vec3d>& vertices) {
  Vec3d sum;
  for (const auto& [a, b, c] : fan) sum += cross(vertices[b] - vertices[a], vertices[c] - vertices[a]);
  return sum;
}

struct Place {
  double x = 0.0, y = 0.0;
  bool operator==(const Place&) const = default;
};

// Positive where a, b, c run counter-clockwise.
double turn(const Place& a, const Place& b, const Place& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// A polygon in the plane, counter-clockwise. It loses one corner after another.
class ShrinkingPolygon {
 public:
  ShrinkingPolygon(std::vector<Place> places)
      : places_(std::move(places)), next_(places_.size()), previous_(places_.size()), left_(places_.size()) {
    const auto n = static_cast<std::uint32_t>(places_.size());
    for (std::uint32_t i = 0; i < n; ++i) {
      next_[i] = (i + 1) % n;
      previous_[i] = (i + n - 1) % n;
    }
    for (std::uint32_t i = 0; i < n; ++i) {
      if (!is_convex(i)) blunt_.push_back(i);
    }
  }

  std::size_t corners_left() const { return left_; }
  std::uint32_t next(std::uint32_t i) const { return next_[i]; }
  std::uint32_t previous(std::uint32_t i) const { return previous_[i]; }
  bool has(std::uint32_t i) const { return next_[i] != kGone; }

  // Whether the triangle of the corner and its two neighbours lies inside the polygon.
  bool is_ear(std::uint32_t i) {
    if (!is_convex(i)) return false;
    // Corners become convex while the polygon shrinks, and never blunt again.
    std::erase_if(blunt_, [&](std::uint32_t k) { return !has(k) || is_convex(k); });
    const Place &a = places_[previous_[i]], &b = places_[i], &c = places_[next_[i]];
    return std::none_of(blunt_.begin(), blunt_.end(), [&](std::uint32_t k) {
      const Place& p = places_[k];
      return turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0 && p != a && p != b &&
             p != c;
    });
  }

  void remove(std::uint32_t i) {
    next_[previous_[i]] = next_[i];
    previous_[next_[i]] = previous_[i];
    next_[i] = kGone;
    --left_;
  }

 private:
  static constexpr std::uint32_t kGone = 0xffffffff;

  bool is_convex(std::uint32_t i) const {
    return turn(places_[previous_[i]], places_[i], places_[next_[i]]) > 0.0;
  }

  std::vector<Place> places_;
  std::vector<std::uint32_t> next_, previous_;
  std::vector<std::uint32_t> blunt_;  // corners that may lie in the triangle of another
  std::size_t left_;
};

std::vector<std::uint32_t> fan_corners(std::span<const Triangle> fan) {
  std::vector<std::uint32_t> corners{fan[0][0], fan[0][1]};
  for (const Triangle& t : fan) corners.push_back(t[2]);
  return corners;
}

// The corners without the coordinate along which the normal is longest: they keep their digits.
ShrinkingPolygon in_plane(std::span<const std::uint32_t> corners, const std::vector<Vec3d>& vertices,
                          const Vec3d& normal) {
  const Vec3d size{std::fabs(normal.x), std::fabs(normal.y), std::fabs(normal.z)};
  std::vector<Place> places;
  for (const std::uint32_t corner : corners) {
    const Vec3d& p = vertices[corner];
    const bool along_z = size.z >= size.x && size.z >= size.y, along_y = !along_z && size.y >= size.x;
    Place place = along_z ? Place{p.x, p.y} : along_y ? Place{p.z, p.x} : Place{p.y, p.z};
    if ((along_z ? normal.z : along_y ? normal.y : normal.x) < 0.0) std::swap(place.x, place.y);
    places.push_back(place);
  }
  return {std::move(places)};
}

}  // namespace

bool fan_covers_polygon(std::span<const Triangle> fan, const std::vector<Vec3d>& vertices) {
  constexpr double kRounding = 1e-9;  // of the polygon's area
  const Vec3d normal = newell_normal(fan, vertices);
  const double least = -kRounding * squared_norm(normal);
  return std::none_of(fan.begin(), fan.end(), [&](const Triangle& t) {
    const auto& [a, b, c] = t;
    return dot(cross(vertices[b] - vertices[a], vertices[c] - vertices[a]), normal) < least;
  });
}

void cut_ears(std::span<Triangle> fan, const std::vector<Vec3d>& vertices) {
  const std::vector<std::uint32_t> corners = fan_corners(fan);
  ShrinkingPolygon polygon = in_plane(corners, vertices, newell_normal(fan, vertices));
  auto out = fan.begin();
  const auto cut = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    *out++ = {corners[a], corners[b], corners[c]};
    polygon.remove(b);
  };
  // An ear that is cut can make ears of its two neighbours only. They wait for the next round, so that
  // triangles do not become slivers around one corner.
  std::vector<std::uint32_t> candidates(corners.size()), next_candidates;
  std::iota(candidates.begin(), candidates.end(), 0u);
  std::vector<std::size_t> last_round(corners.size(), 0);
  std::uint32_t kept = 0;
  for (std::size_t round = 1; !candidates.empty() && polygon.corners_left() > 2; ++round) {
    for (const std::uint32_t i : candidates) {
      if (polygon.corners_left() <= 2) break;
      if (!polygon.has(i) || last_round[i] == round || !polygon.is_ear(i)) continue;
      const std::uint32_t before = polygon.previous(i), after = polygon.next(i);
      cut(before, i, after);
      for (const std::uint32_t neighbour : {before, after}) {
        if (std::exchange(last_round[neighbour], round) != round) next_candidates.push_back(neighbour);
      }
      kept = before;
    }
    candidates.swap(next_candidates);
    next_candidates.clear();
  }
  while (polygon.corners_left() > 2) {
    const std::uint32_t i = polygon.next(kept);
    cut(kept, i, polygon.next(i));
  }
}

}  // namespace astrolith
