#include "tasks/gravity/gravity_job.h"

#include "apps/program.h"

int main(int argc, char** argv) {
  astrolith::Program program(
      "gravity",
      "Computes gravitational potential, acceleration, geopotential, slope and elevation of a body of "
      "uniform density that turns: at its facets, at its vertices, or at points inside and outside. Prints "
      "ten lines, or with --json mass, moments, harmonics and ranges as JSON; --summary writes these to a "
      "file.");
  return program.run(argc, argv, astrolith::declare_gravity(program));
}
