#include "tasks/description/alignment.h"

#include <Eigen/Cholesky>
#include <cstddef>
#include <limits>
#include <vector>

#include "geometry/surface/mesh_sampling.h"
#include "gravity/body_mass.h"
#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "numerics/vec3_json.h"

namespace astrolith {
namespace {

constexpr std::int64_t kAlignmentSamples = 3000;
constexpr int kFirstSteps = 10, kLastSteps = 60;

struct Placed {
  RigidMotion motion;
  double distance = std::numeric_limits<double>::infinity();  // mean
};

struct PrincipalFrame {
  Vec3d center;
  std::array<Vec3d, 3> axes;
};

PrincipalFrame principal_frame(const std::vector<Vec3d>& points) {
  PrincipalFrame frame;
  for (const Vec3d& p : points) frame.center += (1.0 / static_cast<double>(points.size())) * p;
  Matrix3 spread{};
  for (const Vec3d& p : points) {
    const Vec3d d = p - frame.center;
    const double of[3] = {d.x, d.y, d.z};
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) spread[i][j] += of[i] * of[j];
    }
  }
  frame.axes = principal_axes(spread).axes;
  return frame;
}

// The motion that takes the axes of b to those of a, two of them reversed where `attitude` is 1 to 3.
RigidMotion between(const PrincipalFrame& b, const PrincipalFrame& a, std::size_t attitude) {
  Vec3d rows[3];
  for (std::size_t k = 0; k < 3; ++k) {
    const double sign = attitude == 0 || attitude == k + 1 ? 1.0 : -1.0;
    rows[0] += sign * a.axes[k].x * b.axes[k];
    rows[1] += sign * a.axes[k].y * b.axes[k];
    rows[2] += sign * a.axes[k].z * b.axes[k];
  }
  RigidMotion motion{{rows[0], rows[1], rows[2]}, {}};
  motion.shift = a.center - motion.turned(b.center);
  return motion;
}

// The rotation of the quaternion 1 + (i, j, k) . half, which turns by about 2 half.
std::array<Vec3d, 3> rotation_by(const Vec3d& half) {
  const double scale = 2.0 / (1.0 + squared_norm(half)), x = half.x, y = half.y, z = half.z;
  return {{{1.0 - scale * (y * y + z * z), scale * (x * y - z), scale * (x * z + y)},
           {scale * (x * y + z), 1.0 - scale * (x * x + z * z), scale * (y * z - x)},
           {scale * (x * z - y), scale * (y * z + x), 1.0 - scale * (x * x + y * y)}}};
}

RigidMotion after(const RigidMotion& second, const RigidMotion& first) {
  RigidMotion both;
  for (std::size_t i = 0; i < 3; ++i) {
    both.rows[i] = second.rows[i].x * first.rows[0] + second.rows[i].y * first.rows[1] +
                   second.rows[i].z * first.rows[2];
  }
  both.shift = second(first.shift);
  return both;
}

class Aligner {
 public:
  Aligner(const SurfaceTree& tree, const std::vector<Vec3d>& points, const Progress& progress)
      : tree_(tree), points_(points), progress_(progress), nearest_(points.size()) {}

  // Goes on from `motion` by so many steps at most, and returns the best place on the way.
  Placed improved(RigidMotion motion, int steps) {
    Placed best;
    for (int step = 0; step <= steps; ++step) {
      if (progress_ && !progress_(0.0, "align")) throw WorkError("stopped before the surfaces were aligned");
      const double distance = look_up(motion);
      constexpr double kGain = 1e-6;
      const bool settled = distance > (1.0 - kGain) * best.distance;
      if (distance < best.distance) best = {motion, distance};
      if (settled && step > 3) break;
      motion = after(small_motion(motion), motion);
    }
    return best;
  }

 private:
  // Finds the nearest point of a to each moved point, and returns the mean distance.
  double look_up(const RigidMotion& motion) {
    parallel_for(
        0, static_cast<std::int64_t>(points_.size()),
        [&](std::int64_t i) {
          nearest_[static_cast<std::size_t>(i)] = tree_.closest(motion(points_[static_cast<std::size_t>(i)]));
        },
        64);
    double sum = 0.0;
    for (const ClosestPoint& found : nearest_) sum += found.distance;
    return sum / static_cast<double>(points_.size());
  }

  // The motion that brings the moved points nearest to the planes through their nearest points. Turns are
  // about the points' centre.
  RigidMotion small_motion(const RigidMotion& motion) const {
    Vec3d center;
    for (const Vec3d& p : points_) center += (1.0 / static_cast<double>(points_.size())) * motion(p);
    Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
    Eigen::Matrix<double, 6, 1> right = Eigen::Matrix<double, 6, 1>::Zero();
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Vec3d p = motion(points_[i]), n = nearest_[i].normal, turn = cross(p - center, n);
      Eigen::Matrix<double, 6, 1> row;
      row << turn.x, turn.y, turn.z, n.x, n.y, n.z;
      normal += row * row.transpose();
      right += row * dot(nearest_[i].point - p, n);
    }
    // A body that turns into itself leaves turns undecided.
    constexpr double kDamping = 1e-9;
    for (int k = 0; k < 6; ++k) normal(k, k) *= 1.0 + kDamping;
    const Eigen::Matrix<double, 6, 1> x = normal.ldlt().solve(right);
    if (!x.allFinite()) return {};
    RigidMotion small{rotation_by({0.5 * x(0), 0.5 * x(1), 0.5 * x(2)}), {}};
    small.shift = center - small.turned(center) + Vec3d{x(3), x(4), x(5)};
    return small;
  }

  const SurfaceTree& tree_;
  const std::vector<Vec3d>& points_;
  const Progress& progress_;
  std::vector<ClosestPoint> nearest_;
};

}  // namespace

RigidMotion align_surface(const TriangleMesh& a, const SurfaceTree& tree_a, const TriangleMesh& b,
                          std::uint64_t seed, const Progress& progress) {
  const std::vector<Vec3d> points_a = sample_surface(a, kAlignmentSamples, seed).points;
  const std::vector<Vec3d> points_b = sample_surface(b, kAlignmentSamples, seed).points;
  Aligner aligner(tree_a, points_b, progress);
  Placed best = aligner.improved({}, kFirstSteps);
  const PrincipalFrame frame_a = principal_frame(points_a), frame_b = principal_frame(points_b);
  for (std::size_t attitude = 0; attitude < 4; ++attitude) {
    const Placed tried = aligner.improved(between(frame_b, frame_a, attitude), kFirstSteps);
    if (tried.distance < best.distance) best = tried;
  }
  return aligner.improved(best.motion, kLastSteps).motion;
}

TriangleMesh moved(const RigidMotion& motion, TriangleMesh mesh) {
  for (Vec3d& p : mesh.vertices) p = motion(p);
  for (Vec3d& n : mesh.normals) n = motion.turned(n);
  return mesh;
}

nlohmann::ordered_json alignment_json(const RigidMotion& motion) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const Vec3d& row : motion.rows) rows.push_back(to_json(row));
  return {{"rotation", rows}, {"shift", to_json(motion.shift)}};
}

}  // namespace astrolith
