#include "tasks/description/description_jobs.h"

#include "apps/program.h"

int main(int argc, char** argv) {
  astrolith::Program program("classify",
                             "Learns classes of shapes from folders of meshes, and names the class of "
                             "others. \"classify train --help\" states the options of training.");
  return program.run(argc, argv, astrolith::declare_classify(program));
}
