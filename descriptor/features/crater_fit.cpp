#include "descriptor/features/crater_fit_internal.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "numerics/cholesky.h"
#include "numerics/sample_statistics.h"
#include "numerics/tangent_frame.h"

namespace astrolith {
namespace {

constexpr double kInner = 1.4, kOuter = 2.0;  // radii: full weight to the one, none from the other on
constexpr double kExtent = 2.5;               // radii, the end of the rim's flank
constexpr std::size_t kMostPoints = 500, kFewestPoints = 24, kSectors = 8;
// The ground drops no more from the centre to the rim, in radii, and the floor lies no farther from a point.
constexpr double kMostDrop = 0.55, kFarthestFloor = 0.25;
constexpr double kLeastRelief = 0.02;  // depth and rim over the radius
constexpr double kCauchy = 3.0;        // width of the weights, median residuals
// Strengths of the beliefs about rim and ground beside the points' weight.
constexpr double kRimBelief = 0.01, kBendSpread = 0.7, kBendBelief = 3e-4;

// The unknowns: quadric 0 to 5, depth, rim, and then the steps of centre and radius.
constexpr std::size_t kQuadric = 6, kDepth = 6, kRim = 7, kLinear = 8, kAll = 11;

// The least-squares problem of N unknowns by its normal equations.
template <std::size_t N>
struct LeastSquares {
  std::array<double, N * N> matrix{};
  std::array<double, N> right{};

  void add(const std::array<double, N>& row, double value, double weight) {
    for (std::size_t i = 0; i < N; ++i) {
      const double w = weight * row[i];
      right[i] += w * value;
      for (std::size_t j = 0; j <= i; ++j) matrix[i * N + j] += w * row[j];
    }
  }
  // False where the matrix is not positive definite. The matrix is lost.
  bool solve(std::array<double, N>& x) {
    if (!factor_cholesky(matrix, N, 1e-12)) return false;
    solve_cholesky(matrix, N, right);
    x = right;
    return true;
  }
};

double bowl(double t) { return t < 1.0 ? t * t - 1.0 : 0.0; }
double rim(double t) {
  if (t < 1.0) return t * t;
  const double left = std::max(0.0, (kExtent - t) / (kExtent - 1.0));
  return left * left * left;
}
// The derivatives by t, over t.
double bowl_slope(double t) { return t < 1.0 ? 2.0 : 0.0; }
double rim_slope(double t) {
  if (t < 1.0) return 2.0;
  const double left = std::max(0.0, (kExtent - t) / (kExtent - 1.0));
  return -3.0 * left * left / ((kExtent - 1.0) * t);
}

// Points about a place in the frame of a normal. Lengths are in radii of the start.
struct Patch {
  Vec3d origin, normal;
  Tangents<double> along;
  double unit = 0.0;       // the radius of the start
  double curvature = 0.0;  // of the sphere of equal area; negative where heights count downwards
  std::vector<Vec3d> points;
};

struct Unknowns {
  std::array<double, kLinear> c{};
  double x = 0.0, y = 0.0, radius = 1.0;

  double distance(const Vec3d& p) const {
    return std::sqrt((p.x - x) * (p.x - x) + (p.y - y) * (p.y - y)) / radius;
  }
  double ground(const Vec3d& p) const {
    return c[0] + c[1] * p.x + c[2] * p.y + c[3] * p.x * p.x + c[4] * p.x * p.y + c[5] * p.y * p.y;
  }
  double height(const Vec3d& p) const {
    const double t = distance(p);
    return ground(p) + c[kDepth] * bowl(t) + c[kRim] * rim(t);
  }
  double relief() const { return c[kDepth] + c[kRim]; }
};

double taper(double t) {
  if (t <= kInner) return 1.0;
  const double left = std::max(0.0, 1.0 - (t - kInner) / (kOuter - kInner));
  return left * left * (3.0 - 2.0 * left);
}

// Weights of the points: the taper, and those of Cauchy for the residuals.
std::vector<double> point_weights(const Patch& patch, const Unknowns& u, bool robust) {
  std::vector<double> weights, residuals;
  for (const Vec3d& p : patch.points) weights.push_back(taper(u.distance(p)));
  if (!robust) return weights;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (weights[i] > 0.0) residuals.push_back(std::fabs(patch.points[i].z - u.height(patch.points[i])));
  }
  if (residuals.size() < kFewestPoints) return weights;
  const double width = std::max(kCauchy * upper_median(residuals), 0.02 * std::fabs(u.relief()) + 1e-9);
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double r = (patch.points[i].z - u.height(patch.points[i])) / width;
    weights[i] /= 1.0 + r * r;
  }
  return weights;
}

