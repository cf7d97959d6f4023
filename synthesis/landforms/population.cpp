#include "synthesis/landforms/population.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "numerics/portable_double.h"
#include "synthesis/landforms/population_cells.h"

namespace astrolith {
namespace {

// What a layer's random numbers are for.
enum class Purpose : std::uint32_t { kLandform = 0x706f7000, kPlace = 0x706c6300, kCluster = 0x636c7500 };
constexpr std::uint32_t kCountDraw = 0xffffffffu;

// A place is drawn again where its weight or its cluster rejects it. All landforms together take at most so
// many places.
constexpr std::int64_t kMostPlacesTried = 20'000'000;
constexpr std::int64_t kPlacesBetweenReports = 1 << 15;

// The random numbers of a landform or a cluster. Sums of purpose and layer differ while layers are counted;
// a layer with a seed of its own may have any number, so that its key is a hash.
CounterRandom make_random(std::uint64_t seed, int layer_index, std::size_t landform,
                          Purpose purpose = Purpose::kLandform) {
  const auto layer = static_cast<std::uint32_t>(layer_index), use = static_cast<std::uint32_t>(purpose);
  const std::uint32_t key =
      layer_index > kMaxLayerSeed ? hash_append(hash_append(0, layer), use) : use + layer;
  return CounterRandom(seed, (std::uint64_t{key} << 32) + landform);
}

// A Poisson number, from the exponential waiting times between events.
int poisson_number(double mean, CounterRandom random) {
  int number = 0;
  for (double waited = -portable::log(1.0 - random.uniform()); waited < mean; ++number) {
    waited -= portable::log(1.0 - random.uniform());
  }
  return number;
}

int draw_count(const Population& population, const BareSurface& surface, const CounterRandom& random,
               const std::string& where) {
  if (population.count) return *population.count;
  const double mean = *population.density * surface.area();
  if (mean > 0.9 * kMaxDrawnLandforms) {  // far beyond chance
    throw InputError(fmt::format(
        "{}.density: would draw {:.3g} on this body, whose area is {:.4g}; at most 9e5 may be drawn: lower "
        "it",
        where, mean, surface.area()));
  }
  return poisson_number(mean, random);
}

Vec3d uniform_numbers(CounterRandom& random) {
  Vec3d numbers;
  numbers.x = random.uniform();
  numbers.y = random.uniform();
  numbers.z = random.uniform();
  return numbers;
}

// A landform that looks for its place, with random numbers of its own.
struct Seeker {
  std::size_t landform;
  CounterRandom random;
};

// Draws places that are weighted or clustered.
class PlaceSearch {
 public:
  PlaceSearch(const Population& population, const BareSurface& surface, std::uint64_t seed, int layer_index,
              const DrawingPlaces& places)
      : population_(population), surface_(surface), weight_(places.weight), progress_(places.progress) {
    if (!population.clusters) return;
    std::vector<Vec3d> random;
    for (int i = 0; i < population.clusters->number; ++i) {
      CounterRandom own = make_random(seed, layer_index, static_cast<std::size_t>(i), Purpose::kCluster);
      random.push_back(uniform_numbers(own));
    }
    centers_ = surface.scatter(random);
  }

  // Tries one place for each seeker. Sets the positions of those that found one, and marks them in `found`.
  void try_places(std::vector<Seeker>& seekers, std::vector<DrawnLandform>& landforms,
                  std::vector<char>& found) const {
    const auto count = static_cast<std::int64_t>(seekers.size());
    for (std::int64_t first = 0; first < count; first += kPlacesBetweenReports) {
      if (!report(progress_, 0.0, "places of landforms")) {
        throw WorkError("landforms: stopped before all had a place");
      }
      parallel_for(
          first, std::min(first + kPlacesBetweenReports, count),
          [&](std::int64_t i) {
            Seeker& seeker = seekers[static_cast<std::size_t>(i)];
            const std::optional<Vec3d> place = next_place(seeker.random);
            if (!place || !accepted(*place, seeker.random)) return;
            landforms[seeker.landform].position = *place;
            found[seeker.landform] = 1;
          },
          64);
    }
  }

 private:
  std::optional<Vec3d> next_place(CounterRandom& random) const {
    const bool clustered = population_.clusters && random.uniform() < population_.clusters->share;
    if (!clustered) return surface_.place(uniform_numbers(random));
    const Vec3d& center = centers_[random.below(centers_.size())];
    const double radius = population_.clusters->radius;
    const double east = radius * random.normal(), north = radius * random.normal();
    return surface_.place_beside(center, east, north);
  }
  bool accepted(const Vec3d& place, CounterRandom& random) const {
    return !weight_ || random.uniform() < static_cast<double>(weight_(place));
  }

