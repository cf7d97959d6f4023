#include "synthesis/picture/phase_curve.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "numerics/portable_angles.h"
#include "numerics/portable_double.h"
#include "synthesis/picture/ray_scene.h"

namespace astrolith {
namespace {

Vec3d equatorial(double degrees) {
  const double angle = degrees * std::numbers::pi / 180.0;
  return {portable::cos(angle), portable::sin(angle), 0.0};
}

double phase_between(const Vec3d& sun, const Vec3d& viewer) {
  return portable::atan2(norm(cross(sun, viewer)), dot(sun, viewer));
}

// Facets in blocks, whose sums are added in their order.
double sum_over_facets(const TriangleMesh& mesh, const RayScene& scene, const DiskOptions& options,
                       const Vec3d& sun, const Vec3d& viewer) {
  constexpr std::size_t kBlock = 1024;
  constexpr double kLift = 1e-5;  // above the facet, radii of the body
  const double phase = phase_between(sun, viewer);
  const double albedo = is_radiance_factor(options.reflectance) ? 1.0 : options.normal_albedo;
  const std::size_t count = mesh.triangles.size(), blocks = (count + kBlock - 1) / kBlock;
  std::vector<double> sums(blocks);
  parallel_for(0, static_cast<std::int64_t>(blocks), [&](std::int64_t block) {
    const auto b = static_cast<std::size_t>(block);
    for (std::size_t f = b * kBlock; f < std::min(count, (b + 1) * kBlock); ++f) {
      const Triangle& t = mesh.triangles[f];
      const Vec3d &p = mesh.vertices[t[0]], &q = mesh.vertices[t[1]], &r = mesh.vertices[t[2]];
      const Vec3d twice = cross(q - p, r - p);
      const double area = 0.5 * norm(twice);
      if (!(area > 0.0)) continue;
      const Vec3d normal = (0.5 / area) * twice;
      const double m0 = dot(normal, sun), m = dot(normal, viewer);
      if (!(m0 > 0.0 && m > 0.0)) continue;
      const Vec3d middle = (1.0 / 3.0) * (p + q + r);
      const Vec3f start = to_float(scene.to_unit(middle) + kLift * normal);
      if (scene.occluded(start, to_float(sun)) || scene.occluded(start, to_float(viewer))) continue;
      sums[b] +=
          area * m * albedo * reflectance_at(options.reflectance, std::min(m0, 1.0), std::min(m, 1.0), phase);
    }
  });
  double sum = 0.0;
  for (const double s : sums) sum += s;
  return sum;
}

std::vector<double> over_rotation(const TriangleMesh& mesh, const RayScene& scene, const DiskOptions& options,
                                  double phase, int steps, const std::function<void(int)>& made) {
  std::vector<double> light;
  for (int k = 0; k < steps; ++k) {
    // A body that turns eastwards shows ever more western longitudes.
    const double below = -360.0 * k / steps;
    light.push_back(sum_over_facets(mesh, scene, options, equatorial(below - phase), equatorial(below)));
    made(k);
  }
  return light;
}

void report_or_stop(const Progress& progress, double share) {
  if (!report(progress, share, "light")) throw WorkError("phase curve: stopped before it was complete");
}

}  // namespace

double disk_light(const TriangleMesh& mesh, const DiskOptions& options, const Vec3d& sun,
                  const Vec3d& viewer) {
  return sum_over_facets(mesh, RayScene(mesh), options, normalized(sun), normalized(viewer));
}

double reduced_magnitude(double square_metres) {
  constexpr double kSun = -26.76, kAstronomicalUnit = 1.495978707e11;
  if (!(square_metres > 0.0)) return std::numeric_limits<double>::infinity();
  const double share = square_metres / (std::numbers::pi * kAstronomicalUnit * kAstronomicalUnit);
  return kSun - 2.5 * portable::log(share) / portable::log(10.0);
}

std::vector<PhasePoint> phase_curve(const TriangleMesh& mesh, const DiskOptions& options,
                                    const std::vector<double>& phases, const Progress& progress) {
  const RayScene scene(mesh);
  std::vector<PhasePoint> curve;
  for (const double phase : phases) {
    const auto before = static_cast<double>(curve.size());
    const auto made = [&](int k) {
      report_or_stop(progress, (before + (k + 1.0) / kTurnsOfRotation) / static_cast<double>(phases.size()));
    };
    const std::vector<double> light = over_rotation(mesh, scene, options, phase, kTurnsOfRotation, made);
    PhasePoint point{phase, 0.0, light[0], light[0]};
    for (const double s : light) {
      point.light += s / kTurnsOfRotation;
      point.least = std::min(point.least, s);
      point.greatest = std::max(point.greatest, s);
    }
    curve.push_back(point);
  }
  return curve;
}

std::vector<double> light_curve(const TriangleMesh& mesh, const DiskOptions& options, double phase, int steps,
                                const Progress& progress) {
  return over_rotation(mesh, RayScene(mesh), options, phase, steps,
                       [&](int k) { report_or_stop(progress, (k + 1.0) / steps); });
}

}  // namespace astrolith
