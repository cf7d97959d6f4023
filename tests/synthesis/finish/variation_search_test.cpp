#include "synthesis/finish/recipe_variation.h"

#include <string>

#include "geometry/surface/surface_distance.h"
#include "numerics/errors.h"
#include "recipe/recipe_json.h"
#include "tests/synthesis/bodies.h"

namespace astrolith {
namespace {

// A measure without randomness: 1 less ten times the mean distance from the recipe's own body.
SimilarityMeasure nearness_to(const Recipe& recipe) {
  return [own = mesh_for_comparison(recipe)](const TriangleMesh& mesh, std::uint64_t) {
    return 1.0 - 10.0 * surface_distance(own, mesh, 2000, 1).mean;
  };
}

double mesh_diagonal(const Recipe& recipe) {
  Box box;
  for (const Vec3d& p : mesh_for_comparison(recipe).vertices) box.extend(p);
  return box.diagonal();
}

// A slender body: meshes of a fixed number of cells along it have few triangles.
Recipe rod() {
  Recipe recipe = testing::sphere_recipe(0.09);
  for (int i = 1; i < 8; ++i)
    recipe.body->spheres.push_back({{0.1 * i, 0.02 * (i % 3), 0.0}, 0.07 + 0.01 * (i % 4)});
  return recipe;
}

// A variation that is the same body again is refused, although it is as alike as can be.
TEST(VariationSearch, AVariationDiffersMeasurably) {
  const Recipe recipe = rod();
  const Variation found = find_variation(recipe, nearness_to(recipe), 0.5, 3);
  EXPECT_GE(found.similarity, 0.5);
  EXPECT_GT(found.strength, 0.0);
  EXPECT_GE(found.mean_distance, kLeastVariation);
  EXPECT_GT(found.max_distance, found.mean_distance);
  const double apart =
      surface_distance(mesh_for_comparison(recipe), mesh_for_comparison(found.recipe), 2000, 7).mean;
  EXPECT_NEAR(apart / found.mean_distance, mesh_diagonal(recipe), 0.1);
}

TEST(VariationSearch, ARefusalStatesTheLargestSimilarityThatCanBeHadLong) {
  const Recipe recipe = rod();
  const SimilarityMeasure measure = nearness_to(recipe);
  const auto largest_offered = [&](double delta) {
    try {
      find_variation(recipe, measure, delta, 3);
      return 0.0;
    } catch (const InputError& e) {
      const std::string words = e.what(), before = "ask for ";
      return std::stod(words.substr(words.find(before) + before.size()));
    }
  };
  const double largest = largest_offered(1e-4);
  EXPECT_GT(largest, 0.9);
  EXPECT_GE(find_variation(recipe, measure, 1.0 - largest, 3).similarity, largest - 1e-12);
}

TEST(VariationSearch, CrumbsAreNoPieces) {
  Recipe recipe = testing::sphere_recipe(1.0);
  recipe.body->blend_exponent = 20.0;
  const std::int64_t one = count_pieces(mesh_for_comparison(recipe));
  recipe.body->spheres.push_back({{1.5, 0, 0}, 0.06});
  const std::int64_t with_crumb = count_pieces(mesh_for_comparison(recipe));
  recipe.body->spheres.back() = {{1.8, 0, 0}, 0.4};
  const std::int64_t two = count_pieces(mesh_for_comparison(recipe));
  EXPECT_EQ(one, 1);
  EXPECT_EQ(with_crumb, 1);
  EXPECT_EQ(two, 2);
  EXPECT_EQ(count_pieces({}), 0);
}

TEST(VariationSearch, StopsWhenAsked) {
  const Recipe recipe = rod();
  const auto stop = [](double, std::string_view) { return false; };
  EXPECT_THROW(find_variation(recipe, nearness_to(recipe), 0.2, 3, stop), WorkError);
}

}  // namespace
}  // namespace astrolith
