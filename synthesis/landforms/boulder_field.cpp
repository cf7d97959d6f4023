#include "synthesis/landforms/boulder_field.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "gravity/vertical_directions.h"
#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "numerics/interval.h"
#include "numerics/parallel_for.h"
#include "numerics/portable_angles.h"

namespace astrolith {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr std::int64_t kBouldersBetweenReports = 4096;
constexpr double kLeastUpward = 0.0872;  // cosine of 85 degrees: nothing rests on steeper ground

void expect_boulder_fits(double axis, const BareSurface& surface, const std::string& where) {
  if (axis <= surface.longest_side()) return;
  throw InputError(where + ": is " + std::to_string(axis) + ", longer than the bare body, " +
                   std::to_string(surface.longest_side()) + "; lower it");
}

// The outermost point with F = 0 on the normal through a point of the bare surface, as far as steps of a part
// of the heights' bound tell. The point of the bare surface where there is none.
Vec3d outermost_ground(const Vec3d& bare, const Vec3d& normal, const Terrain& terrain) {
  constexpr int kSteps = 64, kHalvings = 24;
  const double step = 2.0 * terrain.height_bound / kSteps;
  const auto inside = [&](double height) { return terrain.field(bare + height * normal) > 0.0; };
  double height = terrain.height_bound;
  while (height > -terrain.height_bound && !inside(height)) height -= step;
  if (!(height > -terrain.height_bound)) return bare;
  double in = height, out = height + step;
  for (int halving = 0; halving < kHalvings; ++halving) {
    const double middle = 0.5 * (in + out);
    (inside(middle) ? in : out) = middle;
  }
  return bare + in * normal;
}

// The point with F = 0 on the normal through a point of the bare surface. F falls by about 1 for each length
// unit along the normal, so that each step goes by F; where it does not, the steps miss the ground.
Vec3d on_terrain(const Vec3d& bare, const Vec3d& normal, const Terrain& terrain) {
  double height = 0.0;
  for (int step = 0; step < 12; ++step) {
    const double change = terrain.field(bare + height * normal);
    height = std::clamp(height + change, -terrain.height_bound, terrain.height_bound);
    if (std::fabs(change) < 1e-4 * terrain.height_bound) return bare + height * normal;
  }
  return outermost_ground(bare, normal, terrain);
}

// Sets the boulder's axes from its heading and tilt about the upright direction.
void turn(const Vec3d& upright, PlacedBoulder& boulder) {
  Vec3d east = cross(Vec3d{0, 0, 1}, upright);
  east = norm(east) > 1e-6 ? normalized(east) : Vec3d{1, 0, 0};
  const Vec3d north = cross(upright, east);
  const double heading = boulder.heading * kDegree, tilt = boulder.tilt * kDegree;
  Vec3d(&axis)[3] = boulder.directions;
  axis[0] = portable::cos(heading) * east + portable::sin(heading) * north;
  const Vec3d level = cross(upright, axis[0]);
  axis[1] = portable::cos(tilt) * level + portable::sin(tilt) * upright;
  axis[2] = portable::cos(tilt) * upright - portable::sin(tilt) * level;
}

struct Placement {
  Vec3d bare;  // on the bare surface
  PlacedBoulder boulder;
  std::optional<std::uint32_t> noise_seed = std::nullopt;  // absent: from the index in the list
};

void find_listed(const BoulderLayer& layer, const BareSurface& surface, const std::string& where,
                 std::vector<Placement>& out) {
  for (std::size_t i = 0; i < layer.boulders.size(); ++i) {
    const Boulder& b = layer.boulders[i];
    const std::string at = where + ".boulders[" + std::to_string(i) + "].";
    expect_boulder_fits(std::max({b.axes.x, b.axes.y, b.axes.z}), surface, at + "axes");
    const Vec3d bare = surface.find(b.place, at + (b.place.is_direction ? "direction" : "position"));
    out.push_back({bare, {{}, {}, b.axes, b.heading, b.tilt, b.burial, 0}});
  }
}

void draw(const BoulderLayer& layer, const BareSurface& surface, std::uint64_t seed, int layer_index,
          const std::string& where, const DrawingPlaces& places, std::vector<Placement>& out) {
  const BoulderPopulation& population = *layer.population;
  expect_boulder_fits(population.drawn.greatest_diameter, surface, where + ".greatest_diameter");
  for (DrawnLandform& drawn : draw_population(population.drawn, surface, seed, layer_index, where, places)) {
    CounterRandom& random = drawn.random;
    const auto spread = [&](double ratio) {
      const double factor = 1.0 + population.ratio_spread * random.uniform(-1.0, 1.0);
      return std::clamp(ratio * factor, kMinAxisRatio, 1.0);
    };
    PlacedBoulder boulder;
    const double b = spread(population.axis_ratios.y / population.axis_ratios.x);
    const double c = spread(population.axis_ratios.z / population.axis_ratios.x);
    boulder.axes = drawn.diameter * Vec3d{1.0, b, c};
    boulder.heading = 360.0 * random.uniform();
    boulder.tilt = population.greatest_tilt * random.uniform(-1.0, 1.0);
    boulder.burial = random.uniform(population.least_burial, population.greatest_burial);
    out.push_back({drawn.position, boulder});
    // The index in the list of a boulder that is drawn by cells depends on the region.
    if (population.drawn.by_cells) out.back().noise_seed = static_cast<std::uint32_t>(random.next());
  }
}

// The facets of a boulder: their frame, turned at random, and their depths in seven steps.
void add_facets(double angularity, BoulderKernel& kernel) {
  constexpr double kDeepest = 2.0 / 3.0;  // 1 / (1 + this): the least distance from the centre, in half axes
  if (!(angularity > 0.0)) return;
  CounterRandom random(hash_append(kernel.seed, 0xface7u));
  const Vec3d first = normalized(Vec3d{random.normal(), random.normal(), random.normal()}),
              second = normalized(cross(first, Vec3d{random.normal(), random.normal(), random.normal()}));
  kernel.facet_axes[0] = to_float(first);
  kernel.facet_axes[1] = to_float(second);
  kernel.facet_axes[2] = to_float(cross(first, second));
  kernel.facet_step = static_cast<float>(kDeepest * angularity / 7.0);
  for (std::uint32_t& depths : kernel.facet_depths) depths = static_cast<std::uint32_t>(random.next());
}

BoulderKernel make_kernel(const BoulderLayer& layer, const PlacedBoulder& boulder) {
  const Vec3d half = 0.5 * boulder.axes;
  const double least = std::min({half.x, half.y, half.z});
  // |distance| is at least |1 - |u|| times the least half axis. Beyond this |u| neither the noise nor the
  // smoothing reaches F = 0.
  const double reach = 1.0 + layer.smoothing + layer.roughness;
  BoulderKernel kernel{
      to_float(boulder.center),
      {to_float(boulder.directions[0] * (1.0 / half.x)), to_float(boulder.directions[1] * (1.0 / half.y)),
       to_float(boulder.directions[2] * (1.0 / half.z))},
      to_float({1.0 / half.x, 1.0 / half.y, 1.0 / half.z}),
      static_cast<float>(1e-6 / least),
      static_cast<float>(layer.smoothing * least),
      static_cast<float>(layer.roughness * least),
      boulder.noise_seed,
      static_cast<float>(reach * reach),
      0.0f,
      {},
      {}};
  add_facets(layer.angularity, kernel);
  return kernel;
}

// The extent of a boulder about the origin along a direction, with its roughness, by bisection.
double extent_along(const BoulderKernel& kernel, const Vec3d& direction, double longest) {
  double in = 0.0, out = longest;
  for (int halving = 0; halving < 30; ++halving) {
    const double middle = 0.5 * (in + out);
    const Vec3f p = to_float(middle * direction);
    (boulder_distance(kernel, boulder_coordinates(kernel, p.x, p.y, p.z)) > 0.0f ? in : out) = middle;
  }
  return in;
}

// Places a boulder as deep in the ground as its burial says, measured along the upright direction through its
// centre. A boulder of any shape therefore touches the ground.
void settle(const BoulderLayer& layer, const Vec3d& ground, const Vec3d& upright, PlacedBoulder& boulder) {
  turn(upright, boulder);
  const BoulderKernel kernel = make_kernel(layer, boulder);
  const double longest = std::max({boulder.axes.x, boulder.axes.y, boulder.axes.z});
  const double above = extent_along(kernel, upright, longest),
               below = extent_along(kernel, -upright, longest);
  boulder.center = ground + (below - boulder.burial * (above + below)) * upright;
}

// The verticals at all places; none for a layer without gravity.
std::vector<Vec3d> find_verticals(const BoulderLayer& layer, const BareSurface& surface,
                                  const std::string& where, std::span<const Placement> placements) {
  if (!layer.gravity || placements.empty()) return {};
  if (surface.mesh().triangles.empty()) {
    throw InputError(where + ".gravity: the bare body is too thin for its gravity to be known; leave it out");
  }
  std::vector<Vec3d> places;
  places.reserve(placements.size());
  for (const Placement& p : placements) places.push_back(p.bare);
  return vertical_directions_at(surface.mesh(), places,
                                {layer.gravity->density, layer.gravity->rotation_period});
}

// The box of a boulder whose axes are longer by the factor `reach`.
Box reach_box(const PlacedBoulder& boulder, double reach) {
  const Vec3d half = 0.5 * boulder.axes;
  const auto extent = [&](double x, double y, double z) {
    return reach * norm(Vec3d{half.x * x, half.y * y, half.z * z});
  };
  const Vec3d(&d)[3] = boulder.directions;
  const Vec3d e{extent(d[0].x, d[1].x, d[2].x), extent(d[0].y, d[1].y, d[2].y),
                extent(d[0].z, d[1].z, d[2].z)};
  const Box box{boulder.center - e, boulder.center + e};
  return widened(box, 1e-5 * norm(e) + 2e-6 * largest_coordinate(box));
}

// Most boulders of a block reach few of its points, and a point's place in a boulder costs little beside the
// noise and the facets there: runs of points that the boulder does not reach are passed over.
ASTROLITH_SIMD_CLONES void join_boulder_loop(const BoulderKernel& kernel, int n, const float* __restrict x,
                                             const float* __restrict y, const float* __restrict z,
                                             float* __restrict field) {
  constexpr int kRun = 16;
  const BoulderKernel boulder = kernel;
  for (int first = 0; first < n; first += kRun) {
    const int end = first + kRun < n ? first + kRun : n;
    int reached = 0;
#pragma omp simd reduction(| : reached)
    for (int i = first; i < end; ++i) reached |= is_within_reach(boulder, x[i], y[i], z[i]) ? 1 : 0;
    if (reached == 0) continue;
#pragma omp simd
    for (int i = first; i < end; ++i) field[i] = join_boulder(boulder, x[i], y[i], z[i], field[i]);
  }
}

}  // namespace

