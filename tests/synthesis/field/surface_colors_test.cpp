#include "synthesis/field/surface_colors.h"

#include <cmath>

#include "numerics/parallel_for.h"
#include "synthesis/exemplar/exemplar_colors.h"
#include "synthesis/field/field_at_point.h"
#include "synthesis/field/field_mesh.h"
#include "synthesis/landforms/boulder_field.h"
#include "tests/synthesis/block_lists.h"
#include "tests/synthesis/bodies.h"
#include "tests/synthesis/exemplars.h"

namespace astrolith {
namespace {

using testing::colored_layer;
using testing::exemplar_layer;
using testing::sphere_recipe;

TriangleMesh make_mesh(const Recipe& recipe) {
  const ImplicitField field(recipe);
  MeshCollector collector;
  mesh_field(field, field.bounds(), 40, collector);
  return collector.mesh;
}

std::vector<VertexColor> evaluate_colors(const Recipe& recipe, const TriangleMesh& mesh) {
  const ImplicitField field(recipe);
  return SurfaceColors(recipe, "r", field).evaluate_colors({}, mesh);
}

// F at the vertices of a mesh.
std::vector<float> values_at(const ImplicitField& field, const TriangleMesh& mesh) {
  std::vector<float> values;
  for (const Vec3d& p : mesh.vertices) values.push_back(static_cast<float>(field.value(p)));
  return values;
}

// A grey image of a hundredth of the body's radius from black to white: the colour tells the height.
TEST(SurfaceColors, ColoursFitTheHeights) {
  Recipe recipe = sphere_recipe(1.0), bare = recipe;
  ExemplarLayer layer = exemplar_layer(0.01, 0.0);
  layer.height_range = 0.01;
  layer.color = true;
  recipe.layers = {layer};
  const TriangleMesh mesh = make_mesh(recipe);
  const std::vector<float> with = values_at(ImplicitField(recipe), mesh),
                           without = values_at(ImplicitField(bare), mesh);
  const std::vector<VertexColor> colors = evaluate_colors(recipe, mesh);
  const double mean = exemplar_colors(layer, "r").mean.x;
  for (std::size_t i = 0; i < colors.size(); ++i) {
    const double height = (static_cast<double>(with[i]) - static_cast<double>(without[i])) / 0.01;
    ASSERT_NEAR(colors[i][0] / 255.0, mean + height, 0.004);
    ASSERT_EQ(colors[i][0], colors[i][1]);
  }
}

TEST(SurfaceColors, AMaskAndTheOrderOfLayersSayWhoPaints) {
  Recipe recipe = sphere_recipe(1.0);
  FractalLayer hills = testing::fractal_layer(0.05, 2.0, 1);
  hills.name = "hills";
  ExemplarLayer stones = colored_layer(0.01, 0.0);
  stones.use.mask = LayerMask{"hills", 0.0, 1e-4};
  recipe.layers = {hills, stones};
  const TriangleMesh mesh = make_mesh(recipe);
  const std::vector<float> with = values_at(ImplicitField(recipe), mesh),
                           without = values_at(ImplicitField(sphere_recipe(1.0)), mesh);
  const std::vector<VertexColor> colors = evaluate_colors(recipe, mesh);
  std::size_t bare = 0;
  for (std::size_t i = 0; i < colors.size(); ++i) {
    const double hill = static_cast<double>(with[i]) - static_cast<double>(without[i]);
    if (hill < -1e-3) {
      ASSERT_EQ(colors[i], kBareColor);
    }
    if (colors[i] == kBareColor) ++bare;
  }
  EXPECT_GT(bare, colors.size() / 4);
  EXPECT_LT(bare, colors.size() * 3 / 4);
  ExemplarLayer later = colored_layer(0.02, 0.0);
  Recipe both = recipe, last = recipe;
  both.layers.push_back(later);
  last.layers[1] = BoulderLayer{};
  last.layers.push_back(later);
  EXPECT_EQ(evaluate_colors(both, mesh), evaluate_colors(last, mesh));
}

// A layer that only paints moves nothing, not even one that replaces elevations. This holds for many points
// together and for one point.
TEST(SurfaceColors, ALayerOfColourAloneMovesNothing) {
  Recipe plain = sphere_recipe(1.0);
  plain.layers = {testing::fractal_layer(0.05, 2.0, 3), BoulderLayer{}};
  Recipe painted = plain;
  ExemplarLayer layer = colored_layer(0.01, 0.0);
  layer.use.combination.kind = Combine::kReplace;
  painted.layers[1] = layer;
  const TriangleMesh mesh = make_mesh(plain);
  const ImplicitField field(painted);
  EXPECT_EQ(make_mesh(painted).vertices.size(), mesh.vertices.size());
  EXPECT_EQ(values_at(field, mesh), values_at(ImplicitField(plain), mesh));
  const FieldView& tables = field.tables();
  BlockListStore blocks(tables);
  blocks.add(tables, field.bounds());
  for (std::size_t i = 0; i < mesh.vertices.size(); i += 50) {
    const Vec3f p = to_float(mesh.vertices[i]);
    ASSERT_EQ(field_at(tables, blocks.view().block(0), p, kExactEverywhere),
              static_cast<float>(field.value(mesh.vertices[i])));
  }
}

TEST(SurfaceColors, HaveTheSameBytesForOneThreadAndForManyAndInPortions) {
  Recipe recipe = sphere_recipe(1.0);
  recipe.layers = {colored_layer(0.01, 0.01)};
  const TriangleMesh mesh = make_mesh(recipe);
  const auto painted = [&](int threads) {
    const ThreadLimit limit(threads);
    return evaluate_colors(recipe, mesh);
  };
  const std::vector<VertexColor> all = painted(1);
  EXPECT_EQ(all, painted(2));
  const ImplicitField field(recipe);
  const SurfaceColors colors(recipe, "r", field);
  for (std::size_t i = 0; i < all.size(); i += 37) {
    const MeshVertex vertex{to_float(mesh.vertices[i]), {}};
    VertexColor color{};
    colors.paint({}, {&vertex, 1}, {&color, 1});
    ASSERT_EQ(color, all[i]);
  }
}

// The layer is too fine for coordinates of the body and lies in the frame of a patch, where its colour fits
// its height as well.
TEST(SurfaceColors, APatchHasTheColoursOfItsFineLayers) {
  Recipe recipe = sphere_recipe(1e4), bare = recipe;
  ExemplarLayer layer = exemplar_layer(0.05, 0.0);
  layer.height_range = 1.0;
  layer.color = true;
  recipe.layers = {layer};
  const Vec3d center{1e4, 0, 0};
  const PatchCube cube{center, 20.0};
  const ImplicitField field(recipe, "r", cube), ground(bare, "r", cube);
  ASSERT_TRUE(field.has_patch_layers());
  std::vector<float> x, y, z;
  std::vector<MeshVertex> vertices;
  for (int i = 0; i < 400; ++i) {
    const Vec3f p{0.0f, 0.5f * static_cast<float>(i % 20) - 5.0f, 0.5f * static_cast<float>(i / 20) - 5.0f};
    x.push_back(p.x), y.push_back(p.y), z.push_back(p.z);
    vertices.push_back({p, {}});
  }
  const auto heights = [&](const ImplicitField& of) {
    std::vector<float> values(x.size());
    const Box box{center - Vec3d{6, 6, 6}, center + Vec3d{6, 6, 6}};
    of.gather(box).evaluate_local(center, x, y, z, values, kExactEverywhere);
    return values;
  };
  const std::vector<float> with = heights(field), without = heights(ground);
  std::vector<VertexColor> colors(vertices.size());
  SurfaceColors(recipe, "r", field).paint(center, vertices, colors);
  const double mean = exemplar_colors(layer, "r").mean.x;
  for (std::size_t i = 0; i < colors.size(); ++i) {
    const double height = static_cast<double>(with[i]) - static_cast<double>(without[i]);
    ASSERT_NEAR(colors[i][0] / 255.0, mean + height, 0.006) << i;
  }
}

Recipe dark_sphere() {
  Recipe recipe = sphere_recipe(1.0);
  recipe.albedo = GroundAlbedo{0.046, {0.5, 1.0, 1.5}};
  return recipe;
}

// The albedo in red, green and blue of points with normals away from the centre.
std::vector<Vec3f> albedo_at(const Recipe& recipe, const std::vector<Vec3d>& points) {
  const ImplicitField field(recipe);
  std::vector<MeshVertex> vertices;
  for (const Vec3d& p : points) vertices.push_back({to_float(p), to_float(normalized(p))});
  std::vector<Vec3f> albedo(points.size());
  SurfaceColors(recipe, "r", field).find_albedo({}, vertices, albedo);
  return albedo;
}

float green_at(const Recipe& recipe, const Vec3d& point) { return albedo_at(recipe, {point})[0].y; }

TEST(SurfaceAlbedo, IsTheNormalAlbedoTimesItsColor) {
  const Vec3f albedo = albedo_at(dark_sphere(), {{0, 0, 1}})[0];
  EXPECT_NEAR(albedo.x, 0.023, 1e-6);
  EXPECT_NEAR(albedo.y, 0.046, 1e-6);
  EXPECT_NEAR(albedo.z, 0.069, 1e-6);
}

// A darker body is darker to look at, though not by its albedo's ratio.
TEST(SurfaceAlbedo, ColorsAreForViewing) {
  Recipe dark = dark_sphere(), bright = dark_sphere();
  bright.albedo->normal = 0.38;
  const auto green = [](const Recipe& recipe) {
    const ImplicitField field(recipe);
    return SurfaceColors(recipe, "r", field).evaluate_colors({}, TriangleMesh{{{0, 0, 1}}, {}, {}, {}})[0][1];
  };
  EXPECT_EQ(green(dark), 144);    // sRGB of .278
  EXPECT_EQ(green(bright), 198);  // of .562
}

TEST(SurfaceAlbedo, ContrastFollowsTheHeightsOfALayer) {
  Recipe recipe = dark_sphere();
  FractalLayer hills = testing::fractal_layer(0.05, 2.0, 3);
  hills.use.albedo = LayerAlbedo{.contrast = 0.8};
  recipe.layers = {hills};
  const ImplicitField field(recipe), bare(dark_sphere());
  for (const Vec3d p : {Vec3d{0, 0, 1}, Vec3d{0.6, 0.8, 0}, Vec3d{-1, 0, 0}}) {
    const double height = field.value(p) - bare.value(p);
    EXPECT_NEAR(std::log(double{green_at(recipe, p)} / 0.046), 0.8 * height / 0.05, 1e-4);
  }
  // A layer that serves as a mask alone has the same say.
  hills.use.combination.kind = Combine::kMask;
  Recipe flat = recipe;
  flat.layers = {hills};
  EXPECT_NEAR(green_at(flat, {0.6, 0.8, 0}), green_at(recipe, {0.6, 0.8, 0}), 1e-5);
}

TEST(SurfaceAlbedo, ALayerCoversTheGroundByItsMask) {
  Recipe recipe = dark_sphere();
  FractalLayer hills = testing::fractal_layer(1.0, 2.0, 1), dust = testing::fractal_layer(0.0, 1.0, 1);
  hills.name = "hills";
  hills.use.combination.kind = Combine::kMask;
  hills.use.albedo = LayerAlbedo{.contrast = 1.0};
  dust.use.mask = LayerMask{"hills", -2.0, -1.5};  // everywhere
  dust.use.albedo = LayerAlbedo{.normal = 0.2};
  recipe.layers = {hills, dust};
  EXPECT_NEAR(green_at(recipe, {0, 0.6, 0.8}), 0.2, 1e-5);
  std::get<FractalLayer>(recipe.layers[1]).use.mask = LayerMask{"hills", 2.0, 3.0};  // nowhere
  EXPECT_GT(std::fabs(green_at(recipe, {0, 0.6, 0.8}) - 0.046f), 1e-4);
  EXPECT_LT(green_at(recipe, {0, 0.6, 0.8}), 0.046 * 2.72);
}

TEST(SurfaceAlbedo, FreshCratersAreBright) {
  Recipe recipe = dark_sphere();
  CraterLayer craters;
  craters.albedo = CraterAlbedo{2.0, {1.0, 1.0, 1.1}};
  craters.craters = {{{{0, 0, 1}}, 0.2, {}, {}, 10.0}, {{{0, 1, 0}}, 0.2, {}, {}, 0.0}};
  recipe.layers = {craters};
  const std::vector<Vec3f> albedo =
      albedo_at(recipe, {{0, 0, 1}, {0, 1, 0}, {0, 0.98, 0.2}, {0, 0.5, 0.5}, {0, 0, -1}});
  EXPECT_NEAR(albedo[0].y, 0.046, 1e-6);  // the oldest
  EXPECT_NEAR(albedo[1].y, 0.092, 1e-6);
  EXPECT_NEAR(albedo[1].z, 0.092 * 1.5 * 1.1, 1e-5);
  EXPECT_GT(albedo[2].y, 0.046f);  // its flank
  EXPECT_LT(albedo[2].y, 0.092f);
  EXPECT_NEAR(albedo[4].y, 0.046, 1e-6);
}

TEST(SurfaceAlbedo, OfALayerAloneStandsOnTheDefault) {
  Recipe recipe = sphere_recipe(1.0);
  CraterLayer craters;
  craters.albedo = CraterAlbedo{2.0};
  craters.craters = {{{{0, 0, 1}}, 0.2, {}, {}, 0.0}};
  recipe.layers = {craters};
  EXPECT_TRUE(has_colors(recipe));
  EXPECT_NEAR(green_at(recipe, {0, 0, -1}), 0.1, 1e-6);
  EXPECT_NEAR(green_at(recipe, {0, 0, 1}), 0.2, 1e-6);
}

// As many boulders as a law of their albedo needs, looked at where each is highest.
TEST(SurfaceAlbedo, BouldersFollowTheirLaw) {
  Recipe recipe = dark_sphere();
  BoulderLayer boulders;
  boulders.roughness = boulders.angularity = 0.0;
  boulders.population.emplace();
  boulders.population->drawn.count = 3000;
  boulders.population->drawn.least_diameter = 0.01;
  boulders.population->drawn.greatest_diameter = 0.011;
  boulders.albedo = BoulderAlbedo{0.04, 0.2, 0.05, 4.0};
  recipe.layers = {boulders};
  const ImplicitField field(recipe);
  std::vector<Vec3d> tops;
  for (const PlacedBoulder& b : field.boulders()[0].boulders) tops.push_back((1.0 + 2e-3) * b.center);
  std::vector<double> logarithms;
  double bright = 0.0;
  for (const Vec3f& albedo : albedo_at(recipe, tops)) {
    const double logarithm = std::log(double{albedo.y} / 0.04);
    if (logarithm > 0.8) {
      bright += 1.0;
    } else {
      logarithms.push_back(logarithm);
    }
  }
  const auto n = static_cast<double>(logarithms.size());
  EXPECT_NEAR(bright / static_cast<double>(tops.size()), 0.05, 0.015);
  double sum = 0.0, squares = 0.0;
  for (const double x : logarithms) sum += x, squares += x * x;
  EXPECT_NEAR(sum / n, 0.0, 0.02);
  EXPECT_NEAR(std::sqrt(squares / n), 0.2, 0.02);
}

TEST(SurfaceAlbedo, SteepAndLowGroundDiffer) {
  Recipe recipe = dark_sphere();
  recipe.albedo->steep = 1.5;
  recipe.albedo->elevation = AlbedoByElevation{0.0, -0.01, 0.5};
  const ImplicitField field(recipe);
  const SurfaceColors colors(recipe, "r", field);
  const std::vector<MeshVertex> vertices{{{0, 0, 1}, to_float(normalized(Vec3d{1, 0, 1}))}};
  std::vector<Vec3f> albedo(1);
  colors.find_albedo({}, vertices, albedo);
  EXPECT_NEAR(albedo[0].y, 0.046 * 1.5, 1e-5);
  CraterLayer crater;
  crater.craters = {{{{0, 0, 1}}, 0.3, 0.05, {}, 0.0}};
  recipe.layers = {crater};
  EXPECT_NEAR(green_at(recipe, {0, 0, 0.95}), 0.046 * 0.5, 1e-5);
}

}  // namespace
}  // namespace astrolith
