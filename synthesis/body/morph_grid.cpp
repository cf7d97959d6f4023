#include "synthesis/body/morph_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "numerics/portable_angles.h"
#include "numerics/portable_double.h"
#include "synthesis/body/metaball_body.h"

namespace astrolith {
namespace {

using Index = std::array<int, 3>;

// The nodes of a morph, and values at them.
struct Nodes {
  Index count;
  Vec3d first;
  double spacing;

  std::size_t size() const {
    return static_cast<std::size_t>(count[0]) * static_cast<std::size_t>(count[1]) *
           static_cast<std::size_t>(count[2]);
  }
  std::array<std::ptrdiff_t, 3> steps() const { return {1, count[0], std::ptrdiff_t{count[0]} * count[1]}; }
  std::vector<Vec3d> points() const {
    std::vector<Vec3d> all;
    for (int k = 0; k < count[2]; ++k) {
      for (int j = 0; j < count[1]; ++j) {
        for (int i = 0; i < count[0]; ++i) all.push_back(at({i, j, k}));
      }
    }
    return all;
  }
  // The numbers of all nodes, block after block of neighbours: few metaballs reach the points of a block.
  std::vector<std::size_t> by_blocks() const {
    constexpr int kSide = 6;
    std::vector<std::size_t> numbers;
    const auto end = [&](int begin, int axis) { return std::min(begin + kSide, count[axis]); };
    for (int k0 = 0; k0 < count[2]; k0 += kSide) {
      for (int j0 = 0; j0 < count[1]; j0 += kSide) {
        for (int i0 = 0; i0 < count[0]; i0 += kSide) {
          for (int k = k0; k < end(k0, 2); ++k) {
            for (int j = j0; j < end(j0, 1); ++j) {
              for (int i = i0; i < end(i0, 0); ++i) numbers.push_back(number({i, j, k}));
            }
          }
        }
      }
    }
    return numbers;
  }
  std::size_t number(const Index& i) const {
    return static_cast<std::size_t>(i[0] +
                                    std::ptrdiff_t{count[0]} * (i[1] + std::ptrdiff_t{count[1]} * i[2]));
  }
  Vec3d at(const Index& i) const {
    return first +
           spacing * Vec3d{static_cast<double>(i[0]), static_cast<double>(i[1]), static_cast<double>(i[2])};
  }
};

double mean_radius(const Vec3d& half_axes) { return portable::cbrt(half_axes.x * half_axes.y * half_axes.z); }

Nodes nodes_around(const Vec3d& half_axes) {
  const double margin = mean_radius(half_axes);
  const Vec3d half = half_axes + Vec3d{margin, margin, margin};
  const double spacing = 2.0 * portable::cbrt(half.x * half.y * half.z / kMorphNodes);
  // A node beyond the domain on every side.
  const auto cells = [&](double h) { return static_cast<int>(std::ceil(2.0 * h / spacing)) + 2; };
  const Index last{cells(half.x), cells(half.y), cells(half.z)};
  const Vec3d first =
      -0.5 * spacing *
      Vec3d{static_cast<double>(last[0]), static_cast<double>(last[1]), static_cast<double>(last[2])};
  return {{last[0] + 1, last[1] + 1, last[2] + 1}, first, spacing};
}

// A linear map of coordinates; its rows are gradients of the coordinates that it gives.
struct LinearMap {
  Vec3d rows[3];

  Vec3d operator()(const Vec3d& p) const { return {dot(rows[0], p), dot(rows[1], p), dot(rows[2], p)}; }
  // The gradient by p of a function with gradient g by (*this)(p).
  Vec3d pull_back(const Vec3d& g) const { return g.x * rows[0] + g.y * rows[1] + g.z * rows[2]; }
};

LinearMap donor_from_morph(const Donor& donor, const Vec3d& half_axes) {
  const auto& [a, b, c] = half_axes;
  const auto sign = [&](int k) { return donor.mirror[k] ? -1.0 : 1.0; };
  const Vec3d x{sign(0) / a, 0.0, 0.0}, y{0.0, sign(1) / b, 0.0}, z{0.0, 0.0, sign(2) / c};
  const double angle = donor.turn * (std::numbers::pi / 180.0);
  const double cosine = portable::cos(angle), sine = portable::sin(angle);
  return {{donor.half_axes.x * (cosine * x - sine * y), donor.half_axes.y * (sine * x + cosine * y),
           donor.half_axes.z * z}};
}

// A first-order signed distance at a point, positive inside, and the unit vector inwards.
struct Level {
  double distance;
  Vec3d inwards;

  Vec3d foot(const Vec3d& p) const { return p - distance * inwards; }
};
using Points = std::vector<Vec3d>;
using Levels = std::vector<Level>;
using Surface = std::function<Levels(const Points&)>;

// The metaballs of a donor in the frame of the morph.
class DonorSurface {
 public:
  // `numbers` are those of the points, neighbours one after another.
  DonorSurface(const Donor& donor, const Vec3d& half_axes, const std::vector<std::size_t>& numbers)
      : map_(donor_from_morph(donor, half_axes)),
        metaballs_(prepare_metaballs(donor.body.front())),
        numbers_(numbers) {}

