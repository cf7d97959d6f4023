#include "descriptor/classification/noisy_resampling.h"

#include <algorithm>
#include <cmath>

#include "geometry/points/point_normals.h"
#include "geometry/surface/mesh_sampling.h"
#include "numerics/errors.h"
#include "numerics/hash_random.h"

namespace astrolith {
namespace {

constexpr std::int64_t kFewestPoints = 64;

void check(const ResamplingOptions& o) {
  const bool fractions = o.fewest > 0 && o.fewest <= o.most && o.most <= 10;
  if (!fractions || !(o.noise >= 0 && o.noise <= 1) || o.normal_neighbours < 3 || o.normal_neighbours > 60) {
    throw InputError(
        "resampling: give 0 < fewest <= most <= 10, noise between 0 and 1 and 3 to 60 neighbours");
  }
}

}  // namespace

NoisyResampling noisy_resampling(const TriangleMesh& mesh, const ResamplingOptions& options,
                                 std::uint64_t seed) {
  check(options);
  CounterRandom random(seed, 1);
  const double wanted =
      random.uniform(options.fewest, options.most) * static_cast<double>(mesh.vertices.size());
  SurfaceSamples samples =
      sample_poisson_disk(mesh, std::max(kFewestPoints, std::int64_t{std::llround(wanted)}), random.next());
  const double sigma = options.noise * mesh.bounds().diagonal();
  for (Vec3d& p : samples.points) {
    p.x += sigma * random.normal();
    p.y += sigma * random.normal();
    p.z += sigma * random.normal();
  }
  NoisyResampling result;
  result.normals = point_normals(samples.points, samples.normals, options.normal_neighbours);
  result.fraction = static_cast<double>(samples.points.size()) / static_cast<double>(mesh.vertices.size());
  result.points = std::move(samples.points);
  return result;
}

}  // namespace astrolith