// The centre lies within 0.75 diameters of the ground, with the roughness that the extents include. From
// there the boulder reaches half a diameter, with its noise and its joint more.
double drawn_reach(const BoulderLayer& layer) {
  return 0.75 + 0.5 * (1.0 + layer.smoothing + layer.roughness);
}

std::vector<PlacedBoulder> place_boulders(const BoulderLayer& layer, const BareSurface& surface,
                                          const Terrain& terrain, std::uint64_t seed, int layer_index,
                                          const std::string& where, const Progress& progress,
                                          const DrawingPlaces& places) {
  if (surface.empty()) return {};
  std::vector<Placement> placements;
  find_listed(layer, surface, where, placements);
  if (layer.population) draw(layer, surface, seed, layer_index, where + ".population", places, placements);
  const std::vector<Vec3d> verticals = find_verticals(layer, surface, where, placements);
  const std::uint32_t layer_seed = hash_seed(seed, static_cast<std::uint32_t>(layer_index));
  const auto count = static_cast<std::int64_t>(placements.size());
  for (std::int64_t first = 0; first < count; first += kBouldersBetweenReports) {
    if (!report(progress, static_cast<double>(first) / static_cast<double>(count), "boulders")) {
      throw WorkError("boulders: stopped before all were placed");
    }
    parallel_for(first, std::min(first + kBouldersBetweenReports, count), [&](std::int64_t i) {
      Placement& p = placements[static_cast<std::size_t>(i)];
      const Vec3d normal = surface.normal(p.bare);
      const Vec3d vertical = verticals.empty() ? normal : verticals[static_cast<std::size_t>(i)];
      const Vec3d upright = dot(vertical, normal) > kLeastUpward ? vertical : normal;
      p.boulder.noise_seed = p.noise_seed.value_or(hash_append(layer_seed, static_cast<std::uint32_t>(i)));
      settle(layer, on_terrain(p.bare, normal, terrain), upright, p.boulder);
    });
  }
  std::vector<PlacedBoulder> boulders;
  for (const Placement& p : placements) boulders.push_back(p.boulder);
  return boulders;
}

std::vector<FieldBoulder> field_boulders(const BoulderLayer& layer, std::span<const PlacedBoulder> boulders) {
  std::vector<FieldBoulder> joined;
  for (const PlacedBoulder& boulder : boulders) {
    joined.push_back(
        {make_kernel(layer, boulder), reach_box(boulder, 1.0 + layer.smoothing + layer.roughness)});
  }
  return joined;
}

void join_boulder(const BoulderKernel& kernel, int n, const float* x, const float* y, const float* z,
                  float* field) {
  join_boulder_loop(kernel, n, x, y, z, field);
}

}  // namespace astrolith