  Levels operator()(const Points& points) const {
    Levels levels(points.size());
    const std::size_t chunks = (points.size() + kChunk - 1) / kChunk;
    parallel_for(0, static_cast<std::int64_t>(chunks), [&](std::int64_t chunk) {
      const std::size_t begin = static_cast<std::size_t>(chunk) * kChunk;
      evaluate(points, std::span(numbers_).subspan(begin, std::min(kChunk, points.size() - begin)), levels);
    });
    return levels;
  }

 private:
  static constexpr std::size_t kChunk = 216;

  void evaluate(const Points& points, std::span<const std::size_t> numbers, Levels& levels) const {
    std::array<float, kChunk> x, y, z, s, gx, gy, gz;
    Box box;
    const std::size_t n = numbers.size();
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3f q = to_float(map_(points[numbers[i]]));
      x[i] = q.x, y[i] = q.y, z[i] = q.z;
      box.extend({q.x, q.y, q.z});
    }
    evaluate_metaballs(metaballs_reaching(metaballs_, box), static_cast<int>(n), x.data(), y.data(), z.data(),
                       s.data(), gx.data(), gy.data(), gz.data());
    const double floor = double{metaballs_.parameters.gradient_floor};
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3d g{gx[i], gy[i], gz[i]}, pulled = map_.pull_back(g);
      const double level = double{s[i]} * std::sqrt(squared_norm(g) + floor);
      levels[numbers[i]] = {level / std::sqrt(squared_norm(pulled) + kLeastSquare), normalized(pulled)};
    }
  }
  static constexpr double kLeastSquare = 1e-20;  // keeps the distance finite where no metaball reaches

  LinearMap map_;
  PreparedMetaballs metaballs_;
  const std::vector<std::size_t>& numbers_;
};

Levels ellipsoid_levels(const Vec3d& half_axes, const Points& points) {
  const auto& [a, b, c] = half_axes;
  Levels levels;
  for (const Vec3d& p : points) {
    const Vec3d u{p.x / a, p.y / b, p.z / c};
    const double q = std::max(norm(u), 1e-9);
    const Vec3d outwards = Vec3d{u.x / a, u.y / b, u.z / c} * (1.0 / q);
    levels.push_back({(1.0 - q) / std::max(norm(outwards), 1e-30), -normalized(outwards)});
  }
  return levels;
}

// Carries the feet of the nodes beside a surface to all other nodes, in eight sweeps along the axes.
class FootSweep {
 public:
  FootSweep(const Nodes& nodes, const Points& points, const Levels& levels)
      : nodes_(nodes), points_(points), feet_(nodes.size()) {
    squares_.assign(nodes.size(), std::numeric_limits<double>::max());
    for_each([&](const Index& i, std::size_t number) {
      if (!is_beside_surface(i, number, levels)) return;
      feet_[number] = levels[number].foot(points_[number]);
      squares_[number] = levels[number].distance * levels[number].distance;
    });
  }

  Points feet() && {
    for (int sweep = 0; sweep < 8; ++sweep) run(sweep);
    return std::move(feet_);
  }

 private:
  template <class Visit>
  void for_each(const Visit& visit) const {
    std::size_t number = 0;
    for (int k = 0; k < nodes_.count[2]; ++k) {
      for (int j = 0; j < nodes_.count[1]; ++j) {
        for (int i = 0; i < nodes_.count[0]; ++i) visit(Index{i, j, k}, number++);
      }
    }
  }

  // Whether the surface crosses an edge of the grid at a node.
  bool is_beside_surface(const Index& i, std::size_t number, const Levels& levels) const {
    const bool inside = levels[number].distance >= 0.0;
    const auto steps = nodes_.steps();
    for (std::size_t a = 0; a < 3; ++a) {
      const auto at = static_cast<std::ptrdiff_t>(number);
      const auto differs = [&](std::ptrdiff_t other) {
        return (levels[static_cast<std::size_t>(other)].distance >= 0.0) != inside;
      };
      if (i[a] > 0 && differs(at - steps[a])) return true;
      if (i[a] + 1 < nodes_.count[a] && differs(at + steps[a])) return true;
    }
    return false;
  }

  // The bits of `sweep` say along which axes it runs backwards.
  void run(int sweep) {
    const auto steps = nodes_.steps();
    Index i;
    const auto along = [&](std::size_t axis, int step) {
      return sweep >> axis & 1 ? nodes_.count[axis] - 1 - step : step;
    };
    for (int c = 0; c < nodes_.count[2]; ++c) {
      i[2] = along(2, c);
      for (int b = 0; b < nodes_.count[1]; ++b) {
        i[1] = along(1, b);
        for (int a = 0; a < nodes_.count[0]; ++a) {
          i[0] = along(0, a);
          const std::size_t number = nodes_.number(i);
          const int begun[3] = {a, b, c};
          for (std::size_t axis = 0; axis < 3; ++axis) {
            if (begun[axis] == 0) continue;
            const std::ptrdiff_t back = sweep >> axis & 1 ? steps[axis] : -steps[axis];
            take(number, static_cast<std::size_t>(static_cast<std::ptrdiff_t>(number) + back));
          }
        }
      }
    }
  }
  void take(std::size_t number, std::size_t from) {
    if (squares_[from] == std::numeric_limits<double>::max()) return;
    const double square = squared_norm(points_[number] - feet_[from]);
    if (square >= squares_[number]) return;
    squares_[number] = square;
    feet_[number] = feet_[from];
  }

