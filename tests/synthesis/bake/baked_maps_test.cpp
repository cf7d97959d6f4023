#include "synthesis/bake/baked_maps.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "numerics/parallel_for.h"
#include "synthesis/field/field_mesh.h"
#include "tests/synthesis/bodies.h"

namespace astrolith {
namespace {

using namespace testing;

// A coarse mesh of a recipe, and its maps.
struct Baked {
  explicit Baked(const Recipe& recipe, int cells, int side) : field(recipe), labels(recipe, field) {
    MeshCollector collector;
    const double step = mesh_field(field, field.bounds(), cells, collector).step;
    mesh = std::move(collector.mesh);
    atlas = make_texture_atlas(mesh, side, "test");
    tangents = vertex_tangents(mesh, atlas.coordinates);
    maps = bake_maps({field, labels, nullptr, {mesh, step}}, textured(), {});
  }
  TexturedMesh textured() const { return {mesh, atlas, tangents}; }

  // Calls use(index of the texel, its place) for the covered texels of all tiles.
  template <class Use>
  void for_each_texel(const Use& use) const {
    const AtlasTexels texels(textured());
    std::vector<TexelPlace> places(TexelTile::kMostTexels);
    for (const TexelTile& tile : texels.tiles()) {
      texels.locate(tile, {places.data(), tile.num_texels()});
      for (int y = 0; y < tile.height; ++y) {
        for (int x = 0; x < tile.width; ++x) {
          const TexelPlace& place = places[static_cast<std::size_t>((y + 1) * tile.padded_width() + x + 1)];
          if (place.is_covered) use(static_cast<std::size_t>((tile.y + y) * atlas.side + tile.x + x), place);
        }
      }
    }
  }

  ImplicitField field;
  SurfaceLabels labels;
  TriangleMesh mesh;
  TextureAtlas atlas;
  std::vector<VertexTangent> tangents;
  BakedMaps maps;
};

Recipe bumpy_recipe() {
  Recipe recipe = potato_recipe(12, 5);
  recipe.layers = {fractal_layer(0.01, 9.0, 3)};
  return recipe;
}

Vec3d doubled(const Vec3f& v) { return {double{v.x}, double{v.y}, double{v.z}}; }

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

// The normals that a renderer makes of the map, at the places that the map of heights makes, are those of the
// field, and the places lie on its surface.
TEST(BakedMaps, NormalsAndHeightsAreThoseOfTheField) {
  const Baked baked(bumpy_recipe(), 60, 1024);
  const BakedMaps& maps = baked.maps;
  std::vector<double> angles, distances;
  std::size_t number = 0;
  baked.for_each_texel([&](std::size_t i, const TexelPlace& texel) {
    if (++number % 17 != 0) return;
    const double share = maps.height[i] / 65535.0;
    const Vec3d n = doubled(texel.normal), t = doubled(texel.tangent), b = cross(n, t) * double{texel.sign};
    const Vec3d place =
        doubled(texel.position) + (maps.lowest + share * (maps.highest - maps.lowest)) * normalized(n);
    const auto component = [&](std::size_t k) { return maps.normal[3 * i + k] / 127.5 - 1.0; };
    const Vec3d shown = normalized(component(0) * t + component(1) * b + component(2) * n);
    constexpr double kStep = 1e-4;
    const auto slope = [&](const Vec3d& d) {
      return baked.field.value(place + d) - baked.field.value(place - d);
    };
    const Vec3d truth = -normalized(Vec3d{slope({kStep, 0, 0}), slope({0, kStep, 0}), slope({0, 0, kStep})});
    angles.push_back(180 / std::numbers::pi * std::acos(std::clamp(dot(shown, truth), -1.0, 1.0)));
    distances.push_back(std::fabs(baked.field.value(place)) / baked.atlas.texel);
  });
  EXPECT_LT(median(angles), 0.6);
  EXPECT_LT(median(distances), 0.05);
  EXPECT_LT(static_cast<double>(maps.missed), 1e-3 * static_cast<double>(maps.covered));
}

TEST(BakedMaps, DoNotDependOnThreads) {
  const auto maps_with = [](int threads) {
    const ThreadLimit limit(threads);
    return std::make_unique<Baked>(bumpy_recipe(), 24, 256);
  };
  const auto one = maps_with(1), two = maps_with(2);
  EXPECT_EQ(one->maps.normal, two->maps.normal);
  EXPECT_EQ(one->maps.height, two->maps.height);
  EXPECT_EQ(one->maps.occlusion, two->maps.occlusion);
  EXPECT_EQ(one->maps.curvature, two->maps.curvature);
  EXPECT_EQ(one->maps.label, two->maps.label);
}

// A sphere hides no sky, has the interpolated normals, and has the curvature 1 / radius.
TEST(BakedMaps, OfASphereAreKnown) {
  const Baked baked(sphere_recipe(0.5), 64, 512);
  std::vector<double> curvatures;
  baked.for_each_texel([&](std::size_t i, const TexelPlace&) {
    ASSERT_GE(baked.maps.occlusion[i], 250);
    curvatures.push_back((baked.maps.curvature[i] - 128) / 127.0 / baked.maps.curvature_radius);
    ASSERT_EQ(baked.maps.label[i], 0);
    ASSERT_NEAR(baked.maps.normal[3 * i + 2], 255, 2);
  });
  EXPECT_NEAR(median(curvatures), 2.0, 0.5 / 127.0 / baked.maps.curvature_radius + 0.05);
  EXPECT_LT(baked.maps.highest, 1e-2);
}

TEST(BorderCopies, FillRingsFromTheNearest) {
  std::vector<std::uint8_t> covered(11 * 11);
  covered[5 * 11 + 5] = 1;
  EXPECT_EQ(border_copies(covered, 11, 4).size(), 9u * 9u - 1u);
  for (const BorderCopy& copy : border_copies(covered, 11, 4)) EXPECT_EQ(copy.from, 5u * 11u + 5u);
}

}  // namespace
}  // namespace astrolith
