#include "synthesis/field/surface_labels.h"

#include <cmath>
#include <set>

#include "synthesis/field/field_mesh.h"
#include "tests/synthesis/bodies.h"

namespace astrolith {
namespace {

std::vector<MeshVertex> mesh_vertices(const Recipe& recipe) {
  const ImplicitField field(recipe);
  MeshCollector collector;
  mesh_field(field, field.bounds(), 40, collector);
  std::vector<MeshVertex> vertices;
  for (const Vec3d& p : collector.mesh.vertices) {
    vertices.push_back(
        {{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)}, {0, 0, 1}});
  }
  return vertices;
}

std::vector<VertexLabel> find_labels(const Recipe& recipe, const std::vector<MeshVertex>& vertices,
                                     const Vec3d& origin = {}) {
  std::vector<VertexLabel> labels(vertices.size());
  SurfaceLabels(recipe, ImplicitField(recipe)).label(origin, vertices, labels);
  return labels;
}

TEST(SurfaceLabels, ABareBodyIsLabelZeroAtNoHeight) {
  const Recipe recipe = testing::sphere_recipe(1.0);
  for (const VertexLabel& label : find_labels(recipe, mesh_vertices(recipe))) {
    EXPECT_EQ(label.label, 0);
    EXPECT_EQ(label.elevation, 0.0f);
  }
}

// Two layers are tied to the halves of a body, and each is the label of its half.
TEST(SurfaceLabels, LocalLayersHaveTheirPlaces) {
  Recipe recipe = testing::sphere_recipe(1.0, {-1.2, 0, 0});
  recipe.body->spheres.push_back({{1.2, 0, 0}, 1.0});
  recipe.body->groups = {{"left", {0}}, {"right", {1}}};
  FractalLayer left = testing::fractal_layer(0.05, 2.0, 2), right = left;
  left.use.locality = Locality{"left", 1e-4};
  right.use.locality = Locality{"right", 1e-4};
  recipe.layers = {left, right};
  const std::vector<MeshVertex> vertices = mesh_vertices(recipe);
  const std::vector<VertexLabel> labels = find_labels(recipe, vertices);
  int wrong = 0;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (std::fabs(vertices[i].position.x) < 0.2f) continue;
    wrong += labels[i].label != (vertices[i].position.x < 0.0f ? 1 : 2);
  }
  // Where the height of the near layer is about 0, the small weight of the far layer may change more.
  EXPECT_LT(wrong, static_cast<int>(vertices.size() / 50));
}

// The label by its definition: from fields of the recipe with its layers up to each one. A place is kept by
// boulders without a boulder, because the random numbers of other layers depend on their place.
TEST(SurfaceLabels, AreThoseOfTheLayersOneAfterAnother) {
  Recipe recipe = testing::potato_recipe(12, 2);
  CraterLayer craters;
  craters.craters.resize(1);
  craters.craters[0].place = {{0, 0, 1}, true};
  craters.craters[0].diameter = 0.2;
  craters.name = "the pole's";
  BoulderLayer boulders;
  boulders.boulders.resize(1);
  boulders.boulders[0].place = {{0, 0, -1}, true};
  boulders.boulders[0].axes = {0.2, 0.15, 0.1};
  FractalLayer hills = testing::fractal_layer(0.03, 3.0, 2), grit = testing::fractal_layer(0.005, 20.0, 2);
  hills.name = "hills";
  grit.use.mask = LayerMask{"hills", -0.01, 0.01};
  recipe.layers = {boulders, hills, craters, grit};
  const std::vector<MeshVertex> vertices = mesh_vertices(recipe);
  const std::vector<VertexLabel> labels = find_labels(recipe, vertices);
  std::vector<float> ground(vertices.size());
  std::vector<VertexLabel> again(vertices.size());
  SurfaceLabels(recipe, ImplicitField(recipe)).label({}, vertices, again, ground);
  std::vector<ImplicitField> stages;
  Recipe so_far = recipe;
  so_far.layers.assign(recipe.layers.size(), BoulderLayer{});
  stages.emplace_back(so_far);
  const std::vector<std::size_t> order{1, 2, 3, 0};
  for (const std::size_t i : order) {
    so_far.layers[i] = recipe.layers[i];
    stages.emplace_back(so_far);
  }
  std::set<int> seen;
  for (std::size_t v = 0; v < vertices.size(); v += 7) {
    const Vec3f& p = vertices[v].position;
    std::vector<double> value;
    for (const ImplicitField& stage : stages) value.push_back(stage.value({p.x, p.y, p.z}));
    // Far from the bare surface, the surface layers of a field with lower heights lie at other points.
    if (std::fabs(value.front()) > 0.02) continue;
    int label = 0;
    double largest = 4e-6 * largest_coordinate(stages.back().bounds());  // the rounding of the field
    for (std::size_t k = 1; k < value.size(); ++k) {
      const double change = std::fabs(value[k] - value[k - 1]);
      if (change > largest) largest = change, label = static_cast<int>(order[k - 1]) + 1;
    }
    ASSERT_EQ(labels[v].label, label) << v;
    ASSERT_EQ(labels[v].elevation, static_cast<float>(value.back()) - static_cast<float>(value.front()));
    ASSERT_EQ(ground[v], static_cast<float>(value[3]));
    seen.insert(label);
  }
  EXPECT_EQ(seen.size(), 4u);
  EXPECT_EQ(
      SurfaceLabels(recipe, stages.back()).legend(),
      (std::vector<std::string>{"label 0: the bare body", "label 1: boulders", "label 2: simplex \"hills\"",
                                "label 3: craters \"the pole's\"", "label 4: simplex"}));
}

