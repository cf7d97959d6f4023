#include "estimation/shape/packing/sphere_packing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "estimation/shape/packing/clearance_grid.h"
#include "geometry/mesh_measure.h"
#include "numerics/files/output_file.h"
#include "numerics/length_unit.h"

namespace astrolith {
namespace {

double cube(double x) { return x * x * x; }

double kilograms(const PackingTable& table) {
  return table.density * table.body_volume * cube(metres_per_unit(table.length_unit));
}

// Cells of the grid inside the body: this many for each sphere, so that a cell is small beside a sphere.
constexpr double kCellsPerSphere = 250.0;
constexpr double kFewestCells = 50000.0;

// Width, in steps of the grid, of the bins that places are sorted into by clearance.
constexpr double kBinSteps = 0.25;

// The climb from a cell's centre to a Voronoi node: length of the first step, factor between steps, and
// number of steps.
constexpr double kFirstClimb = 0.5;  // steps of the grid
constexpr double kClimbDecay = 0.7;
constexpr int kClimbs = 10;

// The nearest obstacle of a point: the surface or a placed sphere.
struct Obstacle {
  double distance;  // negative inside a placed sphere
  Vec3d away;       // unit direction that leads away from it
};

class Packer {
 public:
  Packer(const TriangleMesh& body, const SurfaceTree& tree, const PackingOptions& options)
      : tree_(tree),
        options_(options),
        grid_(make_clearance_grid(body, tree, std::max(kFewestCells, kCellsPerSphere * options.max_spheres))),
        bin_width_(kBinSteps * grid_.step),
        smallest_(options.smallest_radius * body.bounds().diagonal()) {}

  Packing run(const Progress& progress) {
    Packing packing;
    sort_places();
    while (!bins_.empty() && !full() && !packing.interrupted) {
      packing.interrupted = !report(progress, static_cast<double>(spheres_.size()) / options_.max_spheres,
                                    std::to_string(spheres_.size()) + " spheres");
      empty_last_bin();
    }
    packing.spheres = std::move(spheres_);
    std::stable_sort(packing.spheres.begin(), packing.spheres.end(),
                     [](const Sphere& a, const Sphere& b) { return a.radius > b.radius; });
    return packing;
  }

 private:
  struct Place {
    float clearance;
    std::uint32_t cell;
  };

  bool full() const { return spheres_.size() >= static_cast<std::size_t>(options_.max_spheres); }
  std::size_t clearance_bin(float clearance) const {
    return static_cast<std::size_t>(clearance / bin_width_);
  }

  void sort_places() {
    float largest = 0.0f;
    for (const float c : grid_.clearance) largest = std::max(largest, c);
    bins_.resize(clearance_bin(largest) + 1);
    for (std::size_t i = 0; i < grid_.clearance.size(); ++i) {
      if (grid_.clearance[i] > 0.0f)
        bins_[clearance_bin(grid_.clearance[i])].push_back(static_cast<std::uint32_t>(i));
    }
  }

  // Places spheres at the cells of the last bin, the largest clearance first. A cell whose clearance has sunk
  // since it was sorted goes to the bin that it belongs to now.
  void empty_last_bin() {
    const std::vector<std::uint32_t> cells = std::move(bins_.back());
    bins_.pop_back();
    std::vector<Place> places;
    for (const std::uint32_t cell : cells) places.push_back({grid_.clearance[cell], cell});
    std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
      return a.clearance > b.clearance || (a.clearance == b.clearance && a.cell < b.cell);
    });
    for (const Place& place : places) {
      const float clearance = grid_.clearance[place.cell];
      if (clearance <= 0.0f) continue;
      const std::size_t bin = clearance_bin(clearance);
      if (bin < bins_.size()) {
        bins_[bin].push_back(place.cell);
      } else if (full() || !place_sphere(place.cell)) {
        grid_.clearance[place.cell] = 0.0f;
      }
    }
  }

  bool place_sphere(std::uint32_t cell) {
    const Sphere sphere = climb(grid_.center(std::size_t{cell}), grid_.clearance[cell]);
    if (sphere.radius < smallest_) return false;
    spheres_.push_back(sphere);
    lower_grid(sphere);
    return true;
  }

