#include "synthesis/exemplar/plane_exemplar.h"

#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "tests/synthesis/exemplars.h"

namespace astrolith {
namespace {

using testing::exemplar_layer;

double find_variance(const std::vector<float>& values) {
  double sum = 0.0, square = 0.0;
  for (const float v : values)
    sum += static_cast<double>(v), square += static_cast<double>(v) * static_cast<double>(v);
  const double n = static_cast<double>(values.size());
  return square / n - sum * sum / (n * n);
}

// The mean over seeds of the variance of a plane a hundred images large is that of the photo.
TEST(PlaneExemplar, HasTheVarianceOfTheImage) {
  for (const ExemplarRotation rotation : kExemplarRotations) {
    ExemplarLayer layer = exemplar_layer(0.25, 2.0);
    layer.rotation = rotation;
    double mean = 0.0;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      mean += find_variance(synthesize_exemplar(layer, "r", 1000, 800, {seed, 0, false})) / 4.0;
    }
    EXPECT_NEAR(mean / 4.0, 1.0, 0.03) << rotation_word(rotation);
  }
}

TEST(PlaneExemplar, HasTheSameBytesForOneThreadAndForMany) {
  const ExemplarLayer layer = exemplar_layer(1.0, 1.0);
  const auto drawn = [&](int threads) {
    const ThreadLimit limit(threads);
    return synthesize_exemplar(layer, "r", 700, 300, {3, 1, false});
  };
  EXPECT_EQ(drawn(1), drawn(2));
}

// A smaller texture is the top left part of a larger one, though squares of both end elsewhere.
TEST(PlaneExemplar, IsStationary) {
  const ExemplarLayer layer = exemplar_layer(1.0, 1.0);
  const std::vector<float> large = synthesize_exemplar(layer, "r", 600, 300, {}),
                           small = synthesize_exemplar(layer, "r", 300, 100, {});
  for (std::size_t y = 0; y < 100; ++y) {
    for (std::size_t x = 0; x < 300; ++x) ASSERT_EQ(small[300 * y + x], large[600 * y + x]);
  }
}

// Neighbours across the borders of squares and of a tileable texture differ as neighbours elsewhere do.
TEST(PlaneExemplar, HasNoSeams) {
  const ExemplarLayer layer = exemplar_layer(1.0, 1.0);
  const std::size_t side = 512;
  const std::vector<float> texture = synthesize_exemplar(layer, "r", 512, 512, {1, 0, true});
  const auto jump = [&](std::size_t left, std::size_t right) {
    double sum = 0.0;
    for (std::size_t y = 0; y < side; ++y) {
      sum += std::fabs(double{texture[side * y + left]} - double{texture[side * y + right]}) +
             std::fabs(double{texture[side * left + y]} - double{texture[side * right + y]});
    }
    return sum;
  };
  double usual = 0.0;
  for (std::size_t x = 0; x + 1 < side; ++x) usual += jump(x, x + 1) / static_cast<double>(side - 1);
  EXPECT_LT(jump(side - 1, 0), 1.3 * usual);
  EXPECT_LT(jump(255, 256), 1.3 * usual);
}

TEST(PlaneExemplar, RefusesAPeriodThatIsTooSmall) {
  EXPECT_THROW(synthesize_exemplar(exemplar_layer(1.0, 1.0), "r", 20, 200, {1, 0, true}), InputError);
}

}  // namespace
}  // namespace astrolith
