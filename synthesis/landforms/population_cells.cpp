#include "synthesis/landforms/population_cells.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "numerics/errors.h"
#include "numerics/interval.h"
#include "numerics/parallel_for.h"
#include "numerics/portable_double.h"

namespace astrolith {
namespace {

constexpr int kMostClasses = 64;            // sizes 2^64 apart
constexpr double kLeastPerCell = 4.0;       // cells of rare landforms are made wider until they hold so many
constexpr double kCellInDiameters = 4.0;    // the narrowest cells of a class, in its greatest diameter
constexpr double kShellInCells = 0.25;      // half the thickness of the shell whose points are projected
constexpr double kMostClassCells = 0x1p26;  // cells that one class looks through

// A class of sizes, upper / 2 .. upper, and its lattice. The last class may begin below the least diameter.
// What it draws there is dropped, so that a lower least diameter changes no landform above it.
struct SizeClass {
  int number;
  double low_share, high_share;  // share_below() the class and below its upper end
  double upper;                  // length units
  double density;                // per squared length unit, where the weight is 1
  double cell;                   // side of a cell, length units
  double shell() const { return kShellInCells * cell; }
};

double upper_diameter(const Population& population, int number) {
  return population.greatest_diameter * portable::pow(2.0, -number);
}

// Cells are the greatest diameter times a power of two, so that rounding cannot move them.
double cell_side(const Population& population, int number, double density, double widest) {
  double cell = kCellInDiameters * upper_diameter(population, number);
  while (density * cell * cell < kLeastPerCell && 2.0 * cell <= widest) cell *= 2.0;
  return cell;
}

std::vector<SizeClass> make_size_classes(const Population& population, const BareSurface& surface) {
  const double widest = kCellInDiameters * kGreatestByCells * surface.longest_side();
  std::vector<SizeClass> classes;
  for (int k = 0; k < kMostClasses; ++k) {
    const double upper = upper_diameter(population, k), lower = upper_diameter(population, k + 1);
    if (k > 0 && upper <= population.least_diameter) break;
    const double low = share_below(population, lower), high = share_below(population, upper);
    const double density = *population.density * (high - low);
    classes.push_back({k, low, high, upper, density, cell_side(population, k, density, widest)});
  }
  return classes;
}

// What a class adds to the variance of heights, up to a factor: a landform of diameter D covers about D^2 and
// is about D high.
double class_variance(const Population& population, const SizeClass& size) {
  constexpr int kSamples = 16;
  double sum = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    const double low = std::max(size.low_share, 0.0);
    const double u = low + (i + 0.5) / kSamples * (size.high_share - low);
    const double d = diameter_at(population, u);
    sum += d * d * d * d / kSamples;
  }
  return (size.high_share - std::max(size.low_share, 0.0)) * sum;
}

struct Cell {
  std::int64_t x, y, z;
};

// The stream of a cell's random numbers: 64 bits of its place, from two hashes.
CounterRandom make_random(std::uint64_t seed, int layer_index, int size_class, const Cell& cell) {
  const auto half = [&](std::uint32_t salt) {
    const std::uint32_t h = hash_append(hash_seed(seed, static_cast<std::uint32_t>(layer_index)), salt);
    return hash_wide_cell(hash_append(h, static_cast<std::uint32_t>(size_class)), cell.x, cell.y, cell.z);
  };
  return CounterRandom(seed, (std::uint64_t{half(0x63656c6cu)} << 32) + half(0x68616c66u));
}

// The cells of a class that meet a box, in a fixed order.
struct CellRange {
  std::int64_t first[3], count[3];