  const Population& population_;
  const BareSurface& surface_;
  const PlaceWeight& weight_;
  const Progress& progress_;
  std::vector<Vec3d> centers_;
};

[[noreturn]] void fail_weight(const std::string& where, std::size_t without_place) {
  throw InputError(fmt::format(
      "{}: {} of its landforms found no place, since the locality, the mask or the clusters leave almost "
      "none; let them cover more of the body",
      where, without_place));
}

// A count is exact: each landform tries places until it has one. A density counts where the weight is 1:
// each landform tries one place, and vanishes where that is rejected.
void find_places(const Population& population, const BareSurface& surface, std::uint64_t seed,
                 int layer_index, const std::string& where, const DrawingPlaces& places,
                 std::vector<DrawnLandform>& landforms) {
  if (surface.area() == 0.0) return landforms.clear();
  const PlaceSearch search(population, surface, seed, layer_index, places);
  std::vector<Seeker> seekers;
  for (std::size_t i = 0; i < landforms.size(); ++i) {
    seekers.push_back({i, make_random(seed, layer_index, i, Purpose::kPlace)});
  }
  std::vector<char> found(landforms.size(), 0);
  std::int64_t tried = 0;
  while (!seekers.empty()) {
    tried += static_cast<std::int64_t>(seekers.size());
    search.try_places(seekers, landforms, found);
    std::erase_if(seekers, [&](const Seeker& s) { return found[s.landform] != 0; });
    if (!population.count) break;
    const bool in_vain =
        tried > kMostPlacesTried || (tried > kMostPlacesTried / 20 && seekers.size() == landforms.size());
    if (!seekers.empty() && in_vain) fail_weight(where, seekers.size());
  }
  std::size_t i = 0;
  std::erase_if(landforms, [&](const DrawnLandform&) { return found[i++] == 0; });
}

void place_uniformly(const BareSurface& surface, std::vector<DrawnLandform>& landforms) {
  std::vector<Vec3d> random(landforms.size());
  for (std::size_t i = 0; i < landforms.size(); ++i) random[i] = uniform_numbers(landforms[i].random);
  const std::vector<Vec3d> points = surface.scatter(random);
  for (std::size_t i = 0; i < points.size(); ++i) landforms[i].position = points[i];
}

// The diameter at quantile u in [0, 1) of the population's law N(> D) ~ D^-exponent between its limits.
double power_law_diameter(const Population& population, double u) {
  const double ratio = population.greatest_diameter / population.least_diameter;
  const double left_out = 1.0 - portable::pow(ratio, -population.exponent);
  return population.least_diameter * portable::pow(1.0 - u * left_out, -1.0 / population.exponent);
}

// Weibull's exponent (D / scale)^shape.
double weibull_exponent(const WeibullSizes& sizes, double diameter) {
  return portable::pow(diameter / sizes.scale, sizes.shape);
}

// The diameter at quantile u between the limits. Differences of exponents keep their digits where the law is
// far down its tail.
double weibull_diameter(const Population& population, double u) {
  const WeibullSizes& sizes = *population.weibull;
  const double least = weibull_exponent(sizes, population.least_diameter);
  const double fall = portable::exp(least - weibull_exponent(sizes, population.greatest_diameter));
  const double exponent = least - portable::log(1.0 - u * (1.0 - fall));
  return std::min(sizes.scale * portable::pow(exponent, 1.0 / sizes.shape), population.greatest_diameter);
}

}  // namespace

double diameter_at(const Population& population, double u) {
  return population.weibull ? weibull_diameter(population, u) : power_law_diameter(population, u);
}

double share_below(const Population& population, double diameter) {
  const double least = population.least_diameter, greatest = population.greatest_diameter;
  if (diameter >= greatest) return 1.0;
  // 1 - what is left above, over the same for the greatest diameter.
  const auto fallen = [&](double d) {
    if (!population.weibull) return 1.0 - portable::pow(d / least, -population.exponent);
    return 1.0 - portable::exp(weibull_exponent(*population.weibull, least) -
                               weibull_exponent(*population.weibull, d));
  };
  return fallen(diameter) / fallen(greatest);
}

std::vector<DrawnLandform> draw_population(const Population& population, const BareSurface& surface,
                                           std::uint64_t seed, int layer_index, const std::string& where,
                                           const DrawingPlaces& places) {
  if (population.by_cells) {
    return draw_population_by_cells(population, surface, seed, layer_index, where, places);
  }
  const int number = draw_count(population, surface, make_random(seed, layer_index, kCountDraw), where);
  std::vector<DrawnLandform> landforms(static_cast<std::size_t>(number));
  for (std::size_t i = 0; i < landforms.size(); ++i) {
    landforms[i].random = make_random(seed, layer_index, i);
    landforms[i].diameter = diameter_at(population, landforms[i].random.uniform());
  }
  if (places.weight || population.clusters) {
    find_places(population, surface, seed, layer_index, where, places, landforms);
  } else {
    place_uniformly(surface, landforms);
  }
  return landforms;
}

}  // namespace astrolith
