#include "synthesis/mesh/tile_border.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace astrolith {
namespace {

// The float behind `value`, away from 0.
float float_behind(float value) { return std::nextafter(value, value < 0.0f ? -10.0f : 10.0f); }

// An open pyramid over the square around the origin; below the plane z = 0 or above it.
struct Pyramid {
  std::vector<MeshVertex> vertices;
  std::vector<Triangle> triangles;
};
Pyramid pyramid(float apex) {
  Pyramid p;
  for (const auto& [x, y] : {std::array{1.0f, 1.0f}, {-1.0f, 1.0f}, {-1.0f, -1.0f}, {1.0f, -1.0f}}) {
    p.vertices.push_back({{x, y, 0.0f}, {}});
  }
  p.vertices.push_back({{0.0f, 0.0f, apex}, {}});
  for (std::uint32_t k = 0; k < 4; ++k) {
    const std::uint32_t next = (k + 1) % 4;
    p.triangles.push_back(apex > 0.0f ? Triangle{k, next, 4} : Triangle{next, k, 4});
  }
  return p;
}

std::optional<TileFigures> find_border(const Pyramid& pyramid, bool above) {
  TileBorder border(above ? std::optional(0.0f) : std::nullopt, above ? std::nullopt : std::optional(0.0f));
  border.add_vertices(pyramid.vertices);
  border.add_triangles(pyramid.triangles);
  return border.figures();
}

TEST(TileBorder, TwoPyramidsFit) {
  const Pyramid above = pyramid(1.0f), below = pyramid(-2.0f);
  const TileFigures a = *find_border(above, true), b = *find_border(below, false);
  EXPECT_EQ(*a.lower, *b.upper);
  EXPECT_EQ(a.lower->vertices, 4);
  EXPECT_EQ(a.lower->loops, 1);
  EXPECT_EQ(a.euler_characteristic() + b.euler_characteristic(), 2);
  EXPECT_NEAR(a.volume + b.volume, 4.0, 1e-15);
  // The numbers of the vertices do not matter.
  Pyramid turned = below;
  std::rotate(turned.vertices.begin(), turned.vertices.begin() + 3, turned.vertices.begin() + 4);
  for (Triangle& t : turned.triangles) {
    for (std::uint32_t& v : t) v = v == 4 ? 4 : (v + 1) % 4;
  }
  EXPECT_EQ(*find_border(turned, false)->upper, *a.lower);
}

TEST(TileBorder, OtherPlacesOtherEdgesAndTheOtherOrientationDoNotFit) {
  const TileSide good = *find_border(pyramid(1.0f), true)->lower;
  Pyramid moved = pyramid(-1.0f);
  moved.vertices[2].position.y = float_behind(moved.vertices[2].position.y);
  EXPECT_NE(*find_border(moved, false)->upper, good);
  Pyramid crossed = pyramid(-1.0f);
  std::swap(crossed.vertices[1], crossed.vertices[2]);
  EXPECT_NE(*find_border(crossed, false)->upper, good);
  Pyramid flipped = pyramid(-1.0f);
  for (Triangle& t : flipped.triangles) std::swap(t[0], t[1]);
  EXPECT_NE(*find_border(flipped, false)->upper, good);
}

TEST(TileBorder, BordersThatAreNoLoopsHaveNoFigures) {
  Pyramid cut = pyramid(1.0f);
  cut.triangles.pop_back();
  EXPECT_FALSE(find_border(cut, true));
  Pyramid twice = pyramid(1.0f);
  twice.triangles.push_back(twice.triangles[0]);
  EXPECT_FALSE(find_border(twice, true));
  Pyramid touching = pyramid(1.0f);  // a second pyramid that shares vertex 0 with the first
  for (int k = 1; k < 4; ++k) touching.vertices.push_back(touching.vertices[static_cast<std::size_t>(k)]);
  touching.vertices.push_back({{0.0f, 0.0f, 3.0f}, {}});
  const auto second = [](std::uint32_t v) { return v == 0 ? 0 : v == 4 ? 8 : v + 4; };
  for (std::size_t k = 0; k < 4; ++k) {
    const Triangle t = touching.triangles[k];
    touching.triangles.push_back({second(t[0]), second(t[1]), second(t[2])});
  }
  EXPECT_FALSE(find_border(touching, true));
}

// Vertices that rounding put at one place are still vertices of their own.
TEST(TileBorder, VerticesAtOnePlaceAreTold) {
  Pyramid above = pyramid(1.0f), below = pyramid(-1.0f);
  above.vertices[1] = above.vertices[0];
  below.vertices[1] = below.vertices[0];
  EXPECT_EQ(*find_border(above, true)->lower, *find_border(below, false)->upper);
  EXPECT_EQ(find_border(above, true)->lower->vertices, 4);
}

}  // namespace
}  // namespace astrolith
