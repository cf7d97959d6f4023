#include "estimation/shape/relief/relief_fit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numeric>
#include <string>
#include <variant>
#include <vector>

#include "estimation/shape/relief/relief_blend.h"
#include "geometry/mesh_measure.h"
#include "numerics/errors.h"
#include "numerics/portable_double.h"
#include "numerics/progress.h"
#include "numerics/sample_statistics.h"
#include "recipe/compact/height_picture.h"
#include "synthesis/body/ground_points.h"
#include "synthesis/relief/relief_picture.h"
#include "synthesis/relief/relief_tiles.h"

namespace astrolith {
namespace {

// The places that the projections of the points take their heights from, each once.
std::vector<std::uint32_t> places_below(const std::vector<Vec3d>& points, const BodyGround& ground,
                                        const ReliefShares& shares) {
  GroundPoints feet(points);
  evaluate(ground, feet);
  project(ground, feet);
  std::vector<std::uint32_t> below;
  std::vector<float> unused;
  for (std::size_t i = 0; i < feet.size(); ++i) shares.add(feet.at(i), below, unused);
  std::sort(below.begin(), below.end());
  below.erase(std::unique(below.begin(), below.end()), below.end());
  return below;
}

std::uint16_t halved_code(const ReliefLayer& layer, std::uint16_t code) {
  const double height = layer.low + layer.step() * code;
  const double half = std::trunc(0.5 * height / layer.step()) * layer.step();  // so that it ends at 0
  return static_cast<std::uint16_t>(
      std::clamp(std::floor((half - layer.low) / layer.step() + 0.5), 0.0, layer.levels - 1.0));
}

constexpr double kPull = 2e-3;  // towards the local mean
// More of them bring the surface hardly nearer, and make heights that take more bytes.
constexpr int kIterations = 12;

// One height for each place, length units: the least squares of
//   sum_i (sum_k share_ik h_k - height_i)^2 + kPull d sum_k (h_k - m_k)^2
// by conjugate gradients, where m_k is the mean of the samples around the place weighted by their shares, and
// d the mean over the places of the sum of the squares of their shares. A place that hardly any sample sees,
// as at the border of a map, so keeps that mean. Places without samples get 0. `progress` may end the
// iteration early.
std::vector<double> solve_relief(const ReliefBlend& blend, const Progress& progress) {
  // The means, and the diagonal of the normal equations.
  const std::vector<double> shares = blend.sums(SampleSum::kOne, {}),
                            diagonal = blend.sums(SampleSum::kShare, {});
  std::vector<double> heights = blend.sums(SampleSum::kHeight, {});
  const std::size_t n = heights.size();
  for (std::size_t p = 0; p < n; ++p) heights[p] = shares[p] > 0.0 ? heights[p] / shares[p] : 0.0;
  const double pull = kPull * std::accumulate(diagonal.begin(), diagonal.end(), 0.0) / static_cast<double>(n);

  // Conjugate gradients for the change, preconditioned by the diagonal.
  std::vector<double> residual = blend.sums(SampleSum::kError, heights), change(n, 0.0), scaled(n);
  const auto scale = [&] {
    for (std::size_t p = 0; p < n; ++p)
      scaled[p] = diagonal[p] > 0.0 ? residual[p] / (diagonal[p] + pull) : 0.0;
  };
  scale();
  std::vector<double> direction = scaled;
  double energy = dot_product(residual, scaled);
  const double enough = 1e-12 * energy;
  for (int i = 0; i < kIterations && energy > enough; ++i) {
    if (!report(progress, static_cast<double>(i) / kIterations, "relief")) break;
    std::vector<double> image = blend.sums(SampleSum::kBlend, direction);
    for (std::size_t p = 0; p < n; ++p) image[p] += pull * direction[p];
    const double step = energy / dot_product(direction, image);
    for (std::size_t p = 0; p < n; ++p) {
      change[p] += step * direction[p];
      residual[p] -= step * image[p];
    }
    scale();
    const double next = dot_product(residual, scaled);
    for (std::size_t p = 0; p < n; ++p) direction[p] = scaled[p] + next / energy * direction[p];
    energy = next;
  }
  for (std::size_t p = 0; p < n; ++p) heights[p] += change[p];
  return heights;
}

constexpr double kDefaultStep = 4.0;  // mean residuals: rounding adds a tenth to the residual
constexpr int kMostLevels = 65535;
// Places for each vertex of the surface; models of few vertices get more, since their facets are what is to
// be kept.
constexpr double kPlacesPerVertex = 1.2, kMostPlacesPerVertex = 12.0, kSmallModelPlaces = 20000.0;

// The least spacing that the picture and the cells of a body without folds bear. In the picture the maps of
// the three axes stand below one another, and show the body from both sides.
double least_spacing(const TriangleMesh& surface) {
  const Box box = surface.bounds();
  const Vec3d extent = box.extent();
  const double picture_spacing =
      std::max(extent.x + extent.y + extent.z, 2.0 * box.longest_side()) / kMostHeightPictureSide;
  const double cell_spacing = portable::cbrt(extent.x * extent.y * extent.z / kMostReliefCells) / kReliefCell;
  return 1.03 * std::max(picture_spacing, cell_spacing);
}

void expect_plain_body(const Recipe& recipe) {
  if (recipe.body && recipe.body->operations.empty() && !recipe.body->warp) return;
  throw InputError(
      "a relief needs a body without operations and warp; fit the relief before these are added");
}

// Rounds the heights to levels of the layer. Returns the code of each.
std::vector<std::uint16_t> rounded(std::vector<double>& heights, double step, ReliefLayer& layer) {
  const auto [least, most] = std::minmax_element(heights.begin(), heights.end());
  const double range = *most - *least;
  layer.low = step * std::floor(*least / step);
  const double levels = std::ceil((*most - layer.low) / step) + 1.0;
  if (levels > kMostLevels) step = range / (kMostLevels - 2);
  layer.levels = std::max(2, static_cast<int>(std::min<double>(levels, kMostLevels)));
  layer.high = layer.low + step * (layer.levels - 1);
  std::vector<std::uint16_t> codes(heights.size());
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const double code = std::floor((heights[i] - layer.low) / step + 0.5);
    codes[i] = static_cast<std::uint16_t>(std::clamp(code, 0.0, layer.levels - 1.0));
    heights[i] = layer.low + step * codes[i];
  }
  return codes;
}

// Keeps each height near the samples around it. Where few samples see a place, at the border of a map, least
// squares would make spikes of several times what was measured.
void limit_to_samples(const ReliefBlend& blend, std::vector<double>& heights) {
  constexpr double kBeyond = 0.5;  // of the range: splines reach a sharp peak with heights beyond it
  const std::vector<HeightRange> ranges = blend.ranges();
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const double least = ranges[i].least, greatest = ranges[i].greatest,
                 beyond = kBeyond * (greatest - least);
    heights[i] = std::clamp(heights[i], least - beyond, greatest + beyond);
  }
}

}  // namespace

