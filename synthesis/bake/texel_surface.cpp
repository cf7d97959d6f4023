#include "synthesis/bake/texel_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "numerics/interval.h"
#include "synthesis/bake/atlas_texels.h"
#include "synthesis/mesh/block_polygons.h"
#include "synthesis/mesh/block_sampling.h"

namespace astrolith {
namespace {

constexpr std::size_t kMostPoints = TexelTile::kMostTexels;
constexpr int kMostSecants = 6;
constexpr float kTetrahedron = 0x1p-2f;  // the reach of the probes for the gradient, texels
// |F| at which a point has arrived, and the last step that a guess may take, texels.
constexpr float kArrived = 0x1p-2f, kGuessed = 0x1p-1f;

using TexelBatch = PointBatch<kMostPoints>;

void add_place(TexelBatch& batch, const SurfacePoint& point) {
  const Vec3f p = point.place();
  batch.add(p.x, p.y, p.z);
}

// A point on its way. The surface is sought up to `limit` from the start.
struct TexelSeeker {
  std::uint16_t number;
  float height, value;  // F there
  float before = 0.0f, value_before = 0.0f;
  float best = 0.0f, least = 0.0f;  // where |F| was least so far
};

// The box of points and of the way to the surface.
Box search_box(std::span<const SurfacePoint> points, float reach) {
  Box box;
  for (const SurfacePoint& p : points) box.extend({double{p.start.x}, double{p.start.y}, double{p.start.z}});
  return widened(box, double{reach} + 0x1p-22 * largest_coordinate(box));
}

using PointNumbers = std::vector<std::uint16_t>;

class SurfaceSearch {
 public:
  SurfaceSearch(const ImplicitField& field, float texel, const TexelGrid& grid,
                std::span<SurfacePoint> points)
      : field_(field),
        texel_(texel),
        grid_(grid),
        points_(points),
        block_(field.gather(search_box(points, texel))) {}

  void run() {
    PointNumbers first, others, left;
    const int rows = static_cast<int>(grid_.number.size()) / grid_.width;
    for (int y = 0; y < rows; ++y) {
      for (int x = 0; x < grid_.width; ++x) {
        if (number_at(x, y) >= 0)
          (x % 2 == 0 && y % 2 == 0 ? first : others).push_back(static_cast<std::uint16_t>(number_at(x, y)));
      }
    }
    seek(first);
    for (int y = 0; y < rows; ++y) {
      for (int x = 0; x < grid_.width; ++x) {
        if ((x % 2 != 0 || y % 2 != 0) && number_at(x, y) >= 0) guess(x, y);
      }
    }
    PointNumbers guessed;
    for (const std::uint16_t i : others) (points_[i].is_found ? guessed : left).push_back(i);
    take_normals(guessed, kGuessed);
    for (const std::uint16_t i : guessed) {
      if (!points_[i].is_found) left.push_back(i);
    }
    seek(left);
  }

 private:
  int number_at(int x, int y) const { return grid_.number[static_cast<std::size_t>(y * grid_.width + x)]; }

  // Takes the mean height of the neighbours that were sought, where all are there and agree.
  void guess(int x, int y) {
    const int dx = x % 2, dy = y % 2, rows = static_cast<int>(grid_.number.size()) / grid_.width;
    if (x + dx >= grid_.width || y + dy >= rows) return;
    float low = 0.0f, high = 0.0f, sum = 0.0f;
    int count = 0;
    for (int j = y - dy; j <= y + dy; j += 2) {
      for (int i = x - dx; i <= x + dx; i += 2) {
        const int number = number_at(i, j);
        if (number < 0 || !points_[static_cast<std::size_t>(number)].is_found) return;
        const float height = points_[static_cast<std::size_t>(number)].height;
        low = count == 0 ? height : std::min(low, height),
        high = count == 0 ? height : std::max(high, height);
        sum += height, ++count;
        if (dx == 0) break;
      }
      if (dy == 0) break;
    }
    constexpr float kMostDifference = 4.0f;  // texels; beyond it lies a step of the surface
    if (high - low > kMostDifference * texel_) return;
    SurfacePoint& point = points_[static_cast<std::size_t>(number_at(x, y))];
    point.height = sum / static_cast<float>(count);
    point.is_found = true;
  }

  // Finds the surface from the starts of these points.
  void seek(const PointNumbers& numbers) {
    if (numbers.empty()) return;
    const float farthest = evaluate_starts(numbers);
    // Where F changes by less than the distance, as on steep flanks, the way is longer than |F|.
    reach(3.0f * farthest + 2.0f * texel_);
    for (int k = 0; k < kMostSecants && !seekers_.empty(); ++k) take_steps();
    for (const TexelSeeker& s : seekers_) points_[s.number].height = s.best;
    seekers_.clear();
    take_normals(numbers, kArrived);
  }

