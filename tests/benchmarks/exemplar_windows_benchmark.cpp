// Measures an exemplar layer on bodies against the same layer on a plane: the scores of fit_gabor in windows
// of the size of the image, and the variance over that of the photo.
//
//   exemplar_windows_benchmark PHOTO... --body ITOKAWA.json --body KLEOPATRA.json
//
// The exemplar, and the image of random phases, is made of the square in the middle of each photo. A ball is
// always measured. The image is laid so that a body is as long as twelve images. A window is a square in the
// tangent plane of a random point of the bare body; its pixels are projected to the body. Settings are the
// same for all photos.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "estimation/gabor/exemplar/exemplar_preparation.h"
#include "estimation/gabor/exemplar/phase_exemplar.h"
#include "estimation/gabor/image/image_reader.h"
#include "numerics/hash_random.h"
#include "numerics/parallel_for.h"
#include "recipe/recipe_json.h"
#include "synthesis/exemplar/plane_exemplar.h"
#include "synthesis/field/implicit_field.h"
#include "tests/synthesis/bodies.h"

namespace astrolith {
namespace {

struct NamedBody {
  std::string name;
  Recipe recipe;
};

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}
double mean_square_about(const std::vector<double>& values, double middle) {
  double sum = 0.0;
  for (const double v : values) sum += (v - middle) * (v - middle);
  return sum / static_cast<double>(values.size());
}

double median_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

struct Windows {
  std::vector<double> values, filters;  // scores of the windows
  double square = 0.0;                  // mean square of the heights over the photo's variance
};

// What scores and variances are measured against.
struct Judge {
  const GreyImage& photo;
  double mean = mean_of(photo.values), variance = mean_square_about(photo.values, mean);

  void add(const GreyImage& window, int windows, Windows& sum) const {
    const TextureScore score = texture_score(window, photo);
    sum.values.push_back(score.values);
    sum.filters.push_back(score.filters);
    sum.square += mean_square_about(window.values, mean) / variance / windows;
  }
};

Windows on_plane(const ExemplarLayer& layer, const Judge& judge, int windows) {
  Windows sum;
  for (int seed = 1; seed <= windows; ++seed) {
    judge.add(exemplar_texture_like(layer, judge.photo, static_cast<std::uint64_t>(seed)), windows, sum);
  }
  return sum;
}

// A body under the layer. Heights are those of the layer alone, in grey values.
class BodyWindows {
 public:
  BodyWindows(const NamedBody& body, const ExemplarLayer& layer, int side)
      : side_(side), bare_(without_layers(body.recipe)) {
    const Vec3d extent = bare_.bounds().extent();
    pixel_ = std::max({extent.x, extent.y, extent.z}) / (12.0 * side);
    Recipe recipe = without_layers(body.recipe);
    ExemplarLayer laid = layer;
    laid.pixel_size = pixel_;
    grey_ = pixel_ / layer.height_rms;  // a deviation of one pixel changes no surface by much
    laid.height_rms = pixel_;
    recipe.layers = {laid};
    field_ = ImplicitField(recipe);
  }

  GreyImage window(CounterRandom& random, const Judge& judge) const {
    const Vec3d middle = random_point(random);
    const Vec3d n = normalized(bare_.gradient(middle));
    const Vec3d east = normalized(std::fabs(n.z) < 0.99 ? Vec3d{n.y, -n.x, 0.0} : Vec3d{1.0, 0.0, 0.0}),
                south = cross(n, east);
    GreyImage image{side_, side_, std::vector<double>(static_cast<std::size_t>(side_) * side_)};
    parallel_for(0, side_, [&](std::int64_t row) {
      for (int column = 0; column < side_; ++column) {
        const double u = pixel_ * (column + 0.5 - 0.5 * side_),
                     v = pixel_ * (static_cast<double>(row) + 0.5 - 0.5 * side_);
        const Vec3d p = projected(middle + u * east + v * south);
        const double height = field_.value(p) - bare_.value(p);
        image.values[static_cast<std::size_t>(row * side_ + column)] = judge.mean + height / grey_;
      }
    });
    return image;
  }

