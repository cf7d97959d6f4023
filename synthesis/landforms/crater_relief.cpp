#include "synthesis/landforms/crater_relief.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "numerics/errors.h"

namespace astrolith {
namespace {

constexpr double kMostOverlaps =
    2000.0;                          // the most craters over a place on average, which bounds a point's cost
constexpr double kReliefClip = 2.0;  // bound of the relief of all craters, in the greatest relief of one

const CraterProfile& crater_profile(const CraterLayer& layer, bool complex) {
  return complex ? layer.complex : layer.simple;
}

PlacedCrater sized_crater(const CraterLayer& layer, double diameter, double age) {
  const bool complex = layer.complex_from && diameter >= *layer.complex_from;
  const CraterProfile& profile = crater_profile(layer, complex);
  return {{}, diameter, profile.depth * diameter, profile.rim_height * diameter, age, complex};
}

void expect_crater_fits(double diameter, const BareSurface& surface, const std::string& where) {
  if (diameter <= surface.longest_side()) return;
  throw InputError(where + "diameter: is " + std::to_string(diameter) + ", wider than the bare body, " +
                   std::to_string(surface.longest_side()) + "; lower it");
}

void place_listed(const CraterLayer& layer, const BareSurface& surface, const std::string& where,
                  std::vector<PlacedCrater>& out) {
  for (std::size_t i = 0; i < layer.craters.size(); ++i) {
    const Crater& crater = layer.craters[i];
    const std::string at = where + ".craters[" + std::to_string(i) + "].";
    expect_crater_fits(crater.diameter, surface, at);
    PlacedCrater placed = sized_crater(layer, crater.diameter, crater.age);
    placed.position = surface.find(crater.place, at + (crater.place.is_direction ? "direction" : "position"));
    if (crater.depth) placed.depth = *crater.depth;
    if (crater.rim_height) placed.rim_height = *crater.rim_height;
    out.push_back(placed);
  }
}

// The normal factor of a drawn crater's depth.
double deviating_factor(const CraterPopulation& population, CounterRandom& random) {
  if (population.depth_deviation == 0.0) return 1.0;
  return std::max(0.1, 1.0 + population.depth_deviation * std::clamp(random.normal(), -3.0, 3.0));
}

void place_drawn(const CraterLayer& layer, const BareSurface& surface, std::uint64_t seed, int layer_index,
                 const std::string& where, const DrawingPlaces& places, std::vector<PlacedCrater>& out) {
  const CraterPopulation& population = *layer.population;
  expect_crater_fits(population.drawn.greatest_diameter, surface, where + ".greatest_");
  for (DrawnLandform& drawn : draw_population(population.drawn, surface, seed, layer_index, where, places)) {
    const double age_share = drawn.random.uniform();
    PlacedCrater crater = sized_crater(layer, drawn.diameter, population.greatest_age * age_share);
    crater.position = drawn.position;
    const double factor = (1.0 + population.depth_spread * drawn.random.uniform(-1.0, 1.0)) *
                          (1.0 - population.degradation * age_share) *
                          deviating_factor(population, drawn.random);
    crater.depth *= factor;
    crater.rim_height *= factor;
    out.push_back(crater);
  }
}

// How many craters cover a place on average, of a population that is drawn by cells. A list of those in a
// region does not tell.
double coverage_by_cells(const CraterLayer& layer) {
  if (!layer.population || !layer.population->drawn.by_cells) return 0.0;
  constexpr int kSamples = 256;
  const Population& drawn = layer.population->drawn;
  const double extent = std::max(layer.simple.extent, layer.complex_from ? layer.complex.extent : 0.0);
  double area = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    const double across = extent * diameter_at(drawn, (i + 0.5) / kSamples);
    area += 0.25 * std::numbers::pi * across * across / kSamples;
  }
  return *drawn.density * area;
}

// Throws InputError if the craters would cover a ball as wide as the body more than kMostOverlaps times.
void expect_few_overlaps(const CraterLayer& layer, const std::vector<PlacedCrater>& craters,
                         const BareSurface& surface, const std::string& where) {
  double covered = 0.0;
  for (const PlacedCrater& crater : craters) {
    const double across =
        crater_profile(layer, crater.complex).extent * crater.diameter / surface.longest_side();
    covered += 0.25 * across * across;
  }
  covered = std::max(covered, coverage_by_cells(layer));
  if (covered <= kMostOverlaps) return;
  throw InputError(where + ": its craters would cover every place " + std::to_string(covered) +
                   " times, above " + std::to_string(static_cast<int>(kMostOverlaps)) +
                   "; use fewer or smaller ones");
}

CraterKernel make_kernel(const CraterProfile& profile, const PlacedCrater& crater, const Vec3d& center) {
  const double radius = 0.5 * crater.diameter;
  CraterKernel kernel{};
  kernel.x = static_cast<float>(center.x);
  kernel.y = static_cast<float>(center.y);
  kernel.z = static_cast<float>(center.z);
  kernel.inverse_radius_squared = static_cast<float>(1.0 / (radius * radius));
  kernel.depth = static_cast<float>(crater.depth);
  kernel.rim_height = static_cast<float>(crater.rim_height);
  kernel.sharpness = static_cast<float>(profile.sharpness);
  kernel.extent = static_cast<float>(profile.extent);
  kernel.extent_squared = kernel.extent * kernel.extent;
  kernel.inverse_flank_width = static_cast<float>(1.0 / (profile.extent - 1.0));
  kernel.flank = static_cast<float>(profile.flank);
  kernel.terraces = static_cast<float>(profile.terraces);
  kernel.peak_height = static_cast<float>(profile.peak_height * crater.diameter);
  kernel.inverse_peak_radius_squared = static_cast<float>(1.0 / (profile.peak_radius * profile.peak_radius));
  // Smoothing must end within the extent, where cavity and rim must therefore differ by it.
  const float cavity_there = crater_cavity(kernel, kernel.extent_squared);
  kernel.smoothing = std::min(static_cast<float>(profile.smoothing * crater.depth), cavity_there);
  return kernel;
}

ASTROLITH_SIMD_CLONES void apply_crater(const CraterKernel& kernel, int n, const float* __restrict x,
                                        const float* __restrict y, const float* __restrict z,
                                        float* __restrict elevation) {
  const CraterKernel crater = kernel;
#pragma omp simd
  for (int i = 0; i < n; ++i) {
    elevation[i] = cratered(crater, crater_distance_squared(crater, x[i], y[i], z[i]), elevation[i]);
  }
}

// So few points or craters are not split any more.
constexpr int kFewPoints = 16;
constexpr std::size_t kFewCraters = 64;

// Applies the craters that reach the points. The points are split into halves while many craters reach some
// of them only. A crater that does not reach a point changes nothing there.
void apply_reaching(const CraterKernel* craters, const BoxTree& tree, int n, const float* x, const float* y,
                    const float* z, float* elevation) {
  Box box;
  for (int i = 0; i < n; ++i) box.extend({x[i], y[i], z[i]});
  const std::vector<std::uint32_t> reaching = tree.touching(box);
  if (n > kFewPoints && reaching.size() > kFewCraters) {
    const int half = n / 2;
    apply_reaching(craters, tree, half, x, y, z, elevation);
    apply_reaching(craters, tree, n - half, x + half, y + half, z + half, elevation + half);
    return;
  }
  for (const std::uint32_t k : reaching) apply_crater(craters[k], n, x, y, z, elevation);
}

// Sets the base of each crater: the elevation at its centre after the older craters that are no smaller.
void find_bases(std::span<const PlacedCrater> placed, std::span<const float> elevations,
                std::vector<CraterKernel>& craters) {
  const BoxTree tree = crater_tree(craters);
  for (std::size_t i = 0; i < craters.size(); ++i) {
    CraterKernel& crater = craters[i];
    const Vec3d center{crater.x, crater.y, crater.z};
    float base = elevations[i];
    for (const std::uint32_t k : tree.touching({center, center})) {
      if (k >= i) break;
      if (placed[k].diameter < placed[i].diameter) continue;
      base = cratered(craters[k], crater_distance_squared(craters[k], crater.x, crater.y, crater.z), base);
    }
    crater.base = base;
  }
}

}  // namespace

