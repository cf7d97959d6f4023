#include "tasks/description/description_jobs.h"

#include "apps/program.h"

int main(int argc, char** argv) {
  astrolith::Program program(
      "compare",
      "Says as JSON how alike two meshes are in shape (similarity 1: the same; position, attitude, size and "
      "resolution "
      "do not matter) and how far apart their surfaces lie where they are or with --align, B in A's unit "
      "(mean, p99 and max "
      "distance as fractions of A's bounding-box diagonal). With --realism it also says whether the surface "
      "of B passes for that of A, in ten lines, and as JSON with --json.");
  return program.run(argc, argv, astrolith::declare_compare(program));
}
