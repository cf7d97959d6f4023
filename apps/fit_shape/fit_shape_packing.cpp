#include "apps/fit_shape/fit_shape_packing.h"

#include <filesystem>

#include "tasks/estimation/body_packing.h"

namespace astrolith {

void write_packing(Program& program, const FitArguments& arguments, const TargetBody& target) {
  const std::string name = std::filesystem::path(arguments.mesh).filename().string();
  const BodyPacking packing = pack_body(
      target,
      {arguments.fit.spheres, arguments.unit, arguments.density, name, program.tool(), arguments.output},
      program.progress("pack"));
  if (packing.interrupted)
    program.say(std::string("stopped by ") + Program::stopped_by() + ": these are the spheres so far");
  program.summary["spheres"] = packing.spheres.size();
  program.summary["filling_rate"] = packing.filling_rate;
  program.say(arguments.output + ": " + packing_words(packing));
}

}  // namespace astrolith
