// gabor_tiles_benchmark RECIPE...: what `evaluation: tiles` gains and costs the first Gabor layer of each
// recipe. Prints one row of JSON for each: the tiles, the share of the variance that stays impulses, the
// distance of the spectrum from the lobes', and points a second on the surface of a ball on one thread, by
// impulses and by tiles. Points lie a pixel apart, in blocks as a mesher asks for them.
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "estimation/gabor/exemplar/tiled_spectrum.h"
#include "numerics/parallel_for.h"
#include "recipe/recipe_json.h"
#include "synthesis/exemplar/phase_tile.h"
#include "synthesis/field/field_tables.h"
#include "synthesis/field/implicit_field.h"
#include "synthesis/gabor/gabor_tiles.h"
#include "tests/benchmarks/processor_seconds.h"
#include "tests/synthesis/bodies.h"

namespace astrolith {
namespace {

constexpr double kPixel = 5e-4;  // of the radius of the ball
constexpr int kSide = 32, kBlocks = 12;

struct BallPoints {
  std::vector<float> x, y, z;

  BallPoints() {
    for (int b = 0; b < kBlocks * kBlocks; ++b) {
      for (int i = 0; i < kSide * kSide; ++i) {
        const double u = kPixel * (b % kBlocks * kSide + i % kSide),
                     v = kPixel * (b / kBlocks * kSide + i / kSide);
        const Vec3d p = normalized(Vec3d{1.0, u - 0.1, v + 0.2});
        x.push_back(static_cast<float>(p.x));
        y.push_back(static_cast<float>(p.y));
        z.push_back(static_cast<float>(p.z));
      }
    }
  }
};

// A ball under a Gabor layer.
class BallNoise {
 public:
  explicit BallNoise(const GaborLayer& layer)
      : field_(recipe_of(layer)), caches_(field_.tables().gabor_lists.count) {}

  double points_per_second(const BallPoints& points) const {
    const FieldView& view = field_.tables();
    const BodyGround ground{view.body, view.arrays, {}};
    constexpr int n = kSide * kSide;
    std::vector<float> height(n);
    const double seconds = least_processor_seconds([&] {
      for (std::size_t i = 0; i < points.x.size(); i += n) {
        const float *x = &points.x[i], *y = &points.y[i], *z = &points.z[i];
        if (const auto* tiled = view.layers[0].noise.get_if<TiledGaborNoise>()) {
          evaluate_heights(*tiled, field_ground(ground), caches_.data(), n, x, y, z, height.data());
        } else {
          evaluate_heights(*view.layers[0].noise.get_if<GaborSurfaceNoise>(), field_ground(ground),
                           caches_.data(), n, x, y, z, height.data());
        }
      }
    });
    return static_cast<double>(points.x.size()) / seconds;
  }

 private:
  static Recipe recipe_of(const GaborLayer& layer) {
    Recipe recipe = testing::sphere_recipe(1.0);
    recipe.layers = {layer};
    return recipe;
  }
  // The frames of impulses follow from the one metaball of the ball.
  BodyGround field_ground(BodyGround ground) const {
    ground.metaballs = metaballs_.lists();
    return ground;
  }

  ImplicitField field_;
  std::vector<GaborTileCache> caches_;
  ReachingMetaballs metaballs_ = all_metaballs(field_.tables().body, field_.tables().arrays);
};

void measure(const std::string& file, const BallPoints& points) {
  const Recipe recipe = read_recipe(file);
  for (const Layer& any : recipe.layers) {
    const auto* fitted = std::get_if<GaborLayer>(&any);
    if (fitted == nullptr) continue;
    GaborLayer layer = *fitted;
    layer.use = {};
    layer.pixel_size = kPixel;
    layer.height_rms = 0.01;
    const PhaseTilePlan plan = plan_phase_tiles(layer.lobes);
    double narrow = 0.0, total = 0.0;
    for (const GaborLobe& lobe : layer.lobes) total += lobe.variance;
    for (const GaborLobe& lobe : plan.narrow) narrow += lobe.variance;
    std::string tiles;
    for (const PhaseTile& tile : plan.tiles) {
      char words[80];
      std::snprintf(words, sizeof words, "%s[%d, %.2f, %.3f]", tiles.empty() ? "" : ", ", tile.side,
                    tile.pixel, tile.variance() / total);
      tiles += words;
    }
    layer.evaluation = GaborEvaluation::kImpulses;
    const double by_impulses = BallNoise(layer).points_per_second(points);
    layer.evaluation = GaborEvaluation::kTiles;
    const double by_tiles = BallNoise(layer).points_per_second(points);
    std::printf(
        "{\"recipe\": \"%s\", \"lobes\": %zu, \"tiles_side_pixel_share\": [%s], \"narrow_share\": %.4f, "
        "\"tiles_distance\": %.4f, \"impulses_mpoint_per_s\": %.2f, \"tiles_mpoint_per_s\": %.2f}\n",
        file.c_str(), layer.lobes.size(), tiles.c_str(), narrow / total,
        tiles_distance(layer.lobes, 256, 256), 1e-6 * by_impulses, 1e-6 * by_tiles);
    std::fflush(stdout);
    return;
  }
}

}  // namespace
}  // namespace astrolith

int main(int argc, char** argv) {
  using namespace astrolith;
  const ThreadLimit one_thread(1);
  const BallPoints points;
  for (int i = 1; i < argc; ++i) measure(argv[i], points);
}
