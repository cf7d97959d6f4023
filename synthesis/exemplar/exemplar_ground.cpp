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

}  // namespace

Vec3f inward_of_layered(const FieldBelow& below, const Vec3f& foot, const Vec3f& inward, float radius) {
  const TangentFrame frame = tangent_frame(inward);
  std::array<float, kRings.size()> x, y, z, field;
  for (std::size_t i = 0; i < kRings.size(); ++i) {
    const Vec3f p = foot + frame.u * (radius * kRings[i].u) + frame.v * (radius * kRings[i].v);
    x[i] = p.x, y[i] = p.y, z[i] = p.z;
  }
  below(static_cast<int>(kRings.size()), x.data(), y.data(), z.data(), field.data());
  float slope_u = 0.0f, slope_v = 0.0f;
  for (std::size_t i = 0; i < kRings.size(); ++i) {
    slope_u = math::fma(kRings[i].u, field[i], slope_u);
    slope_v = math::fma(kRings[i].v, field[i], slope_v);
  }
  const float scale = 1.0f / (kRingSquares * radius);
  return frame.u * (slope_u * scale) + frame.v * (slope_v * scale) - frame.n;
}

TangentFrame turned_frame(const TangentFrame& bare, const Vec3f& inward) {
  const Vec3f n = inward * (-1.0f / math::sqrt(dot(inward, inward)));
  const Vec3f sum = bare.n + n;
  const float scale = 1.0f / (1.0f + dot(bare.n, n));
  const auto turned = [&](const Vec3f& v) { return v - sum * (scale * dot(n, v)); };
  return {turned(bare.u), turned(bare.v), n};
}

}  // namespace astrolith
