#include "synthesis/body/local_metaballs.h"

namespace astrolith {
namespace {

MetaballSphere<double> in_double(const MetaballSphere<float>& s) {
  return {{s.center.x, s.center.y, s.center.z}, s.inverse_radius_squared};
}

}  // namespace

void evaluate_local_metaballs(const MetaballsView& metaballs, const Vec3d& origin, int n, const float* x,
                              const float* y, const float* z, float* distance, float* gradient_x,
                              float* gradient_y, float* gradient_z) {
  const MetaballParameters<double> body = in_double(metaballs.parameters);
  for (int i = 0; i < n; ++i) {
    const Vec3d p = origin + Vec3d{x[i], y[i], z[i]};
    MetaballTotals<double> totals;
    for (const MetaballSphere<float>& s : metaballs.spheres) {
      accumulate_metaball(body, in_double(s), p, totals);
    }
    const SurfaceDistance<double> d = metaball_distance(body, totals.net());
    distance[i] = static_cast<float>(d.distance);
    gradient_x[i] = static_cast<float>(d.log_gradient.x);
    gradient_y[i] = static_cast<float>(d.log_gradient.y);
    gradient_z[i] = static_cast<float>(d.log_gradient.z);
  }
}

}  // namespace astrolith