// Boulders drawn by cells have places to the digits of a patch. Float coordinates of the body are 60
// micrometres apart here, and would move boulders of 2 mm.
TEST(SurfaceLabels, FineBouldersOfAPatchAreThoseOfItsMesh) {
  Recipe recipe = testing::sphere_recipe(1000.0);
  const ImplicitField bare(recipe);
  BoulderLayer boulders;
  Population& drawn = boulders.population.emplace().drawn;
  drawn.density = 5e4;
  drawn.least_diameter = 0.002;
  drawn.greatest_diameter = 0.02;
  drawn.by_cells = true;
  recipe.layers = {boulders};
  const PatchCube cube{1000.0 * normalized(Vec3d{0.3, -0.5, 0.8}), 0.05};
  const ImplicitField field(recipe, "recipe", cube);
  MeshCollector collector;
  mesh_patch(PatchField(field, cube.center), cube.side, 48, collector);
  std::vector<MeshVertex> vertices;
  std::vector<float> x, y, z;
  for (const Vec3d& p : collector.mesh.vertices) {
    vertices.push_back({to_float(p), {0, 0, 1}});
    x.push_back(vertices.back().position.x);
    y.push_back(vertices.back().position.y);
    z.push_back(vertices.back().position.z);
  }
  std::vector<VertexLabel> labels(x.size());
  SurfaceLabels(recipe, field, cube).label(cube.center, vertices, labels);
  std::vector<float> with(x.size()), without(x.size());
  const Box all = widened(Box{cube.center, cube.center}, 0.5 * cube.side);
  field.gather(all).evaluate_local(cube.center, x, y, z, with, kExactEverywhere);
  bare.gather(all).evaluate_local(cube.center, x, y, z, without, kExactEverywhere);
  std::set<int> seen;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    ASSERT_EQ(labels[i].elevation, with[i] - without[i]);
    seen.insert(labels[i].label);
  }
  EXPECT_EQ(seen, (std::set<int>{0, 1}));
}

TEST(SurfaceLabels, AnOriginIsAdded) {
  Recipe recipe = testing::potato_recipe(12, 2);
  recipe.layers = {testing::fractal_layer(0.05, 3.0, 2), testing::fractal_layer(0.03, 9.0, 2)};
  std::vector<MeshVertex> vertices = mesh_vertices(recipe);
  const std::vector<VertexLabel> labels = find_labels(recipe, vertices);
  for (MeshVertex& v : vertices) v.position.x -= 0.25f;
  const std::vector<VertexLabel> moved = find_labels(recipe, vertices, {0.25, 0.0, 0.0});
  std::size_t same = 0;
  for (std::size_t i = 0; i < labels.size(); ++i) same += labels[i].label == moved[i].label;
  EXPECT_GE(same, labels.size() - labels.size() / 500);
}

}  // namespace
}  // namespace astrolith
