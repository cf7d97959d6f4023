#include "synthesis/picture/scene_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "numerics/errors.h"

namespace astrolith {
namespace {

constexpr int kMostCameraSide = 16384;
constexpr double kMostOfCalibration = 1e9;  // pixels, and coefficients

Vec3d row_vector(const Matrix3& m, std::size_t k) { return {m[k][0], m[k][1], m[k][2]}; }

void check_calibration(const Calibration& c) {
  if (c.width < 1 || c.height < 1 || c.width > kMostCameraSide || c.height > kMostCameraSide) {
    throw InputError(
        fmt::format("camera: {} x {} pixels; each side must be 1 to {}", c.width, c.height, kMostCameraSide));
  }
  if (!(c.fx > 0 && c.fy > 0)) {
    throw InputError(
        fmt::format("camera: focal lengths {:g} and {:g}; they must be above 0 pixels", c.fx, c.fy));
  }
  for (const double x : {c.fx, c.fy, c.cx, c.cy, c.skew, c.k1, c.k2, c.p1, c.p2, c.k3}) {
    if (!(std::fabs(x) <= kMostOfCalibration)) {
      throw InputError("camera: a number of the calibration is not finite or above 1e9; give pixels");
    }
  }
}

}  // namespace

Matrix3 checked_rotation(const std::string& name, const Matrix3& matrix) {
  constexpr double kTolerance = 1e-6;
  const Vec3d x = row_vector(matrix, 0), y = row_vector(matrix, 1), z = row_vector(matrix, 2);
  const double worst = std::max({std::fabs(squared_norm(x) - 1), std::fabs(squared_norm(y) - 1),
                                 std::fabs(squared_norm(z) - 1), std::fabs(dot(x, y)), std::fabs(dot(y, z)),
                                 std::fabs(dot(z, x))});
  if (!(worst <= kTolerance)) {
    throw InputError(
        fmt::format("{}: is no rotation; give a matrix whose rows are unit vectors at right angles, "
                    "to 1e-6",
                    name));
  }
  if (dot(cross(x, y), z) < 0) {
    throw InputError(fmt::format("{}: mirrors, its determinant is -1; turn one axis about", name));
  }
  const Vec3d first = normalized(x), second = normalized(y - dot(y, first) * first),
              third = cross(first, second);
  return {{{first.x, first.y, first.z}, {second.x, second.y, second.z}, {third.x, third.y, third.z}}};
}

Vec3d rotate(const Matrix3& m, const Vec3d& v) {
  return {dot(row_vector(m, 0), v), dot(row_vector(m, 1), v), dot(row_vector(m, 2), v)};
}

Vec3d rotate_back(const Matrix3& m, const Vec3d& v) {
  return v.x * row_vector(m, 0) + v.y * row_vector(m, 1) + v.z * row_vector(m, 2);
}

SceneCamera::SceneCamera(const Calibration& calibration, const Vec3d& position, const Matrix3& axes)
    : calibration_(calibration), position_(position) {
  check_calibration(calibration);
  if (!std::isfinite(squared_norm(position))) throw InputError("camera: its position is not finite");
  const Matrix3 exact = checked_rotation("camera: rotation", axes);
  right_ = row_vector(exact, 0);
  down_ = row_vector(exact, 1);
  boresight_ = row_vector(exact, 2);
  const auto& c = calibration_;
  is_distorted_ = c.k1 != 0 || c.k2 != 0 || c.p1 != 0 || c.p2 != 0 || c.k3 != 0;
  if (is_distorted_) require_no_fold();
}

SceneCamera::Distorted SceneCamera::distort(const Tangents& t) const {
  const auto [x, y] = t;
  const auto& c = calibration_;
  const double r2 = x * x + y * y;
  const double s = 1 + r2 * (c.k1 + r2 * (c.k2 + r2 * c.k3));
  const double slope = 2 * (c.k1 + r2 * (2 * c.k2 + r2 * 3 * c.k3));  // ds/dx = slope x
  const double both = x * y * slope + 2 * (c.p1 * x + c.p2 * y);
  return {{x * s + 2 * c.p1 * x * y + c.p2 * (r2 + 2 * x * x),
           y * s + c.p1 * (r2 + 2 * y * y) + 2 * c.p2 * x * y},
          s + x * x * slope + 2 * c.p1 * y + 6 * c.p2 * x,
          both,
          both,
          s + y * y * slope + 6 * c.p1 * y + 2 * c.p2 * x};
}

// Newton's iteration. None where it does not converge, or ends where the distortion has turned over.
std::optional<SceneCamera::Tangents> SceneCamera::newton(const Tangents& distorted,
                                                         const Tangents& start) const {
  constexpr int kMostSteps = 20;
  const double enough = 1e-14 * (1 + std::fabs(distorted.x) + std::fabs(distorted.y));
  Tangents at = start;
  for (int k = 0; k < kMostSteps; ++k) {
    const Distorted d = distort(at);
    const double dx = distorted.x - d.place.x, dy = distorted.y - d.place.y, determinant = d.determinant();
    if (!(determinant > 0)) return std::nullopt;
    if (std::fabs(dx) + std::fabs(dy) <= enough) return at;
    at.x += (d.yy * dx - d.xy * dy) / determinant;
    at.y += (d.xx * dy - d.yx * dx) / determinant;
  }
  return std::nullopt;
}

// Goes from the principal point towards the place in steps, each of which begins where the last one ended.
std::optional<SceneCamera::Tangents> SceneCamera::undistort_in_steps(const Tangents& distorted) const {
  constexpr int kSteps = 32;
  std::optional<Tangents> at = Tangents{0, 0};
  for (int k = 1; k <= kSteps && at; ++k) {
    const double share = static_cast<double>(k) / kSteps;
    at = newton({share * distorted.x, share * distorted.y}, *at);
  }
  return at;
}

SceneCamera::Tangents SceneCamera::undistort(const Tangents& distorted) const {
  constexpr double kBeyond = 1.05;
  std::optional<Tangents> at = newton(distorted, distorted);
  if (!at || at->x * at->x + at->y * at->y > kBeyond * most_) at = undistort_in_steps(distorted);
  if (!at)
    throw InputError("camera: its distortion folds within the picture; give the coefficients of its fit");
  return *at;
}

SceneCamera::Tangents SceneCamera::distorted_at(const ImagePoint& place) const {
  const double y = (place.row - calibration_.cy) / calibration_.fy;
  return {(place.column - calibration_.cx - calibration_.skew * y) / calibration_.fx, y};
}

// Follows lines from the principal point to the border of the picture: along none may the distortion turn
// over.
void SceneCamera::require_no_fold() {
  constexpr int kPlaces = 32, kSamples = 64;
  const double w = calibration_.width, h = calibration_.height;
  for (int k = 0; k < 4 * kPlaces; ++k) {
    const double along = static_cast<double>(k % kPlaces) / kPlaces;
    const ImagePoint border = k < kPlaces       ? ImagePoint{along * w, 0}
                              : k < 2 * kPlaces ? ImagePoint{w, along * h}
                              : k < 3 * kPlaces ? ImagePoint{w - along * w, h}
                                                : ImagePoint{0, h - along * h};
    const auto end = undistort_in_steps(distorted_at({border.column - 0.5, border.row - 0.5}));
    bool folds = !end;
    for (int i = 1; i <= kSamples && !folds; ++i) {
      const double share = static_cast<double>(i) / kSamples;
      folds = !(distort({share * end->x, share * end->y}).determinant() > 0);
    }
    if (folds) {
      throw InputError(
          fmt::format("camera: its distortion folds within the picture, towards column {:.0f} of row "
                      "{:.0f}; give the coefficients of its fit, in the order k1 k2 p1 p2 k3",
                      border.column, border.row));
    }
    most_ = std::max(most_, end->x * end->x + end->y * end->y);
  }
}

Vec3d SceneCamera::direction(const ImagePoint& place) const {
  const Tangents seen = distorted_at(place), at = is_distorted_ ? undistort(seen) : seen;
  return normalized(at.x * right_ + at.y * down_ + boresight_);
}

std::optional<ImagePoint> SceneCamera::project(const Vec3d& point) const {
  const Vec3d from = point - position_;
  const double depth = dot(from, boresight_);
  if (!(depth > 0)) return std::nullopt;
  Tangents at{dot(from, right_) / depth, dot(from, down_) / depth};
  if (is_distorted_) at = distort(at).place;
  return ImagePoint{calibration_.fx * at.x + calibration_.skew * at.y + calibration_.cx,
                    calibration_.fy * at.y + calibration_.cy};
}

}  // namespace astrolith
