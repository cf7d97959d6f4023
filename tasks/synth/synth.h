// synth: a recipe becomes a closed mesh, a picture of it, or the texture of its layers; or many bodies.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "tasks/job/job.h"
#include "tasks/synth/mesh_job.h"

namespace astrolith {

// Declares the options of the job; the result does its work.
JobWork declare_synth(Job& job);

// What a caller in another program, such as Python, has in place of files.
struct SynthCaller {
  std::string
      recipe;  // the text of a recipe, whose images lie in the current folder; empty = a file is named
  std::vector<std::filesystem::path>
      prefixes;  // where packages are installed, the likeliest first: for --page
  std::function<void(KeptMesh&&)> arrays =
      {};  // takes the meshes, from several threads where there are members
};
JobWork declare_called_synth(Job& job, SynthCaller caller);

}  // namespace astrolith
