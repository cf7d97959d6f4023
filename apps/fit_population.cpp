// fit_population: measured bodies become a population, from which synth draws bodies.
#include "tasks/estimation/fit_population.h"

#include "apps/program.h"

int main(int argc, char** argv) {
  astrolith::Program program("fit_population",
                             "Makes a population of measured bodies, from which synth draws others.");
  return program.run(argc, argv, astrolith::declare_fit_population(program));
}
