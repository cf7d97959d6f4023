#include "apps/synth/synth_predict_members.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string>

#include "apps/synth/silenced_program.h"
#include "tasks/job/words.h"
#include "tasks/prediction/set_prediction.h"
#include "tasks/synthesis/load_recipe.h"
#include "tasks/synthesis/mesh_region.h"

namespace astrolith {
namespace {

namespace fs = std::filesystem;

// A file of the folder with the extensions of `like`; no file where `like` is none.
fs::path file_in(const fs::path& folder, const char* stem, const fs::path& like) {
  return like.empty() ? fs::path()
                      : folder / (stem + like.stem().extension().string() + like.extension().string());
}

// Predicts and makes members of a recipe, without a word and without a summary.
class QuietMembers {
 public:
  QuietMembers(Program& program, const MeshRequest& mesh, const MemberFiles& files, const Recipe& recipe,
               const fs::path& file)
      : program_(program), mesh_(mesh), files_(files), recipe_(recipe), file_(file) {
    if (files_.mesh.empty() && files_.recipe.empty()) files_.mesh = "body.ply";
  }

  MemberWork work() const {
    MemberWork work;
    work.make = [this](std::uint64_t number, const fs::path& folder) { make(number, mesh_, folder); };
    if (files_.mesh.empty()) return work;
    work.predict = [this](std::uint64_t number) { return predicted(number); };
    if (mesh_.preview.file.empty() && mesh_.landforms.empty() && files_.recipe.empty()) return work;
    work.make_other_files = [this](std::uint64_t number, int resolution, const fs::path& folder) {
      MeshRequest coarse = mesh_;
      coarse.size = {};
      coarse.size.resolution = resolution;
      coarse.gravity = {};
      coarse.labels = false;
      fs::remove(make(number, coarse, folder));
    };
    return work;
  }

 private:
  // The mesh alone.
  PredictedMember predicted(std::uint64_t number) const {
    MeshRequest request = mesh_;
    request.size.only_predict = true;
    const double of_processor = Program::processor_seconds();
    const double on_clock = std::min(program_.seconds(), of_processor);
    const SilencedProgram silenced(program_);
    make_mesh(program_, request, family_member(recipe_, number).recipe, file_, files_.mesh);
    const auto& figures = program_.summary["predicted"];
    return {program_.summary["resolution"].get<int>(),
            {figures["triangles"].get<double>(), figures["file_bytes"].get<double>(),
             figures["peak_bytes"].get<double>(), figures["seconds"].get<double>() - on_clock,
             figures["processor_seconds"].get<double>() - of_processor}};
  }

  // Makes the files of a member. Returns the name of its mesh, empty where none is asked for.
  fs::path make(std::uint64_t number, const MeshRequest& mesh, const fs::path& folder) const {
    const FamilyMember member = family_member(recipe_, number);
    const fs::path output = file_in(folder, "mesh", files_.mesh);
    if (!output.empty()) {
      MeshRequest request = mesh;
      request.size.only_predict = false;
      request.preview.file = file_in(folder, "picture", mesh.preview.file);
      request.preview.maps = file_in(folder, "maps", mesh.preview.maps);
      request.landforms = file_in(folder, "list", mesh.landforms);
      if (recipe_.family && !request.preview.file.empty())
        set_light_and_view(*recipe_.family, member, request.preview);
      const SilencedProgram silenced(program_);
      make_mesh(program_, request, member.recipe, file_, output);
    }
    if (!files_.recipe.empty()) write_loaded_recipe(member.recipe, file_in(folder, "recipe", files_.recipe));
    return output;
  }

  Program& program_;
  const MeshRequest& mesh_;
  MemberFiles files_;
  const Recipe& recipe_;
  const fs::path& file_;
};

}  // namespace

void predict_members(Program& program, const MembersRequest& request, const MeshRequest& mesh,
                     const MemberFiles& files, const Recipe& recipe, const fs::path& file) {
  check_mesh_request(mesh, recipe, file);
  if (!files.mesh.empty()) check_mesh_name(mesh, files.mesh);
  prepare_summary(program);
  const MemberRange range = range_of(request);
  const double start = program.seconds();
  const QuietMembers quiet(program, mesh, files, recipe, file);
  const auto [all, numbers] = predict_set(range.begin, range.end, quiet.work());
  const std::uint64_t members = range.end - range.begin;
  program.summary["predicted"] = {{"triangles", all.triangles},
                                  {"file_bytes", all.file_bytes},
                                  {"peak_bytes", all.peak_bytes},
                                  {"seconds", all.seconds},
                                  {"processor_seconds", all.processor_seconds},
                                  {"members", members},
                                  {"sampled_members", numbers},
                                  {"own_seconds", program.seconds() - start}};
  program.say(fmt::format("{} members: about {} triangles, {} of files, {} memory, {}; from {} of them",
                          members, rounded_count(all.triangles), byte_words(all.file_bytes),
                          byte_words(all.peak_bytes), seconds_words(all.seconds, all.processor_seconds),
                          numbers.size()));
}

}  // namespace astrolith
