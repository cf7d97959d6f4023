#include "geometry/winding_number.h"

#include <cmath>
#include <numbers>

#include "numerics/portable_angles.h"

namespace astrolith {

double winding_number(const TriangleMesh& mesh, const Vec3d& p) {
  double half_angles = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3d a = mesh.vertices[t[0]] - p, b = mesh.vertices[t[1]] - p, c = mesh.vertices[t[2]] - p;
    const double la = norm(a), lb = norm(b), lc = norm(c);
    const double away = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
    half_angles += portable::atan2(dot(a, cross(b, c)), away);
  }
  return half_angles / (2.0 * std::numbers::pi);
}

}  // namespace astrolith
