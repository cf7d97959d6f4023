// Even meshes of recipes: bodies with layers, and patches.

#include <cstring>

#include "synthesis/field/field_mesh.h"
#include "synthesis/mesh/manifold_check.h"
#include "tests/synthesis/bodies.h"

namespace astrolith {
namespace {

Recipe layered_recipe() {
  Recipe recipe = testing::potato_recipe(30, 7);
  recipe.layers.push_back(testing::fractal_layer(0.02, 4.0, 5));
  BoulderLayer boulders;
  boulders.boulders = {{.place = {{0, 0, 1}, true}, .axes = {0.08, 0.06, 0.05}},
                       {.place = {{1, 0.2, 0}, true}, .axes = {0.06, 0.06, 0.04}}};
  recipe.layers.push_back(boulders);
  return recipe;
}

RecordedMesh plain_mesh(const ImplicitField& field, int resolution, double& step) {
  RecordedMesh mesh;
  step = mesh_field(field, field.bounds(), resolution, mesh).step;
  return mesh;
}

ManifoldReport check_mesh(const RecordedMesh& mesh) {
  ManifoldCheck check;
  mesh.replay(check);
  return check.finish();
}

TEST(EvenField, ABodyWithLayersLiesOnItsSurface) {
  const ImplicitField field(layered_recipe());
  for (const int resolution : {32, 64, 96}) {
    double step = 0.0;
    RecordedMesh mesh = plain_mesh(field, resolution, step);
    const ManifoldReport before = check_mesh(mesh);
    const std::vector<MeshVertex> plain = mesh.vertices;
    const EvenStatistics done = even_mesh(field, step, mesh, {});
    EXPECT_GT(done.after.first_percentile, 0.45) << resolution;
    EXPECT_GT(done.after.mean, 0.85);
    EXPECT_LT(done.before.first_percentile, 0.1);
    EXPECT_LT(double(done.kept), 0.02 * double(done.moved));
    const ManifoldReport after = check_mesh(mesh);
    EXPECT_TRUE(after.closed() && after.manifold());
    EXPECT_EQ(after.genus, before.genus);
    EXPECT_EQ(after.components, before.components);
    for (std::size_t v = 0; v < plain.size(); ++v) {
      const Vec3f& p = mesh.vertices[v].position;
      if (p == plain[v].position) continue;
      ASSERT_LE(std::abs(field.value({p.x, p.y, p.z})), done.largest_value * 1.0001);
    }
    EXPECT_LT(done.largest_value, step / 32 * 1.001);
    EXPECT_LT(done.largest_move, 2.0 * step);
  }
}

TEST(EvenField, SameBytesForAnyThreads) {
  const ImplicitField field(layered_recipe());
  double step = 0.0;
  const RecordedMesh plain = plain_mesh(field, 48, step);
  RecordedMesh first = plain;
  even_mesh(field, step, first, {});
  for (const int threads : {1, 2, 5}) {
    const ThreadLimit limit(threads);
    const ImplicitField again(layered_recipe());
    RecordedMesh mesh = plain_mesh(again, 48, step);
    even_mesh(again, step, mesh, {});
    ASSERT_EQ(mesh.vertices.size(), first.vertices.size());
    EXPECT_EQ(
        std::memcmp(mesh.vertices.data(), first.vertices.data(), first.vertices.size() * sizeof(MeshVertex)),
        0)
        << threads;
  }
}

TEST(EvenField, APatchIsEvenButForItsCuts) {
  const ImplicitField field(layered_recipe());
  double step = 0.0;
  const RecordedMesh whole = plain_mesh(field, 24, step);
  const Vec3f& p = whole.vertices[whole.vertices.size() / 2].position;
  const PatchField patch(field, {p.x, p.y, p.z});
  RecordedMesh mesh;
  const MeshStatistics made = mesh_patch(patch, 0.05, 64, mesh);
  const ManifoldReport before = check_mesh(mesh);
  const EvenStatistics done = even_mesh(patch, made.step, mesh, {});
  EXPECT_EQ(check_mesh(mesh).open_vertices, before.open_vertices);
  EXPECT_GE(done.kept, before.open_vertices);
  EXPECT_LT(done.kept, 2 * before.open_vertices);
  EXPECT_GT(done.after.mean, 0.88);
  EXPECT_LT(done.largest_value, made.step / 32 * 1.001);
}

}  // namespace
}  // namespace astrolith
