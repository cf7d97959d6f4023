#include "apps/synth/synth_predict_members.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <string>
#include <system_error>
#include <vector>

#include "apps/counted.h"
#include "apps/memory_use.h"
#include "apps/synth/silenced_program.h"
#include "numerics/errors.h"
#include "tasks/synthesis/load_recipe.h"
#include "tasks/synthesis/mesh_region.h"

namespace astrolith {
namespace {

namespace fs = std::filesystem;

// One member of so many is looked at, within these bounds.
constexpr std::uint64_t kMembersForOne = 20, kFewest = 2, kMost = 8;
// Up to this resolution a member is made: predicting it would take as long.
constexpr int kSmall = 128;

// The first, the last and some between.
std::vector<std::uint64_t> sampled_members(const MemberRange& range) {
  const std::uint64_t all = range.end - range.begin;
  const std::uint64_t count = std::min(all, std::clamp(all / kMembersForOne, kFewest, kMost));
  std::vector<std::uint64_t> numbers{range.begin};
  for (std::uint64_t i = 1; i < count; ++i) numbers.push_back(range.begin + (all - 1) * i / (count - 1));
  return numbers;
}

// A folder that goes away with this object.
class PassingFolder {
 public:
  PassingFolder() {
    std::string name = (fs::temp_directory_path() / "synth_predict_XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr)
      throw InputError(name + ": cannot make this folder; let TMPDIR name one that is writable");
    path_ = name;
  }
  PassingFolder(const PassingFolder&) = delete;
  PassingFolder& operator=(const PassingFolder&) = delete;
  ~PassingFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  // A file of this folder with the extension of `like`; no file where `like` is none.
  fs::path file(const char* stem, const fs::path& like) const {
    const bool packed = like.extension() == ".zst";
    const std::string extension = (packed ? like.stem() : like).extension().string() + (packed ? ".zst" : "");
    return like.empty() ? fs::path() : path_ / (stem + extension);
  }
  double bytes() const {
    double sum = 0.0;
    for (const fs::directory_entry& entry : fs::directory_iterator(path_))
      sum += static_cast<double>(entry.file_size());
    return sum;
  }

 private:
  fs::path path_;
};

struct MemberCost {
  double triangles = 0.0, file_bytes = 0.0, seconds = 0.0, peak_bytes = 0.0;
};

class MemberPrediction {
 public:
  MemberPrediction(Program& program, const MeshRequest& mesh, const MemberFiles& files, const Recipe& recipe,
                   const fs::path& file)
      : program_(program), mesh_(mesh), files_(files), recipe_(recipe), file_(file) {
    if (files_.mesh.empty() && files_.recipe.empty()) files_.mesh = "body.ply";
  }