template <std::size_t N>
void fill_row(const Vec3d& p, const Unknowns& u, std::array<double, N>& row) {
  const double t = u.distance(p);
  row[0] = 1.0, row[1] = p.x, row[2] = p.y, row[3] = p.x * p.x, row[4] = p.x * p.y, row[5] = p.y * p.y;
  if constexpr (N >= kLinear) row[kDepth] = bowl(t), row[kRim] = rim(t);
  if constexpr (N == kAll) {
    const double slope = u.c[kDepth] * bowl_slope(t) + u.c[kRim] * rim_slope(t);
    row[8] = -slope * (p.x - u.x) / (u.radius * u.radius);
    row[9] = -slope * (p.y - u.y) / (u.radius * u.radius);
    row[10] = -slope * t * t;  // by log(radius)
  }
}

// Weak beliefs, for bowl and rim over a ring of ground can be taken for bent ground. Rims are a quarter of
// the depth. Ground bends like the sphere of equal area, of radius 1 / curvature, give or take as much.
template <std::size_t N>
void add_beliefs(LeastSquares<N>& problem, double curvature, double weight) {
  std::array<double, N> row{};
  row[kDepth] = -0.25, row[kRim] = 1.0;
  problem.add(row, 0.0, kRimBelief * weight);
  const double spread = kBendSpread * std::fabs(curvature) + 0.02,
               strength = kBendBelief * weight / (spread * spread);
  row = {};
  row[3] = row[5] = 0.5;
  problem.add(row, -0.5 * curvature, strength);
  row = {};
  row[3] = 0.5, row[5] = -0.5;
  problem.add(row, 0.0, strength);
  row = {};
  row[4] = 0.5;
  problem.add(row, 0.0, strength);
}

template <std::size_t N>
bool solve_at(const Patch& patch, const Unknowns& u, const std::vector<double>& weights,
              std::array<double, N>& x) {
  LeastSquares<N> problem;
  std::array<double, N> row{};
  double total = 0.0;
  for (std::size_t i = 0; i < patch.points.size(); ++i) {
    if (!(weights[i] > 0.0)) continue;
    fill_row(patch.points[i], u, row);
    problem.add(row, patch.points[i].z, weights[i]);
    total += weights[i];
  }
  if constexpr (N >= kLinear) add_beliefs(problem, patch.curvature, total);
  if constexpr (N == kAll) {
    for (std::size_t k = kLinear; k < kAll; ++k)
      problem.matrix[k * (kAll + 1)] += 1e-3 * problem.matrix[k * (kAll + 1)] + 1e-9;
  }
  return problem.solve(x);
}

bool solve_linear(const Patch& patch, Unknowns& u, bool robust) {
  return solve_at<kLinear>(patch, u, point_weights(patch, u, robust), u.c);
}

// Moves centre and radius by a step of Gauss and Newton, which is cut to a quarter of the radius.
bool improve(const Patch& patch, Unknowns& u) {
  std::array<double, kAll> x{};
  if (!solve_at<kAll>(patch, u, point_weights(patch, u, true), x)) return false;
  const double most = 0.25 * u.radius, far = std::sqrt(x[8] * x[8] + x[9] * x[9]);
  const double cut = far > most ? most / far : 1.0;
  u.x += cut * x[8];
  u.y += cut * x[9];
  u.radius *= 1.0 + std::clamp(x[10], -0.2, 0.2);
  return std::fabs(u.radius - 1.0) < 0.8 && u.x * u.x + u.y * u.y < 1.0 && solve_linear(patch, u, true);
}

// The sector of a point about the centre.
std::size_t sector_index(const Vec3d& p, const Unknowns& u) {
  const double x = p.x - u.x, y = p.y - u.y;
  const std::size_t eighth = std::fabs(y) > std::fabs(x) ? 1 : 0;
  return 4 * (y < 0.0 ? 1 : 0) + 2 * (x < 0.0 ? 1 : 0) + eighth;
}

struct Mean {
  double sum = 0.0, count = 0.0;
  void add(double v) { sum += v, count += 1.0; }
  double value() const { return sum / count; }
};

void measure_sectors(const Patch& patch, const Unknowns& u, FitMeasures& m) {
  std::array<Mean, kSectors> crest{}, outside{};
  Mean floor;
  for (const Vec3d& p : patch.points) {
    const double t = u.distance(p), z = p.z - u.ground(p);
    if (t < 0.35) floor.add(z);
    if (t > 0.85 && t < 1.15) crest[sector_index(p, u)].add(z);
    if (t > 1.3 && t < kOuter) outside[sector_index(p, u)].add(z);
  }
  if (!(floor.count > 0.0)) return;
  double high = 0.0, crests = 0.0;
  for (std::size_t k = 0; k < kSectors; ++k) {
    if (crest[k].count == 0.0 || crest[k].value() - floor.value() < 0.5 * u.relief()) continue;
    high += 1.0;
    if (outside[k].count > 0.0 && outside[k].value() < crest[k].value()) crests += 1.0;
  }
  m.walls = high / kSectors;
  m.crests = crests / kSectors;
}

