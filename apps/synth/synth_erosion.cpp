#include "apps/synth/synth_erosion.h"

#include <fmt/format.h>

#include "tasks/synthesis/erode_body.h"

namespace astrolith {

void erode_mesh(Program& program, const Erosion& erosion, TriangleMesh& mesh) {
  const ErosionStatistics done = erode_body(erosion, mesh, program.progress("erosion"));
  program.summary["erosion"] = {{"settled", done.settled},
                                {"sweeps", done.sweeps},
                                {"steepest_before", done.steepest_before},
                                {"steepest_after", done.steepest_after},
                                {"talus_angle", erosion.talus_angle},
                                {"moved_vertices", done.moved_vertices},
                                {"rock_vertices", done.rock_vertices},
                                {"volume_moved", done.volume_moved}};
  const std::string words = fmt::format(
      "erosion: {} of {} vertices moved, {} are rock; the steepest loose slope is {:.2f} degrees, before "
      "{:.2f}",
      done.moved_vertices, mesh.vertices.size(), done.rock_vertices, done.steepest_after,
      done.steepest_before);
  const std::string remedy = done.sweeps < erosion.iterations ? "no slide lowers it; raise --resolution"
                                                              : "raise erosion.iterations";
  program.say(words + (done.settled
                           ? fmt::format("; settled below {:g}", erosion.talus_angle)
                           : fmt::format("; not settled below {:g}: {}", erosion.talus_angle, remedy)));
}

}  // namespace astrolith