  const Nodes& nodes_;
  const Points& points_;
  Points feet_;
  std::vector<double> squares_;
};

// Moves feet on a surface towards the points of it that are nearest to the nodes: to the foot in the tangent
// plane, at most a spacing away, and back to the surface.
void improve_feet(const Nodes& nodes, const Points& points, const Surface& surface, Points& feet) {
  constexpr int kSteps = 2;
  for (int step = 0; step < kSteps; ++step) {
    const Levels levels = surface(feet);
    for (std::size_t i = 0; i < feet.size(); ++i) {
      const Vec3d n = levels[i].inwards, foot = levels[i].foot(feet[i]), away = points[i] - foot;
      const Vec3d along = away - dot(away, n) * n;
      feet[i] = foot + std::min(1.0, nodes.spacing / std::max(norm(along), 1e-30)) * along;
    }
  }
  const Levels levels = surface(feet);
  for (std::size_t i = 0; i < feet.size(); ++i) feet[i] = levels[i].foot(feet[i]);
}

// The signed distances of all nodes to a surface.
std::vector<double> signed_distances(const Nodes& nodes, const Points& points, const Surface& surface) {
  const Levels levels = surface(points);
  Points feet = FootSweep(nodes, points, levels).feet();
  improve_feet(nodes, points, surface, feet);
  std::vector<double> s(points.size());
  for (std::size_t i = 0; i < s.size(); ++i) {
    s[i] = (levels[i].distance < 0.0 ? -1.0 : 1.0) * norm(points[i] - feet[i]);
  }
  return s;
}

void check_domain(const Nodes& nodes, const std::vector<double>& values) {
  for (std::size_t number = 0; number < values.size(); ++number) {
    bool at_end = false;
    for (std::size_t a = 0; a < 3; ++a) {
      const auto i = static_cast<int>(number / static_cast<std::size_t>(nodes.steps()[a])) % nodes.count[a];
      at_end = at_end || i < 2 || i > nodes.count[a] - 3;
    }
    if (at_end && values[number] >= 0.0) {
      throw InputError("body: reaches farther from its ellipsoid than its mean radius; lower roughness");
    }
  }
}

// The surface of donor j in the frame of the morph, or the ellipsoid after the last donor.
Surface make_surface(const Morph& morph, std::size_t j, const std::vector<std::size_t>& numbers) {
  if (j < morph.donors.size()) return DonorSurface(morph.donors[j], morph.half_axes, numbers);
  return [&morph](const Points& points) { return ellipsoid_levels(morph.half_axes, points); };
}

// The sum of recipe/body.h at all nodes.
std::vector<double> blended_distances(const Morph& morph, const Nodes& nodes) {
  const Points points = nodes.points();
  const std::vector<std::size_t> numbers = nodes.by_blocks();
  const std::size_t donors = morph.donors.size();
  std::vector<std::vector<double>> s(donors + 1);  // those of the donors, then the ellipsoid's
  parallel_for(0, static_cast<std::int64_t>(s.size()), [&](std::int64_t number) {
    const auto j = static_cast<std::size_t>(number);
    s[j] = signed_distances(nodes, points, make_surface(morph, j, numbers));
  });
  double squares = 0.0;
  for (const Donor& donor : morph.donors) squares += donor.share * donor.share;
  std::vector<double> blended = s[donors];
  for (std::size_t j = 0; j < donors; ++j) {
    // w_j / sqrt(sum w^2) is the same for shares that do not add up to 1.
    const double weight = morph.roughness * morph.donors[j].share / std::sqrt(squares);
    for (std::size_t i = 0; i < blended.size(); ++i) blended[i] += weight * (s[j][i] - s[donors][i]);
  }
  return blended;
}

}  // namespace

double morph_spacing(const Morph& morph) { return nodes_around(morph.half_axes).spacing; }

SplineGrid make_morph_grid(const Morph& morph, ArrayStore& arrays) {
  const Nodes nodes = nodes_around(morph.half_axes);
  std::vector<double> values = blended_distances(morph, nodes);
  check_domain(nodes, values);
  std::vector<float> coefficients(values.size());
  std::transform(values.begin(), values.end(), coefficients.begin(),
                 [](double v) { return static_cast<float>(v); });
  SplineGrid grid;
  grid.coefficients = arrays.add(coefficients);
  std::copy(nodes.count.begin(), nodes.count.end(), grid.count);
  grid.first = to_float(morph.center + nodes.first);
  grid.spacing = static_cast<float>(nodes.spacing);
  grid.low = to_float(morph.center + nodes.at({1, 1, 1}));
  grid.high = to_float(morph.center + nodes.at({nodes.count[0] - 2, nodes.count[1] - 2, nodes.count[2] - 2}));
  return grid;
}

}  // namespace astrolith
