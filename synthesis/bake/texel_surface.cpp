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
constexpr float kArrived = 0x1p-4f, kTetrahedron = 0x1p-2f;  // texels

using TexelBatch = PointBatch<kMostPoints>;

void add_place(TexelBatch& batch, const SurfacePoint& point) {
  const Vec3f p = point.place();
  batch.add(p.x, p.y, p.z);
}

// A point on its way. The surface is sought up to `limit` from the start.
struct Seeker {
  std::uint16_t number;
  float height, value;                 // F there
  float before = 0.0f, value_before = 0.0f;
  float best = 0.0f, least = 0.0f;     // where |F| was least so far
};

// The box of points and of the way to the surface.
Box box_of_ways(std::span<const SurfacePoint> points, float reach) {
  Box box;
  for (const SurfacePoint& p : points)
    box.extend({double{p.start.x}, double{p.start.y}, double{p.start.z}});
  return widened(box, double{reach} + 0x1p-22 * largest_coordinate(box));
}

class SurfaceSearch {
 public:
  SurfaceSearch(const ImplicitField& field, float texel, std::span<SurfacePoint> points)
      : texel_(texel), points_(points), start_(field.gather(box_of_ways(points, texel))) {}

  void run(const ImplicitField& field) {
    const float farthest = evaluate_starts();
    // Where F changes by less than the distance, as on steep flanks, the way is longer than |F|.
    limit_ = 3.0f * farthest + 2.0f * texel_;
    const FieldBlock block = field.gather(box_of_ways(points_, limit_ + texel_));
    for (int k = 0; k < kMostSecants && !seekers_.empty(); ++k) take_steps(block);
    for (const Seeker& s : seekers_) points_[s.number].height = s.best;
    take_normals(block);
  }

 private:
  // Returns the largest |F| at a start.
  float evaluate_starts() {
    batch_.clear();
    for (const SurfacePoint& p : points_) batch_.add(p.start.x, p.start.y, p.start.z);
    batch_.evaluate(start_);
    float farthest = 0.0f;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const float value = batch_.value(i);
      farthest = std::max(farthest, std::fabs(value));
      points_[i].is_found = std::fabs(value) <= kArrived * texel_;
      if (points_[i].is_found) continue;
      Seeker s{static_cast<std::uint16_t>(i), value, value};
      s.value_before = value, s.least = std::fabs(value);
      seekers_.push_back(s);
    }
    return farthest;
  }

  void take_steps(const FieldBlock& block) {
    batch_.clear();
    for (Seeker& s : seekers_) {
      s.height = std::clamp(s.height, -limit_, limit_);
      points_[s.number].height = s.height;
      add_place(batch_, points_[s.number]);
    }
    batch_.evaluate(block);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < seekers_.size(); ++i) {
      Seeker s = seekers_[i];
      s.value = batch_.value(i);
      if (std::fabs(s.value) < s.least) s.least = std::fabs(s.value), s.best = s.height;
      points_[s.number].is_found = std::fabs(s.value) <= kArrived * texel_;
      if (points_[s.number].is_found) continue;
      go_on(s);
      seekers_[kept++] = s;
    }
    seekers_.resize(kept);
  }

  // A step of the secant; where F does not fall outwards, as at an overhang, a step of |F| towards the outside
  // of what is inside.
  static void go_on(Seeker& s) {
    constexpr float kLeastSlope = 0.15f;
    const float way = s.height - s.before;
    const float slope = way != 0.0f ? (s.value_before - s.value) / way : 1.0f;
    s.before = s.height;
    s.value_before = s.value;
    s.height += slope > kLeastSlope ? s.value / slope : s.value;
  }

  void take_normals(const FieldBlock& block) {
    const float h = kTetrahedron * texel_;
    for (std::size_t first = 0; first < points_.size(); first += kPerTetrahedra) {
      const auto some = points_.subspan(first, std::min(kPerTetrahedra, points_.size() - first));
      batch_.clear();
      for (const SurfacePoint& p : some) {
        for (int k = 0; k < 4; ++k) {
          const Vec3f q = normal_probe(p.place(), h, k);
          batch_.add(q.x, q.y, q.z);
        }
      }
      batch_.evaluate_tetrahedra(block);
      for (std::size_t i = 0; i < some.size(); ++i) take_normal(some[i], i, h);
    }
  }

  // Sets the normal, and the height by a last step of Newton's.
  void take_normal(SurfacePoint& p, std::size_t i, float h) const {
    Vec3f gradient;
    float mean = 0.0f;
    for (int k = 0; k < 4; ++k) {
      const float value = batch_.value(4 * i + static_cast<std::size_t>(k));
      gradient += tetrahedron_corner(k) * value;
      mean += 0.25f * value;
    }
    const float length = norm(gradient);
    p.normal = length > 0.0f ? gradient * (-1.0f / length) : p.along;
    const float fall = -dot(gradient, p.along) / (4.0f * h);
    const float step = mean / std::max(fall, 0.25f);
    if (p.is_found) p.height += std::clamp(step, -kTetrahedron * texel_, kTetrahedron * texel_);
  }

  static constexpr std::size_t kPerTetrahedra = kMostPoints / 4;

  float texel_, limit_ = 0.0f;
  std::span<SurfacePoint> points_;
  FieldBlock start_;
  std::vector<Seeker> seekers_;
  TexelBatch batch_;
};

}  // namespace

void find_surface(const ImplicitField& field, float texel, std::span<SurfacePoint> points) {
  if (points.empty()) return;
  SurfaceSearch(field, texel, points).run(field);
}

}  // namespace astrolith
