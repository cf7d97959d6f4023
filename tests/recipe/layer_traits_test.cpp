#include <gtest/gtest.h>

#include <type_traits>

#include "recipe/recipe.h"

namespace astrolith {
namespace {

// No trait has a default, so that a kind that forgets one does not compile.
static_assert(!std::is_default_constructible_v<LayerTraits>);

template <class... Kinds>
std::vector<Layer> one_of_each_kind(const std::variant<Kinds...>*) {
  return {Layer(Kinds{})...};
}

TEST(LayerTraits, TellWhatALayerHas) {
  for (const Layer& layer : one_of_each_kind(static_cast<const Layer*>(nullptr))) {
    const LayerTraits traits = traits_of(layer);
    EXPECT_EQ(use_of(layer) != nullptr, traits.is_noise) << type_word(layer);
    const std::string_view word = type_word(layer);
    EXPECT_EQ(image_of(layer) != nullptr, word == "exemplar" || word == "relief") << word;
    EXPECT_FALSE(has_color(layer)) << word;
    EXPECT_EQ(has_height(layer), word != "exemplar" && word != "gabor") << word;
  }
}

TEST(LayerTraits, APopulationBelongsToLandforms) {
  CraterLayer craters;
  EXPECT_EQ(population_of(Layer(craters)), nullptr);
  craters.population.emplace();
  EXPECT_NE(population_of(Layer(craters)), nullptr);
  EXPECT_EQ(population_of(Layer(FractalLayer{})), nullptr);
}

TEST(LayerTraits, AnExemplarPaintsUnlessItOnlyServesOthers) {
  ExemplarLayer exemplar;
  exemplar.color = true;
  EXPECT_TRUE(has_color(exemplar));
  EXPECT_TRUE(paints(exemplar));
  EXPECT_FALSE(has_height(exemplar));
  exemplar.use.combination.kind = Combine::kMask;
  EXPECT_FALSE(paints(exemplar));
  exemplar.height_range = -0.5;
  EXPECT_TRUE(has_height(exemplar));
}

TEST(LayerTraits, AGaborLayerHasColorsForPlanesAlone) {
  GaborLayer gabor;
  gabor.color.emplace();
  EXPECT_TRUE(has_color(gabor));
  EXPECT_FALSE(paints(gabor));
  EXPECT_FALSE(has_height(gabor));
}

}  // namespace
}  // namespace astrolith