  CellRange(const Box& box, double cell) {
    const double low[3] = {box.min.x, box.min.y, box.min.z}, high[3] = {box.max.x, box.max.y, box.max.z};
    for (int axis = 0; axis < 3; ++axis) {
      first[axis] = static_cast<std::int64_t>(std::floor(low[axis] / cell));
      const auto last = static_cast<std::int64_t>(std::floor(high[axis] / cell));
      count[axis] = std::max<std::int64_t>(last - first[axis] + 1, 0);
    }
  }
  double total() const {
    return static_cast<double>(count[0]) * static_cast<double>(count[1]) * static_cast<double>(count[2]);
  }
  Cell operator[](std::int64_t i) const {
    return {first[0] + i % count[0], first[1] + i / count[0] % count[1],
            first[2] + i / (count[0] * count[1])};
  }
};

class CellDrawing {
 public:
  CellDrawing(const Population& population, const BareSurface& surface, std::uint64_t seed, int layer_index,
              const DrawingPlaces& places)
      : population_(population), surface_(surface), seed_(seed), layer_index_(layer_index), places_(places) {}

  // The landforms of a class that matter to the region.
  void add(const SizeClass& size, const std::string& where, std::vector<DrawnLandform>& out) const {
    const std::optional<Box> region = class_region(size);
    Box box = widened(surface_.bounds(), size.shell());
    if (region) box = common(box, widened(*region, size.shell()));
    if (!valid(box)) return;
    const CellRange cells(box, size.cell);
    if (cells.total() > kMostClassCells) fail(where, "look through more cells than 6e7");
    constexpr std::int64_t kBatch = 4096;
    const auto total = static_cast<std::int64_t>(cells.total());
    std::vector<std::vector<DrawnLandform>> drawn(static_cast<std::size_t>(std::min(total, kBatch)));
    for (std::int64_t first = 0; first < total; first += kBatch) {
      if (!report(places_.progress, 0.0, "landforms"))
        throw WorkError("landforms: stopped before all were drawn");
      const std::int64_t count = std::min(kBatch, total - first);
      parallel_for(0, count, [&](std::int64_t i) {
        auto& mine = drawn[static_cast<std::size_t>(i)];
        mine.clear();
        draw_cell(size, cells[first + i], region, mine);
      });
      for (std::int64_t i = 0; i < count; ++i) {
        const auto& mine = drawn[static_cast<std::size_t>(i)];
        out.insert(out.end(), mine.begin(), mine.end());
      }
      if (out.size() > kMaxDrawnLandforms) fail(where, "draw more than 1e6 landforms");
    }
  }

 private:
  static Box common(const Box& a, const Box& b) {
    return {{std::max(a.min.x, b.min.x), std::max(a.min.y, b.min.y), std::max(a.min.z, b.min.z)},
            {std::min(a.max.x, b.max.x), std::min(a.max.y, b.max.y), std::min(a.max.z, b.max.z)}};
  }
  static bool valid(const Box& b) { return b.min.x <= b.max.x && b.min.y <= b.max.y && b.min.z <= b.max.z; }

  [[noreturn]] static void fail(const std::string& where, const char* what) {
    throw InputError(fmt::format(
        "{}.density: would {} here; lower it, raise least_diameter, or make a smaller patch", where, what));
  }

  // The box on the bare surface where landforms of a class matter to the region: the feet of the points
  // within their reach. Layers may lift the surface by many times the region's side, but along normals.
  std::optional<Box> class_region(const SizeClass& size) const {
    if (!places_.region) return std::nullopt;
    const double reach = places_.reach * size.upper;
    return common(foot_box(widened(*places_.region, reach)),
                  widened(*places_.region, reach + places_.margin));
  }

  // A box around the projections of the points of a box on the bare surface: of a lattice of points, with two
  // of its steps for those between.
  Box foot_box(const Box& box) const {
    constexpr int kSteps = 8;
    const Vec3d step = box.extent() * (1.0 / kSteps);
    Box feet;
    for (int i = 0; i <= kSteps; ++i) {
      for (int j = 0; j <= kSteps; ++j) {
        for (int k = 0; k <= kSteps; ++k) {
          feet.extend(surface_.projected(box.min + Vec3d{i * step.x, j * step.y, k * step.z}));
        }
      }
    }
    return widened(feet, 2.0 * std::max({step.x, step.y, step.z}));
  }

