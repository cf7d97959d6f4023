// A camera by its calibration, as OpenCV and camera reports state it, and its pose.
#pragma once

#include <optional>
#include <string>

#include "numerics/jacobi_rotation.h"
#include "numerics/vec3.h"

namespace astrolith {

// The matrix, whose rows are made exact: unit vectors at right angles. Throws InputError, naming `name`, for
// a matrix that is farther than 1e-6 from a rotation.
Matrix3 checked_rotation(const std::string& name, const Matrix3& matrix);

// The product of a matrix, or of its transpose, and a vector.
Vec3d rotate(const Matrix3& m, const Vec3d& v);
Vec3d rotate_back(const Matrix3& m, const Vec3d& v);

// The point (X, Y, Z) of the camera's axes (Z along the boresight, X to the right, Y down) has x = X / Z and
// y = Y / Z. Brown's distortion moves it, with r^2 = x^2 + y^2 and s = 1 + k1 r^2 + k2 r^4 + k3 r^6, to
//   x' = x s + 2 p1 x y + p2 (r^2 + 2 x^2),    y' = y s + p1 (r^2 + 2 y^2) + 2 p2 x y,
// and the picture shows it at column = fx x' + skew y' + cx and row = fy y' + cy. As in OpenCV, whole numbers
// are the middles of pixels: the picture's top left corner is at (-.5, -.5).
struct Calibration {
  int width = 1024, height = 1024;                      // 1 .. 16384 pixels
  double fx = 1024, fy = 1024, cx = 511.5, cy = 511.5;  // pixels; fx and fy above 0
  double skew = 0;                                      // pixels
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0, k3 = 0;        // none: a pinhole
};

// A place of a picture, in pixels.
struct ImagePoint {
  double column = 0, row = 0;
};

class SceneCamera {
 public:
  // The rows of `axes` are the camera's right, down and boresight in the axes of the scene. Throws InputError
  // for values out of range, for axes that are no rotation, and for a distortion that folds: one that shows
  // two directions at one place of the picture.
  SceneCamera(const Calibration& calibration, const Vec3d& position, const Matrix3& axes);

  const Calibration& calibration() const { return calibration_; }
  const Vec3d& position() const { return position_; }
  const Vec3d& right() const { return right_; }
  const Vec3d& down() const { return down_; }
  const Vec3d& boresight() const { return boresight_; }

  // The unit vector, in the axes of the scene, along which the camera sees a place of the picture.
  Vec3d direction(const ImagePoint& place) const;
  // Where the picture, or the plane around it, shows a point of the scene; none for one that is not before
  // the camera.
  std::optional<ImagePoint> project(const Vec3d& point) const;

 private:
  struct Tangents {
    double x, y;
  };
  // What the distortion does, and the determinant of its derivatives, which is above 0 where it keeps sides.
  struct Distorted {
    Tangents place;
    double xx, xy, yx, yy;
    double determinant() const { return xx * yy - xy * yx; }
  };

  Distorted distort(const Tangents& t) const;
  std::optional<Tangents> newton(const Tangents& distorted, const Tangents& start) const;
  std::optional<Tangents> undistort_in_steps(const Tangents& distorted) const;
  Tangents undistort(const Tangents& distorted) const;
  Tangents distorted_at(const ImagePoint& place) const;
  void require_no_fold();

  Calibration calibration_;
  Vec3d position_, right_, down_, boresight_;
  bool is_distorted_ = false;
  double most_ = 0;  // the largest r^2 within the picture
};

}  // namespace astrolith
