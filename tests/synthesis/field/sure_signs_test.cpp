#include <cstring>

#include "geometry/triangle_mesh.h"
#include "synthesis/field/implicit_field.h"
#include "synthesis/mesh/mesher.h"
#include "tests/synthesis/random_recipes.h"

namespace astrolith {
namespace {

// A field that hides find_signs(), so that the mesher evaluates F at all samples.
class FullySampled {
 public:
  class Block {
   public:
    explicit Block(FieldBlock block) : block_(std::move(block)) {}
    BlockContent content() const { return block_.content(); }
    Block restricted_to(const Box& child) const { return Block(block_.restricted_to(child)); }
    void evaluate(std::span<const float> x, std::span<const float> y, std::span<const float> z,
                  std::span<float> value, float band) const {
      block_.evaluate(x, y, z, value, band);
    }
    void evaluate_tetrahedra(std::span<const float> x, std::span<const float> y, std::span<const float> z,
                             std::span<float> value) const {
      block_.evaluate_tetrahedra(x, y, z, value);
    }

   private:
    FieldBlock block_;
  };

  explicit FullySampled(const ImplicitField& field) : field_(field) {}
  Block gather(const Box& box) const { return Block(field_.gather(box)); }

 private:
  const ImplicitField& field_;
};

static_assert(HasSureSigns<FieldBlock>);
static_assert(!HasSureSigns<FullySampled::Block>);

template <typename T>
bool equal_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

// Expects the mesh that all samples give. Returns evaluations a vertex: of it, and of the mesh by all
// samples.
std::array<double, 2> expect_full_mesh(const ImplicitField& field, int resolution) {
  MeshCollector some, all;
  const MeshStatistics made = mesh_field<kBlockCells>(field, field.bounds(), resolution, some);
  const MeshStatistics full = mesh_field<kBlockCells>(FullySampled(field), field.bounds(), resolution, all);
  EXPECT_TRUE(equal_bytes(some.mesh.vertices, all.mesh.vertices));
  EXPECT_TRUE(equal_bytes(some.mesh.normals, all.mesh.normals));
  EXPECT_TRUE(equal_bytes(some.mesh.triangles, all.mesh.triangles));
  EXPECT_LE(made.evaluations, full.evaluations + full.vertices);
  return {double(made.evaluations) / double(made.vertices), double(full.evaluations) / double(full.vertices)};
}

TEST(SureSigns, TheMeshIsThatOfAllSamples) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}) {
    SCOPED_TRACE("recipe " + std::to_string(seed));
    const ImplicitField field(testing::random_recipe(seed));
    if (field.bounds().empty()) continue;
    expect_full_mesh(field, 30 + 7 * static_cast<int>(seed % 5));
  }
}

// Bodies as fits make them: wide and narrow kernels, of which some are subtractive.
TEST(SureSigns, BodiesAsFitsMakeThemNeedFewSamples) {
  CounterRandom random(4);
  for (const double sharpness : {0.3, 1.0, 3.0, 8.0}) {
    for (const bool dented : {false, true}) {
      SCOPED_TRACE("sharpness " + std::to_string(sharpness) + (dented ? ", dented" : ""));
      Recipe recipe = testing::potato_recipe(60, 3, sharpness);
      recipe.body->cutoff_radii = 9.0;
      if (dented) testing::add_dents(*recipe.body, 10, random);
      const auto [some, all] = expect_full_mesh(ImplicitField(recipe), 128);
      // Narrow kernels bend the level within a block of a coarse grid, and the supports of the dents end
      // where their kernels still matter. Fewer signs are proven there.
      EXPECT_LT(some, (dented || sharpness > 1.0 ? 1.1 : 0.5) * all);
    }
  }
}

}  // namespace
}  // namespace astrolith