  void draw_cell(const SizeClass& size, const Cell& cell, const std::optional<Box>& region,
                 std::vector<DrawnLandform>& out) const {
    const double side = size.cell, shell = size.shell();
    const Vec3d corner{side * static_cast<double>(cell.x), side * static_cast<double>(cell.y),
                       side * static_cast<double>(cell.z)};
    const Vec3d middle = corner + Vec3d{0.5 * side, 0.5 * side, 0.5 * side};
    const double across = surface_.lipschitz_bound() * 0.8661 * side;
    const double rounding = 1e-5 * largest_coordinate(surface_.bounds());
    if (std::fabs(surface_.value(middle)) > across + shell + rounding) return;
    CounterRandom random = make_random(seed_, layer_index_, size.number, cell);
    const double mean = size.density / (2.0 * shell) * side * side * side;
    for (double waited = next_event(random); waited < mean; waited += next_event(random)) {
      Vec3d p{random.uniform(), random.uniform(), random.uniform()};
      p = corner + side * p;
      const CounterRandom own(random.next(), static_cast<std::uint64_t>(size.number));
      if (std::fabs(surface_.value(p)) < shell) add_landform(size, p, region, own, out);
    }
  }
  static double next_event(CounterRandom& random) { return -portable::log(1.0 - random.uniform()); }

  void add_landform(const SizeClass& size, const Vec3d& p, const std::optional<Box>& region,
                    CounterRandom own, std::vector<DrawnLandform>& out) const {
    DrawnLandform landform;
    landform.position = surface_.projected(p);
    if (region && !boxes_touch(*region, {landform.position, landform.position})) return;
    const double u = size.low_share + own.uniform() * (size.high_share - size.low_share);
    landform.diameter = diameter_at(population_, u);
    const double chance = own.uniform();
    if (landform.diameter < population_.least_diameter) return;
    if (places_.weight && !(chance < static_cast<double>(places_.weight(landform.position)))) return;
    landform.random = own;
    out.push_back(landform);
  }

  const Population& population_;
  const BareSurface& surface_;
  std::uint64_t seed_;
  int layer_index_;
  const DrawingPlaces& places_;
};

}  // namespace

SizesByCells sizes_by_cells(const Population& population, const BareSurface& surface, bool whole_body) {
  const double finest = kLeastByCells * largest_coordinate(surface.bounds());
  SizesByCells sizes;
  sizes.least = population.greatest_diameter;
  double number = 0.0, variance = 0.0, left_out = 0.0;
  for (const SizeClass& size : make_size_classes(population, surface)) {
    const double lower = std::max(population.least_diameter, 0.5 * size.upper);
    const double size_density = *population.density * (size.high_share - std::max(size.low_share, 0.0)),
                 on_body = size_density * surface.area(), part = class_variance(population, size);
    variance += part;
    const bool few = !whole_body || number + on_body <= kMostByCellsOnBody;
    if (sizes.classes == size.number && lower >= finest && few) {
      number += on_body;
      sizes.classes = size.number + 1;
      sizes.least = lower;
    } else {
      left_out += part;
      sizes.number_left_out += on_body;
    }
  }
  sizes.share_left_out = variance > 0.0 ? left_out / variance : 0.0;
  return sizes;
}

std::vector<DrawnLandform> draw_population_by_cells(const Population& population, const BareSurface& surface,
                                                    std::uint64_t seed, int layer_index,
                                                    const std::string& where, const DrawingPlaces& places) {
  const double most = kGreatestByCells * surface.longest_side();
  if (population.greatest_diameter > most) {
    throw InputError(
        fmt::format("{}.greatest_diameter: is {:.4g}, and landforms drawn by cells are at most 1/32 of the "
                    "body, {:.4g}; lower it, or leave out by_cells",
                    where, population.greatest_diameter, most));
  }
  std::vector<DrawnLandform> landforms;
  if (*population.density == 0.0) return landforms;
  const SizesByCells sizes = sizes_by_cells(population, surface, !places.region);
  const CellDrawing drawing(population, surface, seed, layer_index, places);
  for (const SizeClass& size : make_size_classes(population, surface)) {
    if (size.number < sizes.classes) drawing.add(size, where, landforms);
  }
  return landforms;
}

}  // namespace astrolith