  MemberCost of(std::uint64_t number) const {
    const auto start = std::chrono::steady_clock::now();
    const FamilyMember member = family_member(recipe_, number);
    const auto seconds = [&] {
      return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    if (files_.mesh.empty()) {
      const double bytes = made(member, nullptr);
      return {0.0, bytes, seconds(), static_cast<double>(peak_bytes())};
    }
    int resolution = 0;
    MemberCost cost = predicted(member, resolution);
    if (resolution > kSmall) return with_other_files(member, cost);
    const auto begin = std::chrono::steady_clock::now();
    cost.file_bytes = made(member, &mesh_);
    cost.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    cost.peak_bytes = std::max(cost.peak_bytes, static_cast<double>(peak_bytes()));
    return cost;
  }

 private:
  // The mesh alone.
  MemberCost predicted(const FamilyMember& member, int& resolution) const {
    MeshRequest request = mesh_;
    request.size.only_predict = true;
    const double before = std::min(program_.seconds(), static_cast<double>(std::clock()) / CLOCKS_PER_SEC);
    const SilencedProgram silenced(program_);
    make_mesh(program_, request, member.recipe, file_, files_.mesh);
    const auto& figures = program_.summary["predicted"];
    resolution = program_.summary["resolution"].get<int>();
    return {figures["triangles"].get<double>(), figures["file_bytes"].get<double>(),
            figures["seconds"].get<double>() - before, figures["peak_bytes"].get<double>()};
  }

  // Pictures, lists and recipes hardly depend on the resolution: those of a coarse mesh stand for them.
  MemberCost with_other_files(const FamilyMember& member, MemberCost cost) const {
    if (mesh_.preview.file.empty() && mesh_.landforms.empty() && files_.recipe.empty()) return cost;
    MeshRequest coarse = mesh_;
    coarse.size = {};
    coarse.size.resolution = kSmall;
    coarse.gravity = {};
    coarse.labels = false;
    const auto begin = std::chrono::steady_clock::now();
    cost.file_bytes += made(member, &coarse, false);
    cost.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return cost;
  }

  // Makes the files of a member, without its mesh where none is asked for. Returns their bytes.
  double made(const FamilyMember& member, const MeshRequest* mesh, bool counts_mesh = true) const {
    const PassingFolder folder;
    const fs::path output = folder.file("mesh", files_.mesh);
    if (mesh != nullptr) {
      MeshRequest request = *mesh;
      request.size.only_predict = false;
      request.preview.file = folder.file("picture", mesh->preview.file);
      request.preview.maps = folder.file("maps", mesh->preview.maps);
      request.landforms = folder.file("list", mesh->landforms);
      if (recipe_.family && !request.preview.file.empty())
        set_light_and_view(*recipe_.family, member, request.preview);
      const SilencedProgram silenced(program_);
      make_mesh(program_, request, member.recipe, file_, output);
      if (!counts_mesh) fs::remove(output);
    }
    if (!files_.recipe.empty()) write_loaded_recipe(member.recipe, folder.file("recipe", files_.recipe));
    return folder.bytes();
  }

  Program& program_;
  const MeshRequest& mesh_;
  MemberFiles files_;
  const Recipe& recipe_;
  const fs::path& file_;
};

MemberCost cost_of_all(const std::vector<MemberCost>& sample, double members) {
  MemberCost all;
  const double share = members / static_cast<double>(sample.size());
  for (const MemberCost& one : sample) {
    all.triangles += share * one.triangles;
    all.file_bytes += share * one.file_bytes;
    all.seconds += share * one.seconds;
    all.peak_bytes = std::max(all.peak_bytes, one.peak_bytes);
  }
  return all;
}

}  // namespace

void predict_members(Program& program, const MembersRequest& request, const MeshRequest& mesh,
                     const MemberFiles& files, const Recipe& recipe, const fs::path& file) {
  check_mesh_request(mesh, recipe, file);
  if (!files.mesh.empty()) check_mesh_name(mesh, files.mesh);
  prepare_summary(program);
  const MemberRange range = range_of(request);
  const double start = program.seconds();
  const MemberPrediction prediction(program, mesh, files, recipe, file);
  const std::vector<std::uint64_t> numbers = sampled_members(range);
  std::vector<MemberCost> sample;
  for (const std::uint64_t number : numbers) {
    try {
      sample.push_back(prediction.of(number));
    } catch (const InputError& e) {
      throw InputError(fmt::format("member {}: {}", number, e.what()));
    }
  }
  const std::uint64_t members = range.end - range.begin;
  const MemberCost all = cost_of_all(sample, static_cast<double>(members));
  program.summary["predicted"] = {{"triangles", all.triangles},
                                  {"file_bytes", all.file_bytes},
                                  {"peak_bytes", all.peak_bytes},
                                  {"seconds", all.seconds},
                                  {"members", members},
                                  {"sampled_members", numbers},
                                  {"own_seconds", program.seconds() - start}};
  program.say(
      fmt::format("{} members: about {} triangles, {} of files, {} memory, about {:.0f} s; from {} of them",
                  members, rounded_count(all.triangles), byte_words(all.file_bytes),
                  byte_words(all.peak_bytes), std::ceil(all.seconds), numbers.size()));
}

}  // namespace astrolith
