// The rigid motion that brings one surface onto another.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "geometry/surface/surface_tree.h"
#include "geometry/triangle_mesh.h"
#include "numerics/progress.h"

namespace astrolith {

// p -> R p + shift, in the unit of the meshes.
struct RigidMotion {
  std::array<Vec3d, 3> rows{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};  // of the rotation R
  Vec3d shift;

  Vec3d turned(const Vec3d& p) const { return {dot(rows[0], p), dot(rows[1], p), dot(rows[2], p)}; }
  Vec3d operator()(const Vec3d& p) const { return turned(p) + shift; }
};

// The motion of b for which random points of b lie nearest to a, on average. It begins where b stands, and
// with the principal axes of b along those of a in each of their four attitudes. From each it goes on by
// iterated closest points: to the tangent planes of a (Chen and Medioni 1992), by least squares. Sizes stay.
// Throws as sample_surface does, and WorkError where progress asks to stop.
RigidMotion align_surface(const TriangleMesh& a, const SurfaceTree& tree_a, const TriangleMesh& b,
                          std::uint64_t seed, const Progress& progress);

TriangleMesh moved(const RigidMotion& motion, TriangleMesh mesh);

nlohmann::ordered_json alignment_json(const RigidMotion& motion);

}  // namespace astrolith
