#include "synthesis/gabor/gabor_cells.h"

#include <cmath>

#include "numerics/hash_random.h"
#include "synthesis/body/local_metaballs.h"

namespace astrolith {

void GaborCellCenters::find(std::span<const GaborCell> cells, const SurfaceBand& band,
                            const GaborGround& ground) {
  for (std::vector<float>* v : {&x, &y, &z, &distance, &gx, &gy, &gz}) v->resize(cells.size());
  Box box;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Vec3f p = gabor_cell_center(band, cells[i][0], cells[i][1], cells[i][2]);
    box.extend({p.x, p.y, p.z});
    x[i] = p.x;
    y[i] = p.y;
    z[i] = p.z;
  }
  const int n = static_cast<int>(cells.size());
  if (ground.origin != nullptr) {
    const Box at{box.min + *ground.origin, box.max + *ground.origin};
    const ReachingMetaballs reaching = metaballs_reaching(ground.body, ground.arrays, ground.metaballs, at);
    evaluate_local_metaballs(metaballs_of_plain(ground.body, ground.arrays, reaching.lists()), *ground.origin,
                             n, x.data(), y.data(), z.data(), distance.data(), gx.data(), gy.data(),
                             gz.data());
    return;
  }
  const ReachingMetaballs reaching = metaballs_reaching(ground.body, ground.arrays, ground.metaballs, box);
  evaluate_body(ground.body, ground.arrays, reaching.lists(), n, x.data(), y.data(), z.data(),
                distance.data(), gx.data(), gy.data(), gz.data());
}

std::vector<GaborImpulse> draw_cells(const SurfaceBand& band, const GaborGround& ground,
                                     std::span<const GaborCell> cells) {
  GaborCellCenters centers;
  centers.find(cells, band, ground);
  std::vector<GaborImpulse> impulses;
  const GaborLobeShare* lobes = ground.arrays[band.lobes];
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const GaborCell& c = cells[i];
    for_each_gabor_impulse(band, lobes, band.lobes.count, c[0], c[1], c[2], -centers.distance[i],
                           Vec3f{centers.gx[i], centers.gy[i], centers.gz[i]},
                           [&](const GaborImpulse& impulse) { impulses.push_back(impulse); });
  }
  return impulses;
}

}  // namespace astrolith
