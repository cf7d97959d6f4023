#include "tasks/estimation/fit_shape.h"

#include <fmt/format.h>

#include "estimation/shape/packing/sphere_packing.h"

namespace astrolith {

std::string packing_words(const BodyPacking& packing) {
  return fmt::format("{} spheres fill {:.2f} % of the volume", packing.spheres.size(),
                     100.0 * packing.filling_rate);
}

BodyPacking pack_body(const TargetBody& target, const BodyPackingOptions& options, const Progress& progress) {
  PackingOptions limits;
  limits.max_spheres = options.spheres;
  Packing packed = pack_spheres(target.mesh, target.tree, limits, progress);
  BodyPacking result{std::move(packed.spheres), {}, packed.filling_rate, packed.interrupted};
  for (Sphere& s : result.spheres) {
    s = {target.center + target.diagonal * s.center, target.diagonal * s.radius};
  }
  const double unit_volume = target.diagonal * target.diagonal * target.diagonal;
  const PackingTable table{options.name + " by " + options.tool + ": " + packing_words(result), options.unit,
                           target.volume * unit_volume, options.density};
  if (options.density > 0.0) result.masses = sphere_masses(result.spheres, table);
  if (!options.to.empty()) write_packing_table(result.spheres, table, options.to);
  return result;
}

}  // namespace astrolith