std::vector<PlacedCrater> place_craters(const CraterLayer& layer, const BareSurface& surface,
                                        std::uint64_t seed, int layer_index, const std::string& where,
                                        const DrawingPlaces& places) {
  std::vector<PlacedCrater> craters;
  if (surface.empty()) return craters;
  place_listed(layer, surface, where, craters);
  if (layer.population) {
    place_drawn(layer, surface, seed, layer_index, where + ".population", places, craters);
  }
  expect_few_overlaps(layer, craters, surface, where);
  std::stable_sort(craters.begin(), craters.end(),
                   [](const PlacedCrater& a, const PlacedCrater& b) { return a.age > b.age; });
  return craters;
}

double largest_rise(const CraterLayer& layer) {
  double greatest = 0.0;
  const auto include = [&](double diameter, double factor) {
    for (const bool complex : {false, true}) {
      if (complex && !layer.complex_from) continue;
      const CraterProfile& profile = crater_profile(layer, complex);
      const double relief = std::max(profile.depth, profile.rim_height) * factor + profile.peak_height;
      greatest = std::max(greatest, diameter * relief);
    }
  };
  for (const Crater& crater : layer.craters) {
    include(crater.diameter, 1.0);
    greatest = std::max(greatest, std::max(crater.depth.value_or(0.0), crater.rim_height.value_or(0.0)) +
                                      layer.complex.peak_height * crater.diameter);
  }
  if (layer.population) {
    const CraterPopulation& drawn = *layer.population;
    include(drawn.drawn.greatest_diameter, (1.0 + drawn.depth_spread) * (1.0 + 3.0 * drawn.depth_deviation));
  }
  return kReliefClip * greatest;
}

