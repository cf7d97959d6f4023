#include "apps/fit_shape/fit_shape_packing.h"

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "estimation/shape/packing/packing_table.h"
#include "estimation/shape/packing/sphere_packing.h"

namespace astrolith {
namespace {

// Centres and radii in the frame and the unit of the file.
std::vector<Sphere> in_file_frame(std::vector<Sphere> spheres, const TargetBody& target) {
  for (Sphere& s : spheres) {
    s = {target.center + target.diagonal * s.center, target.diagonal * s.radius};
  }
  return spheres;
}

}  // namespace

void write_packing(Program& program, const FitArguments& arguments, const TargetBody& target) {
  PackingOptions options;
  options.max_spheres = arguments.fit.spheres;
  const Packing packing = pack_spheres(target.mesh, target.tree, options, program.progress("pack"));
  const std::string name = std::filesystem::path(arguments.mesh).filename().string();
  char filled[80];
  std::snprintf(filled, sizeof filled, "%zu spheres fill %.2f %% of the volume", packing.spheres.size(),
                100.0 * packing.filling_rate);
  const double unit_volume = target.diagonal * target.diagonal * target.diagonal;
  write_packing_table(in_file_frame(packing.spheres, target),
                      {name + " by " + program.tool() + ": " + filled, arguments.unit,
                       target.volume * unit_volume, arguments.density},
                      arguments.output);
  if (packing.interrupted) program.say("stopped by Ctrl-C: these are the spheres so far");
  program.summary["spheres"] = packing.spheres.size();
  program.summary["filling_rate"] = packing.filling_rate;
  program.say(arguments.output + ": " + filled);
}

}  // namespace astrolith
