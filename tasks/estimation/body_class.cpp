#include "tasks/estimation/body_class.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace astrolith {
namespace {

constexpr std::size_t kSlices = 48;
constexpr double kEquator = 0.14;  // sine of 8 degrees

Vec3d in_frame(const BodyFrame& frame, const Vec3d& p) {
  const Vec3d d = p - frame.center;
  return {dot(frame.axes[0], d), dot(frame.axes[1], d), dot(frame.axes[2], d)};
}

// The volumes of slices across the longest axis, from end to end, by the signed columns over the facets'
// shadows on the plane of the two longer axes.
std::vector<double> slice_volumes(const TriangleMesh& mesh, const BodyFrame& frame, double low, double high) {
  std::vector<double> volumes(kSlices, 0.0);
  for (const auto& t : mesh.triangles) {
    const Vec3d a = in_frame(frame, mesh.vertices[t[0]]), b = in_frame(frame, mesh.vertices[t[1]]),
                c = in_frame(frame, mesh.vertices[t[2]]);
    const Vec3d middle = (a + b + c) * (1.0 / 3.0);
    const double column = middle.z * 0.5 * ((b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y));
    const double place = (middle.x - low) / (high - low) * static_cast<double>(kSlices);
    volumes[static_cast<std::size_t>(std::clamp(place, 0.0, kSlices - 1.0))] += column;
  }
  return volumes;
}

double narrowest_waist(const std::vector<double>& areas) {
  std::vector<double> before(areas), after(areas);
  for (std::size_t i = 1; i < areas.size(); ++i) before[i] = std::max(before[i], before[i - 1]);
  for (std::size_t i = areas.size() - 1; i-- > 0;) after[i] = std::max(after[i], after[i + 1]);
  double waist = 1.0;
  for (std::size_t i = 0; i < areas.size(); ++i)
    waist = std::min(waist, areas[i] / std::min(before[i], after[i]));
  return waist;
}

// The means of three neighbours.
std::vector<double> smoothed(const std::vector<double>& values) {
  std::vector<double> means(values);
  for (std::size_t i = 1; i + 1 < values.size(); ++i)
    means[i] = (values[i - 1] + values[i] + values[i + 1]) / 3.0;
  return means;
}

}  // namespace

BodyFrame body_frame(const TriangleMesh& mesh) {
  const BodyMass mass = body_mass(mesh);
  const PrincipalAxes principal = principal_axes(mass.inertia);
  const auto& [a, b, c] = principal.moments;
  const auto half_axis = [&](double square) { return std::sqrt(std::max(square, 0.0) * 2.5 / mass.volume); };
  return {mass.volume,
          mass.center,
          {half_axis(b + c - a), half_axis(a + c - b), half_axis(a + b - c)},
          principal.axes};
}

ShapeFeatures shape_features(const TriangleMesh& mesh, const BodyFrame& frame) {
  double low = 0.0, high = 0.0, ratios = 0.0, near = 0.0;
  for (const Vec3d& vertex : mesh.vertices) {
    const Vec3d p = in_frame(frame, vertex);
    low = std::min(low, p.x), high = std::max(high, p.x);
    if (std::fabs(p.z) > kEquator * norm(p)) continue;
    const Vec3d u{p.x / frame.half_axes.x, p.y / frame.half_axes.y, p.z / frame.half_axes.z};
    ratios += norm(u), near += 1.0;
  }
  const auto& [a, b, c] = frame.half_axes;
  return {a / b, c / b, narrowest_waist(smoothed(slice_volumes(mesh, frame, low, high))),
          near > 0.0 ? ratios / near : 1.0};
}

BodyClass classify_body(const ShapeFeatures& f) {
  if (f.waist < 0.8) return BodyClass::kContactBinary;
  if (f.ridge > 1.03 && f.elongation < 1.15) return BodyClass::kTop;
  if (f.elongation > 1.5) return BodyClass::kElongated;
  if (f.flatness / f.elongation > 0.75) return BodyClass::kRounded;
  return BodyClass::kFragment;
}

}  // namespace astrolith