  // Lets points move up to `limit` from their starts.
  void reach(float limit) {
    if (limit <= limit_) return;
    limit_ = limit;
    block_ = field_.gather(search_box(points_, limit_ + texel_));
  }

  // Returns the largest |F| at a start.
  float evaluate_starts(const PointNumbers& numbers) {
    batch_.clear();
    for (const std::uint16_t i : numbers)
      batch_.add(points_[i].start.x, points_[i].start.y, points_[i].start.z);
    batch_.evaluate(block_);
    float farthest = 0.0f;
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      const float value = batch_.value(k);
      SurfacePoint& point = points_[numbers[k]];
      farthest = std::max(farthest, std::fabs(value));
      point.height = 0.0f;
      point.is_found = std::fabs(value) <= kArrived * texel_;
      if (point.is_found) continue;
      TexelSeeker s{numbers[k], value, value};
      s.value_before = value, s.least = std::fabs(value);
      seekers_.push_back(s);
    }
    return farthest;
  }

  void take_steps() {
    batch_.clear();
    for (TexelSeeker& s : seekers_) {
      s.height = std::clamp(s.height, -limit_, limit_);
      points_[s.number].height = s.height;
      add_place(batch_, points_[s.number]);
    }
    batch_.evaluate(block_);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < seekers_.size(); ++i) {
      TexelSeeker s = seekers_[i];
      s.value = batch_.value(i);
      if (std::fabs(s.value) < s.least) s.least = std::fabs(s.value), s.best = s.height;
      points_[s.number].is_found = std::fabs(s.value) <= kArrived * texel_;
      if (points_[s.number].is_found) continue;
      go_on(s);
      seekers_[kept++] = s;
    }
    seekers_.resize(kept);
  }

  // A step of the secant; where F does not fall outwards, as at an overhang, a step of |F| towards the
  // outside of what is inside.
  static void go_on(TexelSeeker& s) {
    constexpr float kLeastSlope = 0.15f;
    const float way = s.height - s.before;
    const float slope = way != 0.0f ? (s.value_before - s.value) / way : 1.0f;
    s.before = s.height;
    s.value_before = s.value;
    s.height += slope > kLeastSlope ? s.value / slope : s.value;
  }

  // Takes the normals of these points. A point whose last step is longer than `longest` texels is not found.
  void take_normals(const PointNumbers& numbers, float longest) {
    constexpr std::size_t kAtOnce = kMostPoints / 4;
    const float h = kTetrahedron * texel_;
    for (std::size_t first = 0; first < numbers.size(); first += kAtOnce) {
      const auto some = std::span(numbers).subspan(first, std::min(kAtOnce, numbers.size() - first));
      batch_.clear();
      for (const std::uint16_t i : some) {
        for (int k = 0; k < 4; ++k) {
          const Vec3f q = normal_probe(points_[i].place(), h, k);
          batch_.add(q.x, q.y, q.z);
        }
      }
      batch_.evaluate_tetrahedra(block_);
      for (std::size_t i = 0; i < some.size(); ++i) take_normal(points_[some[i]], i, h, longest);
    }
  }

  void take_normal(SurfacePoint& p, std::size_t i, float h, float longest) const {
    Vec3f gradient;
    float mean = 0.0f;
    for (int k = 0; k < 4; ++k) {
      const float value = batch_.value(4 * i + static_cast<std::size_t>(k));
      gradient += tetrahedron_corner(k) * value;
      mean += 0.25f * value;
    }
    const float length = norm(gradient);
    constexpr float kLeastFall = 0.25f;
    const float fall = -dot(gradient, p.along) / (4.0f * h);
    const float step = mean / std::max(fall, kLeastFall), most = longest * texel_;
    // Where F rises outwards the point lies on the far side of a thin wall, or under an overhang.
    p.is_found = p.is_found && fall > 0.0f;
    if (longest == kGuessed) p.is_found = p.is_found && std::fabs(step) <= most && fall >= kLeastFall;
    p.normal = p.is_found ? gradient * (-1.0f / length) : p.along;
    if (!p.is_found) return;
    p.height += std::clamp(step, -most, most);
  }

  const ImplicitField& field_;
  float texel_, limit_ = 0.0f;
  TexelGrid grid_;
  std::span<SurfacePoint> points_;
  FieldBlock block_;
  std::vector<TexelSeeker> seekers_;
  TexelBatch batch_;
};

}  // namespace

void find_surface(const ImplicitField& field, float texel, const TexelGrid& grid,
                  std::span<SurfacePoint> points) {
  if (!points.empty()) SurfaceSearch(field, texel, grid, points).run();
}

}  // namespace astrolith
