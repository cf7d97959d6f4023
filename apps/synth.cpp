#include "tasks/synth/synth.h"

#include "apps/program.h"
#include "numerics/memory_use.h"

int main(int argc, char** argv) {
  astrolith::return_freed_memory();
  astrolith::Program program(
      "synth", "Turns a recipe into a closed 2-manifold mesh, or its Gabor layers into a texture.");
  return program.run(argc, argv, astrolith::declare_synth(program));
}
