#include "tasks/description/description_jobs.h"

#include "apps/program.h"

int main(int argc, char** argv) {
  astrolith::Program program("render",
                             "Draws a sunlit picture of a mesh, with shadows; a .ply also in the colours of "
                             "a property of its vertices.");
  return program.run(argc, argv, astrolith::declare_render(program));
}
