#include "synthesis/exemplar/exemplar_ground.h"

#include <array>

namespace astrolith {
namespace {

// Offsets in a tangent plane, as shares of the radius.
struct RingPoint {
  float u, v;
};

constexpr float kC45 = 0.70710678f, kC22 = 0.92387953f, kS22 = 0.38268343f;

// Eight directions on a ring of radius 1, and eight between them on a ring of radius 1/2.
constexpr std::array<RingPoint, 16> kRings{{{1.0f, 0.0f},
                                            {kC45, kC45},
                                            {0.0f, 1.0f},
                                            {-kC45, kC45},
                                            {-1.0f, 0.0f},
                                            {-kC45, -kC45},
                                            {0.0f, -1.0f},
                                            {kC45, -kC45},
                                            {0.5f * kC22, 0.5f * kS22},
                                            {0.5f * kS22, 0.5f * kC22},
                                            {-0.5f * kS22, 0.5f * kC22},
                                            {-0.5f * kC22, 0.5f * kS22},
                                            {-0.5f * kC22, -0.5f * kS22},
                                            {-0.5f * kS22, -0.5f * kC22},
                                            {0.5f * kS22, -0.5f * kC22},
                                            {0.5f * kC22, -0.5f * kS22}}};
// The sum of u^2 over the points of the rings, which is that of v^2.
constexpr float kRingSquares = 5.0f;

float value_below(const FieldBelow& below, const Vec3f& p) {
  float field = 0.0f;
  below(1, &p.x, &p.y, &p.z, &field);
  return field;
}

// The point of the layered surface above or below a point of the bare surface, by steps of the field itself:
// it is a distance to first order.
Vec3f layered_point(const ExemplarGround& ground, const Vec3f& foot, const Vec3f& outward) {
  constexpr int kSteps = 4;
  const auto bound = static_cast<float>(ground.height_bound);
  float height = 0.0f;
  for (int step = 0; step < kSteps; ++step) {
    height = math::clamp(height + value_below(ground.below, foot + outward * height), -bound, bound);
  }
  return foot + outward * height;
}

// How much the field grows towards the inside, at least a quarter: 1 where elevations do not depend on depth.
float inward_slope(const FieldBelow& below, const Vec3f& p, const Vec3f& outward, float step) {
  const float rise = value_below(below, p - outward * step) - value_below(below, p + outward * step);
  return math::max(rise / (2.0f * step), 0.25f);
}

}  // namespace

Vec3f layered_inward(const ExemplarGround& ground, const Vec3f& foot, const Vec3f& inward, float radius) {
  const FieldBelow& below = ground.below;
  const TangentFrame frame = tangent_frame(inward);
  const Vec3f middle = layered_point(ground, foot, frame.n);
  std::array<float, kRings.size()> x, y, z, field;
  for (std::size_t i = 0; i < kRings.size(); ++i) {
    const Vec3f p = middle + frame.u * (radius * kRings[i].u) + frame.v * (radius * kRings[i].v);
    x[i] = p.x, y[i] = p.y, z[i] = p.z;
  }
  below(static_cast<int>(kRings.size()), x.data(), y.data(), z.data(), field.data());
  float slope_u = 0.0f, slope_v = 0.0f;
  for (std::size_t i = 0; i < kRings.size(); ++i) {
    slope_u = math::fma(kRings[i].u, field[i], slope_u);
    slope_v = math::fma(kRings[i].v, field[i], slope_v);
  }
  const float scale = 1.0f / (kRingSquares * radius);
  return frame.u * (slope_u * scale) + frame.v * (slope_v * scale) -
         frame.n * inward_slope(below, middle, frame.n, 0.5f * radius);
}

TangentFrame turned_frame(const TangentFrame& bare, const Vec3f& inward) {
  const Vec3f n = inward * (-1.0f / math::sqrt(dot(inward, inward)));
  const Vec3f sum = bare.n + n;
  const float scale = 1.0f / (1.0f + dot(bare.n, n));
  const auto turned = [&](const Vec3f& v) { return v - sum * (scale * dot(n, v)); };
  return {turned(bare.u), turned(bare.v), n};
}

}  // namespace astrolith