// Sums over the points of a part of the patch.
struct Residuals {
  double with = 0.0, without = 0.0, count = 0.0;  // squares about the fit, and about the quadric alone
  void add(double r, double q, double weight) {
    with += weight * r * r, without += weight * q * q, count += weight;
  }
  double explained() const { return without > 0.0 ? 1.0 - with / without : 0.0; }
  double rms() const { return std::sqrt(with / std::max(count, 1.0)); }
};

FitMeasures measure_fit(const Patch& patch, const Unknowns& u) {
  FitMeasures m;
  const std::vector<double> weights = point_weights(patch, u, true);
  std::array<double, kQuadric> quadric{};
  if (!solve_at<kQuadric>(patch, u, weights, quadric)) return m;
  Unknowns plain = u;
  plain.c = {};
  std::copy(quadric.begin(), quadric.end(), plain.c.begin());
  Residuals all, whole, inner;
  const double relief = u.relief(), squares = u.radius * u.radius;
  for (std::size_t i = 0; i < patch.points.size(); ++i) {
    const Vec3d& p = patch.points[i];
    const double r = p.z - u.height(p), q = p.z - plain.ground(p), t = u.distance(p);
    all.add(r, q, weights[i]);
    whole.add(std::clamp(r, -relief, relief), q, taper(t));
    if (t < 1.1) inner.add(r, q, 1.0);
  }
  m.explained = all.explained();
  m.residual = whole.rms() / relief;
  m.inner = inner.rms() / relief;
  m.bend = (u.c[3] + u.c[5]) / 2.0 * squares / relief;
  m.saddle = std::sqrt((u.c[3] - u.c[5]) * (u.c[3] - u.c[5]) + u.c[4] * u.c[4]) / 2.0 * squares / relief;
  measure_sectors(patch, u, m);
  return m;
}

Patch patch_about(const EvenedSurface& even, const PointTree& tree, double sign, const Vec3d& origin,
                  const Vec3d& normal, double radius) {
  const double curvature = sign * radius * std::sqrt(4.0 * std::numbers::pi / even.area);
  Patch patch{origin, normal, crossed_tangents(normal), radius, curvature, {}};
  std::vector<std::pair<std::uint32_t, double>> near = tree.within(origin, (kOuter + 0.4) * radius);
  std::sort(near.begin(), near.end());
  const std::size_t every = near.size() / kMostPoints + 1;
  for (std::size_t k = 0; k < near.size(); k += every) {
    const std::uint32_t j = near[k].first;
    if (dot(even.normals[j], normal) < 0.2) continue;
    const Vec3d offset = (1.0 / radius) * (even.means[j] - origin);
    patch.points.push_back(
        {dot(offset, patch.along.first), dot(offset, patch.along.second), sign * dot(offset, normal)});
  }
  return patch;
}

}  // namespace

CraterFitter::CraterFitter(const EvenedSurface& even, BlobSign sign)
    : even_(even), tree_(even.points), sign_(sign == BlobSign::hollow ? 1.0 : -1.0) {}

std::optional<CraterFit> CraterFitter::fit(const SurfaceBlob& blob, double radius) const {
  Vec3d origin = even_.points[blob.point], normal = blob.normal;
  for (int round = 0;; ++round) {
    const Patch patch = patch_about(even_, tree_, sign_, origin, normal, radius);
    Unknowns u;
    if (patch.points.size() < kFewestPoints || !solve_linear(patch, u, false)) return std::nullopt;
    const int steps = round == 2 ? 2 : 6;
    for (int k = 0; k < steps; ++k) {
      if (!improve(patch, u)) return std::nullopt;
    }
    if (!(u.relief() > kLeastRelief * u.radius)) return std::nullopt;
    // The quadric's height and slope at the centre.
    const Vec3d at{u.x, u.y, 0.0};
    const double sx = sign_ * (u.c[1] + 2.0 * u.c[3] * u.x + u.c[4] * u.y),
                 sy = sign_ * (u.c[2] + 2.0 * u.c[5] * u.y + u.c[4] * u.x);
    const Vec3d center = origin + radius * (u.x * patch.along.first + u.y * patch.along.second +
                                            (sign_ * u.ground(at)) * normal);
    const Vec3d upright = normalized(normal - sx * patch.along.first - sy * patch.along.second);
    if (round == 2) {
      const CraterFit fit{center,
                          upright,
                          radius * u.radius,
                          radius * u.c[kDepth],
                          radius * u.c[kRim],
                          measure_fit(patch, u)};
      return is_on_surface(fit) ? std::optional(fit) : std::nullopt;
    }
    origin = center, normal = upright, radius *= u.radius;
  }
}

bool CraterFitter::is_on_surface(const CraterFit& fit) const {
  if (!(fit.depth > 0.0)) return false;
  const double drop = std::fabs(fit.measures.bend) * (fit.depth + fit.rim_height);
  if (drop > kMostDrop * fit.radius) return false;
  const Vec3d floor = fit.center - (sign_ * fit.depth) * fit.normal;
  const double away = norm(even_.points[tree_.nearest(floor, 1).front()] - floor);
  return away <= kFarthestFloor * fit.radius + even_.edge;
}

}  // namespace astrolith
