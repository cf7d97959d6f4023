#include "tasks/synth/check_tiles.h"

#include "apps/program.h"

int main(int argc, char** argv) {
  astrolith::Program program("check_tiles",
                             "Says whether the tiles of a body, made by synth --tile I/N --summary "
                             "FILE.json, are complete and join to one closed 2-manifold mesh.");
  return program.run(argc, argv, astrolith::declare_check_tiles(program));
}
