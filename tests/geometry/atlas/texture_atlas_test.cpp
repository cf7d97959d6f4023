#include "geometry/atlas/texture_atlas.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "tests/support/meshes.h"

namespace astrolith {
namespace {

using namespace testing;

// A sphere whose radius varies by up to a fifth from vertex to vertex, so that flanks are steep.
TriangleMesh rough_sphere() {
  TriangleMesh mesh = icosphere(4);
  CounterRandom random(3);
  for (Vec3d& v : mesh.vertices) v *= random.uniform(0.95, 1.0);
  return mesh;
}

// A ribbon that winds up like a staircase: its turns lie over each other and face one way.
TriangleMesh spiral_stair() {
  TriangleMesh mesh;
  constexpr int kSteps = 120;
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = 0.15 * i, z = 0.02 * i;
    for (const double r : {0.5, 1.0}) mesh.vertices.push_back({r * std::cos(angle), r * std::sin(angle), z});
  }
  for (std::uint32_t i = 0; i < kSteps; ++i) {
    mesh.triangles.push_back({2 * i, 2 * i + 1, 2 * i + 3});
    mesh.triangles.push_back({2 * i, 2 * i + 3, 2 * i + 2});
  }
  return mesh;
}

// The charts of the points of a grid, `per_texel` along the side of a texel; points strictly inside triangles
// only. -1: none, -2: in several triangles.
std::vector<int> chart_grid(const TextureAtlas& atlas, int per_texel) {
  const int side = per_texel * atlas.side;
  std::vector<int> grid(static_cast<std::size_t>(side) * static_cast<std::size_t>(side), -1);
  const TextureCoordinates& made = atlas.coordinates;
  for (std::size_t f = 0; f < made.triangles.size(); ++f) {
    std::array<std::array<double, 2>, 3> p{};
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t c = 0; c < 2; ++c) p[k][c] = double{made.uv[made.triangles[f][k]][c]} * side;
    }
    const auto turn = [](const auto& a, const auto& b, double x, double y) {
      return (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
    };
    const double sign = turn(p[0], p[1], p[2][0], p[2][1]) < 0 ? -1 : 1;
    const auto [x0, x1] = std::minmax({p[0][0], p[1][0], p[2][0]});
    const auto [y0, y1] = std::minmax({p[0][1], p[1][1], p[2][1]});
    for (int y = static_cast<int>(y0); y <= static_cast<int>(y1); ++y) {
      for (int x = static_cast<int>(x0); x <= static_cast<int>(x1); ++x) {
        const double px = x + 0.5, py = y + 0.5;
        const double least = std::min({sign * turn(p[0], p[1], px, py), sign * turn(p[1], p[2], px, py),
                                       sign * turn(p[2], p[0], px, py)});
        if (least <= 1e-3) continue;
        int& at =
            grid[static_cast<std::size_t>(y) * static_cast<std::size_t>(side) + static_cast<std::size_t>(x)];
        at = at == -1 ? static_cast<int>(atlas.triangle_chart[f]) : -2;
      }
    }
  }
  return grid;
}

void expect_good_atlas(const TriangleMesh& mesh, int side) {
  const TextureAtlas atlas = make_texture_atlas(mesh, side, "test");
  const AtlasStretch stretch = atlas_stretch(mesh, atlas.coordinates);
  EXPECT_LE(stretch.largest, 2.0);
  for (const TexturePoint& uv : atlas.coordinates.uv) {
    ASSERT_TRUE(uv[0] >= 0 && uv[0] <= 1 && uv[1] >= 0 && uv[1] <= 1);
  }
  ASSERT_EQ(atlas.coordinates.triangles.size(), mesh.triangles.size());
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k)
      ASSERT_EQ(atlas.coordinates.mesh_vertex[atlas.coordinates.triangles[f][k]], mesh.triangles[f][k]);
  }
  constexpr int kPerTexel = 2, kApart = 2 * kChartPadding * kPerTexel;
  const std::vector<int> grid = chart_grid(atlas, kPerTexel);
  EXPECT_EQ(std::count(grid.begin(), grid.end(), -2), 0);  // triangles overlap
  const int width = kPerTexel * side;
  const auto at = [&](int x, int y) {
    return grid[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  };
  for (int y = 0; y < width; ++y) {
    int last = -1, since = 0;  // the last chart on the row, and how far back it was
    for (int x = 0; x < width; ++x, ++since) {
      if (at(x, y) < 0) continue;
      if (last >= 0 && at(x, y) != last) {
        ASSERT_GE(since, kApart) << x << " " << y;
      }
      last = at(x, y), since = 0;
    }
  }
}