std::size_t halve_heights(const std::vector<Vec3d>& points, Recipe& recipe) {
  const auto found = std::find_if(recipe.layers.begin(), recipe.layers.end(), [](const Layer& layer) {
    return std::holds_alternative<ReliefLayer>(layer);
  });
  if (points.empty() || found == recipe.layers.end()) return 0;
  ReliefLayer& layer = std::get<ReliefLayer>(*found);
  ArrayStore arrays;
  const BodyTables body = make_body(*recipe.body, recipe.seed, arrays);
  const ReachingMetaballs metaballs = all_metaballs(body, arrays.view());
  const BodyGround ground{body, arrays.view(), metaballs.lists()};
  const std::vector<ReliefPlace> places = find_relief_places(ground, layer.spacing, "relief");
  const ReliefTiles tiles = make_relief_tiles(places, "relief");
  const ReliefLayout layout = relief_layout(places);
  auto image = std::make_shared<ExemplarImage>(*layer.pixels);
  std::size_t changed = 0;
  for (const std::uint32_t place : places_below(points, ground, ReliefShares(places, tiles, layer.spacing))) {
    const auto width = static_cast<std::size_t>(layout.width);
    std::uint16_t& value =
        image->values[layout.pixels[place] / width * static_cast<std::size_t>(image->width) +
                      layout.pixels[place] % width];
    const std::uint16_t halved = layer.code_to_grey(halved_code(layer, layer.grey_to_code(value)));
    changed += value != halved;
    value = halved;
  }
  layer.pixels = std::move(image);
  return changed;
}

double least_relief_spacing(const TriangleMesh& surface) {
  const double vertices = static_cast<double>(surface.vertices.size());
  const double places =
      std::max(kPlacesPerVertex * vertices, std::min(kMostPlacesPerVertex * vertices, kSmallModelPlaces));
  // The square of the spacing holds one place where the surface faces an axis.
  return std::max(std::sqrt(surface_area(surface) / places), least_spacing(surface));
}

void expect_relief_facets(const TriangleMesh& surface) {
  if (surface.triangles.size() >= kFewestReliefFacets) return;
  throw InputError("a relief needs a model of at least " + std::to_string(kFewestReliefFacets) +
                   " facets, and this one has " + std::to_string(surface.triangles.size()) +
                   "; use --base-only, or a finer model");
}

ReliefFit fit_relief(const TriangleMesh& surface, const Recipe& recipe, const ReliefOptions& options,
                     const Progress& progress) {
  expect_relief_facets(surface);
  expect_plain_body(recipe);
  ReliefFit fit;
  ReliefLayer& layer = fit.layer;
  layer.spacing = options.spacing > 0.0 ? options.spacing : least_relief_spacing(surface);
  // Heights farther apart show the ground of a model with longer edges.
  layer.edge = std::max(mean_edge(surface), layer.spacing);
  if (layer.edge > kMostReliefEdge * layer.spacing) {
    throw InputError(
        "the spacing of the heights is below an eighth of the surface's mean edge; make it larger");
  }
  constexpr double kSamplesShare = 0.5;  // of the time
  bool stopped = false;
  const ReliefSamples samples =
      relief_samples(surface, recipe, layer.spacing, [&](double fraction, std::string_view words) {
        stopped = !report(progress, kSamplesShare * fraction, words);
        return !stopped;
      });
  if (stopped) return fit;
  if (samples.places.empty() || samples.samples.empty()) {
    throw InputError(
        "no height reaches the surface: the body lies elsewhere, or is smaller than the spacing of the "
        "heights");
  }
  const ReliefBlend blend(samples);
  std::vector<double> heights = solve_relief(blend, [&](double fraction, std::string_view words) {
    return report(progress, kSamplesShare + (1.0 - kSamplesShare) * fraction, words);
  });
  limit_to_samples(blend, heights);
  const double step = options.step > 0.0 ? options.step : kDefaultStep * blend.mean_residual(heights);
  const std::vector<std::uint16_t> codes = rounded(heights, step > 0.0 ? step : 1e-6 * layer.spacing, layer);
  layer.pixels = relief_image(layer, samples.places, codes, "relief");
  fit.heights = heights.size();
  fit.base_distance = blend.mean_residual({});
  fit.residual = blend.mean_residual(heights);
  fit.left_out =
      static_cast<double>(samples.left_out) / static_cast<double>(samples.left_out + samples.samples.size());
  return fit;
}

}  // namespace astrolith
