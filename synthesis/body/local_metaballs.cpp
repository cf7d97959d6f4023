#include "synthesis/body/local_metaballs.h"

namespace astrolith {

void evaluate_local_metaballs(const MetaballsView& metaballs, const Vec3d& origin, int n, const float* x,
                              const float* y, const float* z, float* distance, float* gradient_x,
                              float* gradient_y, float* gradient_z) {
  const MetaballParameters<double> body = in_double(metaballs.parameters);
  for (int i = 0; i < n; ++i) {
    const SurfaceDistance<double> d =
        local_distance(body, metaballs.spheres.data(), static_cast<std::uint32_t>(metaballs.spheres.size()),
                       origin, {x[i], y[i], z[i]});
    distance[i] = static_cast<float>(d.distance);
    const Vec3f gradient = to_float(d.log_gradient);
    gradient_x[i] = gradient.x;
    gradient_y[i] = gradient.y;
    gradient_z[i] = gradient.z;
  }
}

}  // namespace astrolith