TEST(TextureAtlas, ASphereHasSixCharts) {
  const TextureAtlas atlas = make_texture_atlas(icosphere(4), 512, "test");
  EXPECT_EQ(atlas.places.size(), 6u);
  expect_good_atlas(icosphere(4), 512);
}

TEST(TextureAtlas, BodiesOfAnyTopologyAreLaidOutWithoutOverlap) {
  expect_good_atlas(torus(1.0, 0.4), 512);
  expect_good_atlas(rough_sphere(), 1024);
  expect_good_atlas(open_cap(3), 256);
}

TEST(TextureAtlas, TurnsOfAStairBecomeChartsOfTheirOwn) {
  const TriangleMesh stair = spiral_stair();
  expect_good_atlas(stair, 256);
  EXPECT_GE(make_texture_atlas(stair, 256, "test").places.size(), 3u);  // of 2.9 turns
}

TEST(TextureAtlas, TexelsAreLengths) {
  const TriangleMesh mesh = icosphere(4);
  const TextureAtlas atlas = make_texture_atlas(mesh, 512, "test");
  double image = 0.0;
  for (const Triangle& t : atlas.coordinates.triangles) {
    const auto& [a, b, c] =
        std::array{atlas.coordinates.uv[t[0]], atlas.coordinates.uv[t[1]], atlas.coordinates.uv[t[2]]};
    image += 0.5 * std::fabs((double{b[0]} - a[0]) * (double{c[1]} - a[1]) -
                             (double{c[0]} - a[0]) * (double{b[1]} - a[1]));
  }
  const double area = image * 512 * 512 * atlas.texel * atlas.texel;
  EXPECT_GT(area, 0.58 * 4 * 3.14159);  // the least cosine is 1 / sqrt(3)
  EXPECT_LT(area, 4 * 3.14159);
}

TEST(TextureAtlas, TooManyChartsAreRefused) {
  TriangleMesh dust;
  for (int i = 0; i < 200; ++i) {
    const TriangleMesh grain = icosphere(0, 0.1, {double(i), 0, 0});
    const auto first = static_cast<std::uint32_t>(dust.vertices.size());
    dust.vertices.insert(dust.vertices.end(), grain.vertices.begin(), grain.vertices.end());
    for (const Triangle& t : grain.triangles)
      dust.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  try {
    make_texture_atlas(dust, 64, "--bake");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_EQ(std::string(e.what()).find("--bake: "), 0u);
  }
}

TEST(PackRectangles, AllLieApartInTheSquare) {
  CounterRandom random(1);
  std::vector<RectangleSize> sizes;
  for (int i = 0; i < 300; ++i)
    sizes.push_back(
        {1 + static_cast<int>(random.uniform() * 40), 1 + static_cast<int>(random.uniform() * 40)});
  constexpr int kSide = 400;
  const auto places = pack_rectangles(sizes, kSide);
  ASSERT_TRUE(places);
  std::vector<int> taken(kSide * kSide);
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    ASSERT_LE((*places)[i].x + sizes[i].width, kSide);
    ASSERT_LE((*places)[i].y + sizes[i].height, kSide);
    for (int y = 0; y < sizes[i].height; ++y) {
      for (int x = 0; x < sizes[i].width; ++x)
        ASSERT_EQ(taken[static_cast<std::size_t>(((*places)[i].y + y) * kSide + (*places)[i].x + x)]++, 0);
    }
  }
  EXPECT_FALSE(pack_rectangles(sizes, 200));
}

}  // namespace
}  // namespace astrolith
