// fit_shape: a closed mesh becomes a recipe of metaballs.
#include "tasks/estimation/fit_shape.h"

#include "apps/program.h"

int main(int argc, char** argv) {
  astrolith::Program program("fit_shape", "Fits metaballs to a closed mesh and writes them as a recipe.");
  astrolith::FitArguments arguments;
  astrolith::declare_fit_options(program, arguments);
  return program.run(argc, argv, [&] { astrolith::fit_shape(program, arguments); });
}
