#include "estimation/shape/relief/relief_fit.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "estimation/shape/relief/relief_solver.h"
#include "geometry/mesh_measure.h"
#include "numerics/errors.h"
#include "numerics/portable_double.h"
#include "recipe/compact/height_picture.h"
#include "synthesis/relief/relief_picture.h"

namespace astrolith {
namespace {

constexpr double kDefaultStep = 4.0;  // mean residuals: rounding adds a tenth to the residual
constexpr int kMostLevels = 65535;
// Places for each vertex of the surface; models of few vertices get more, since their facets are what is to
// be kept.
constexpr double kPlacesOfVertex = 1.2, kMostPlacesOfVertex = 12.0, kPlacesOfSmallModel = 20000.0;

// The least spacing that the picture and the cells of a body without folds bear. In the picture the maps of
// the three axes stand below one another, and show the body from both sides.
double least_spacing(const TriangleMesh& surface) {
  const Box box = surface.bounds();
  const Vec3d extent = box.extent();
  const double of_picture =
      std::max(extent.x + extent.y + extent.z, 2.0 * box.longest_side()) / kMostHeightPictureSide;
  const double of_cells = portable::cbrt(extent.x * extent.y * extent.z / kMostReliefCells) / kReliefCell;
  return 1.03 * std::max(of_picture, of_cells);
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

std::shared_ptr<ExemplarImage> picture_of(const ReliefLayer& layer, const std::vector<ReliefPlace>& places,
                                          const std::vector<std::uint16_t>& codes) {
  const ReliefLayout layout = relief_layout(places);
  if (std::max(layout.width, layout.height) > kMostHeightPictureSide) {
    throw InputError("relief.spacing: would take a picture of heights of more than " +
                     std::to_string(kMostHeightPictureSide) + " pixels a side on this body; make it larger");
  }
  auto image = std::make_shared<ExemplarImage>();
  // Programs read no image that is smaller.
  image->width = std::max(layout.width, kLeastExemplarSide),
  image->height = std::max(layout.height, kLeastExemplarSide);
  image->values.assign(static_cast<std::size_t>(image->width) * static_cast<std::size_t>(image->height), 0);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::size_t row = layout.pixels[i] / static_cast<std::size_t>(layout.width),
                      column = layout.pixels[i] % static_cast<std::size_t>(layout.width);
    image->values[row * static_cast<std::size_t>(image->width) + column] = layer.value_of(codes[i]);
  }
  return image;
}

}  // namespace

double least_relief_spacing(const TriangleMesh& surface) {
  const double vertices = static_cast<double>(surface.vertices.size());
  const double places =
      std::max(kPlacesOfVertex * vertices, std::min(kMostPlacesOfVertex * vertices, kPlacesOfSmallModel));
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
  layer.pixels = picture_of(layer, samples.places, codes);
  fit.heights = heights.size();
  fit.base_distance = blend.mean_residual({});
  fit.residual = blend.mean_residual(heights);
  fit.left_out =
      static_cast<double>(samples.left_out) / static_cast<double>(samples.left_out + samples.samples.size());
  return fit;
}

}  // namespace astrolith
