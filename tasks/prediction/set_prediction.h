// What a range of members of a family will take, from a few of them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

namespace astrolith {

// What one member takes, or a set of them: the peak is then the highest one.
struct MemberTakes {
  double triangles = 0.0, file_bytes = 0.0, peak_bytes = 0.0;
  double seconds = 0.0, processor_seconds = 0.0;  // as MeshPrediction has them
};

struct PredictedMember {
  int resolution;  // of its mesh
  MemberTakes takes;
};

// How members are made. What these functions throw passes through the prediction.
struct MemberWork {
  // Predicts the mesh of a member; empty where members have no mesh.
  std::function<PredictedMember(std::uint64_t number)> predict;
  // Makes all files of a member in a folder.
  std::function<void(std::uint64_t number, const std::filesystem::path& folder)> make;
  // Makes all files but the mesh, from a mesh of this resolution; empty where there are no others.
  std::function<void(std::uint64_t number, int resolution, const std::filesystem::path& folder)>
      make_other_files;
};

struct SetPrediction {
  MemberTakes all;
  std::vector<std::uint64_t> sampled;  // the members that were looked at
};

// Predicts the members begin .. end - 1 from the first, the last and some between. Small members are made in
// the temporary folder, and removed. Of larger ones the mesh is predicted, and the other files are made from
// a coarse mesh. Throws InputError with the member's number before what is wrong.
SetPrediction predict_set(std::uint64_t begin, std::uint64_t end, const MemberWork& work);

}  // namespace astrolith