BoxTree crater_tree(std::span<const CraterKernel> craters) {
  std::vector<Box> boxes;
  for (const CraterKernel& crater : craters) boxes.push_back(crater_reach(crater));
  return BoxTree(boxes);
}

CraterRelief make_crater_relief(const CraterLayer& layer, std::span<const PlacedCrater> oldest_first,
                                std::span<const Vec3d> centers, std::span<const float> elevations,
                                double bound_before, ArrayStore& arrays) {
  double greatest = 0.0;
  std::vector<CraterKernel> craters;
  for (std::size_t i = 0; i < oldest_first.size(); ++i) {
    const PlacedCrater& crater = oldest_first[i];
    craters.push_back(make_kernel(crater_profile(layer, crater.complex), crater, centers[i]));
    const double peak = double{craters.back().peak_height};
    greatest = std::max({greatest, crater.depth, crater.rim_height + peak});
  }
  find_bases(oldest_first, elevations, craters);
  // Which of the craters drawn by cells is the largest depends on the region; the bound must not.
  const bool by_cells = layer.population && layer.population->drawn.by_cells;
  const double rise = by_cells ? largest_rise(layer) : kReliefClip * greatest;
  return {arrays.add(craters), bound_before + rise, 0};
}

void apply_craters(const CraterRelief& relief, const ArrayView& arrays, const BoxTree& tree, int n,
                   const float* x, const float* y, const float* z, float* elevation) {
  apply_reaching(arrays[relief.craters], tree, n, x, y, z, elevation);
  const float clip = static_cast<float>(relief.elevation_bound);
  for (int i = 0; i < n; ++i) elevation[i] = math::clamp(elevation[i], -clip, clip);
}

}  // namespace astrolith