  // Climbs from p to a Voronoi node nearby and returns the sphere there. The node's clearance is about the
  // one given, so only placed spheres within twice this distance can be the nearest obstacle on the way.
  Sphere climb(Vec3d p, double clearance) const {
    const double reach = 2.0 * (clearance + 2.0 * grid_.step);
    std::vector<Sphere> reached;
    for (const Sphere& s : spheres_) {
      const double limit = s.radius + reach;
      if (squared_norm(s.center - p) < limit * limit) reached.push_back(s);
    }
    Obstacle obstacle = nearest_obstacle(p, reached);
    Sphere best{p, obstacle.distance};
    double step = kFirstClimb * grid_.step;
    for (int i = 0; i < kClimbs && obstacle.distance > 0.0; ++i, step *= kClimbDecay) {
      // The step stays within the ball of clearance, which holds no obstacle.
      p += obstacle.away * std::min(step, obstacle.distance);
      obstacle = nearest_obstacle(p, reached);
      if (obstacle.distance > best.radius) best = {p, obstacle.distance};
    }
    return best;
  }

  Obstacle nearest_obstacle(const Vec3d& p, const std::vector<Sphere>& spheres) const {
    const ClosestPoint surface = tree_.closest(p);
    Obstacle nearest{surface.distance, normalized(p - surface.point)};
    for (const Sphere& s : spheres) {
      const double distance = norm(p - s.center) - s.radius;
      if (distance < nearest.distance) nearest = {distance, normalized(p - s.center)};
    }
    return nearest;
  }

  // Lowers the clearances around a new sphere. No clearance exceeds the last bin's, so the sphere changes
  // nothing farther than this from its surface.
  void lower_grid(const Sphere& sphere) {
    const double reach = sphere.radius + bin_width_ * static_cast<double>(bins_.size() + 1);
    const Vec3d center = (sphere.center - grid_.origin) * (1.0 / grid_.step);
    const auto low = [&](double c) {
      return std::max(0, static_cast<int>(std::ceil(c - reach / grid_.step)));
    };
    const auto high = [&](double c, int cells) {
      return std::min(cells - 1, static_cast<int>(std::floor(c + reach / grid_.step)));
    };
    for (int z = low(center.z); z <= high(center.z, grid_.cells[2]); ++z) {
      for (int y = low(center.y); y <= high(center.y, grid_.cells[1]); ++y) {
        for (int x = low(center.x); x <= high(center.x, grid_.cells[0]); ++x) {
          float& clearance = grid_.clearance[grid_.index(x, y, z)];
          if (clearance <= 0.0f) continue;
          const double distance = norm(grid_.center(x, y, z) - sphere.center) - sphere.radius;
          clearance = std::min(clearance, static_cast<float>(distance));
        }
      }
    }
  }

  const SurfaceTree& tree_;
  const PackingOptions& options_;
  ClearanceGrid grid_;
  double bin_width_;
  double smallest_;
  std::vector<std::vector<std::uint32_t>> bins_;  // cells by clearance
  std::vector<Sphere> spheres_;
};

}  // namespace

std::vector<double> sphere_masses(const std::vector<Sphere>& spheres, const PackingTable& table) {
  double cubes = 0.0;
  for (const Sphere& s : spheres) cubes += cube(s.radius);
  std::vector<double> masses;
  for (const Sphere& s : spheres) masses.push_back(kilograms(table) * cube(s.radius) / cubes);
  return masses;
}

void write_packing_table(const std::vector<Sphere>& spheres, const PackingTable& table,
                         const std::filesystem::path& file) {
  const bool with_mass = table.density > 0.0;
  const std::vector<double> masses = sphere_masses(spheres, table);
  std::string text = fmt::format(
      "# {}\n# lengths in {}{}\n", table.title, table.length_unit,
      with_mass ? fmt::format(", masses in kg that add up to the body's at {} kg/m^3", table.density) : "");
  text += with_mass ? "x,y,z,radius,mass\n" : "x,y,z,radius\n";
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const Sphere& s = spheres[i];
    text += fmt::format("{:.9g},{:.9g},{:.9g},{:.9g}", s.center.x, s.center.y, s.center.z, s.radius);
    text += with_mass ? fmt::format(",{:.9g}\n", masses[i]) : "\n";
  }
  write_file(file, text);
}

Packing pack_spheres(const TriangleMesh& body, const SurfaceTree& tree, const PackingOptions& options,
                     const Progress& progress) {
  Packing packing = Packer(body, tree, options).run(progress);
  double filled = 0.0;
  for (const Sphere& s : packing.spheres) filled += 4.0 / 3.0 * std::numbers::pi * std::pow(s.radius, 3);
  packing.filling_rate = filled / volume(body);
  return packing;
}

}  // namespace astrolith