 private:
  static Recipe without_layers(Recipe recipe) {
    recipe.layers.clear();
    return recipe;
  }
  Vec3d projected(Vec3d p) const {
    for (int step = 0; step < 3; ++step) {
      const Vec3d g = bare_.gradient(p);
      p = p - (bare_.value(p) / squared_norm(g)) * g;
    }
    return p;
  }
  // A random line through the body's box, from outside to its first point on the surface.
  Vec3d random_point(CounterRandom& random) const {
    const Box box = bare_.bounds();
    const Vec3d extent = box.extent();
    for (;;) {
      const Vec3d inside = box.min + Vec3d{extent.x * random.uniform(), extent.y * random.uniform(),
                                           extent.z * random.uniform()};
      const Vec3d direction = normalized(Vec3d{random.normal(), random.normal(), random.normal()});
      const double step = 2.0 * pixel_, reach = norm(extent);
      for (double at = -reach; at < reach; at += step) {
        const Vec3d p = inside + at * direction;
        if (bare_.value(p) > 0.0) return projected(p);
      }
    }
  }

  int side_;
  ImplicitField bare_;
  ImplicitField field_ = bare_;
  double pixel_ = 0.0, grey_ = 0.0;
};

Windows on_body(const NamedBody& body, const ExemplarLayer& layer, const Judge& judge, int windows) {
  const BodyWindows made(body, layer, judge.photo.width);
  CounterRandom random(7);
  Windows sum;
  for (int i = 0; i < windows; ++i) judge.add(made.window(random, judge), windows, sum);
  return sum;
}

void print(const std::string& photo, const std::string& place, const Windows& w) {
  fmt::print("{:<40} {:<12} {:.4f} / {:.4f}   mean square / variance {:.3f}\n", photo, place,
             median_of(w.values), median_of(w.filters), w.square);
  std::fflush(stdout);
}

// The variance of planes sixteen images wide over that of the photo, the mean of four planes.
double variance_ratio(const ExemplarLayer& layer, const Judge& judge) {
  constexpr int kPlanes = 4;
  const int side = 16 * judge.photo.width;
  double ratio = 0.0;
  for (std::uint64_t seed = 1; seed <= kPlanes; ++seed) {
    const std::vector<float> heights = synthesize_exemplar(layer, "exemplar", side, side, {seed, 0, false});
    const std::vector<double> values(heights.begin(), heights.end());
    ratio += mean_square_about(values, mean_of(values)) / judge.variance / kPlanes;
  }
  return ratio;
}

}  // namespace
}  // namespace astrolith

int main(int argc, char** argv) {
  using namespace astrolith;
  CLI::App app("An exemplar layer on bodies against the plane");
  std::vector<std::string> photos, bodies;
  int windows = 30, side = 256;
  app.add_option("photos", photos, "images")->required();
  app.add_option("--body", bodies, "recipes of bodies; their layers are left out");
  app.add_option("--windows", windows, "on each body and in the plane")->capture_default_str();
  app.add_option("--side", side, "of the square of a photo, pixels")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  std::vector<NamedBody> all{{"sphere", testing::sphere_recipe(1.0)}};
  for (const std::string& file : bodies) {
    all.push_back({std::filesystem::path(file).stem().string(), read_recipe(file)});
  }
  for (const std::string& file : photos) {
    const GreyImage square = read_grey_image(file).image.middle(side);
    const Judge judge{square};
    const std::string stem = std::filesystem::path(file).stem().string();
    for (const auto& [model, layer] : {std::pair{"exemplar", prepare_exemplar(square, file, 1).layer},
                                       std::pair{"phase", phase_exemplar({square}, file, 1)}}) {
      const std::string photo = fmt::format("{}, {}", stem, model);
      fmt::print("{:<40} planes of 16 x 16 images: variance / photo's {:.3f}\n", photo,
                 variance_ratio(layer, judge));
      print(photo, "plane", on_plane(layer, judge, windows));
      for (const NamedBody& body : all) print(photo, body.name, on_body(body, layer, judge, windows));
    }
  }
}
