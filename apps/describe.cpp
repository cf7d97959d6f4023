#include "tasks/description/description_jobs.h"

#include "apps/program.h"

int main(int argc, char** argv) {
  astrolith::Program program("describe",
                             "Writes the histogram of features of pairs of surface points, a fingerprint of "
                             "the shape that does not change when the shape is moved, turned or scaled. With "
                             "--surface it writes what the surface is like from place to place.");
  return program.run(argc, argv, astrolith::declare_describe(program));
}
