#include "apps/synth/synth_members.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cstdint>
#include <new>
#include <utility>
#include <vector>

#include "apps/synth/silenced_program.h"
#include "numerics/errors.h"
#include "numerics/files/output_file.h"
#include "numerics/files/sha256.h"
#include "numerics/vec3_json.h"
#include "numerics/version/code_version.h"
#include "recipe/recipe_json.h"
#include "tasks/job/words.h"
#include "tasks/synthesis/load_recipe.h"
#include "tasks/synthesis/manifest.h"

namespace astrolith {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::string_view kNumberMark = "{member}";
constexpr std::uint64_t kMostMembers = std::uint64_t{1} << 53;  // as JSON keeps whole numbers

std::uint64_t member_number(std::string_view text) {
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (text.empty() || error != std::errc() || end != text.data() + text.size() || number > kMostMembers) {
    throw InputError("members: must be A:B, whole numbers up to 2^53, as in 0:1000");
  }
  return number;
}

MemberRange parse_range(const std::string& text) {
  const std::size_t colon = std::min(text.find(':'), text.size());
  if (colon == text.size()) throw InputError("members: must be A:B, members A to B - 1, as in 0:1000");
  const std::string_view view = text;
  const MemberRange range{member_number(view.substr(0, colon)), member_number(view.substr(colon + 1))};
  if (range.begin >= range.end) {
    throw InputError(fmt::format("members: {}:{} holds no member; the second number must be the greater one",
                                 range.begin, range.end));
  }
  return range;
}

void require_mark(const fs::path& name, const std::string& option) {
  if (name.empty() || name.string().find(kNumberMark) != std::string::npos) return;
  throw InputError(
      option + ": every member writes a file of its own; put {member} into the name, as in body_{member}" +
      name.extension().string());
}

fs::path numbered(const fs::path& pattern, std::uint64_t member) {
  std::string name = pattern.string();
  const std::string digits = fmt::format("{:07}", member);
  for (std::size_t at = 0; (at = name.find(kNumberMark, at)) != std::string::npos; at += digits.size()) {
    name.replace(at, kNumberMark.size(), digits);
  }
  return name;
}

// Whether a member of some number has this name.
bool is_numbered(const fs::path& pattern, const fs::path& name) {
  const std::string before = pattern.string().substr(0, pattern.string().find(kNumberMark));
  const std::string text = name.string();
  if (!text.starts_with(before)) return false;
  std::uint64_t number = 0;
  const auto parsed = std::from_chars(text.data() + before.size(), text.data() + text.size(), number);
  return parsed.ec == std::errc() && numbered(pattern, number) == name;
}

void require_no_output(const fs::path& manifest, const std::vector<fs::path>& patterns) {
  if (manifest.empty()) return;
  for (const fs::path& pattern : patterns) {
    if (pattern.empty() ||
        !is_numbered(fs::absolute(pattern).lexically_normal(), fs::absolute(manifest).lexically_normal()))
      continue;
    throw InputError("manifest: " + manifest.string() +
                     " is also the name of a member's file; choose another");
  }
}

// The SHA-256 of what all members have in common: the recipe and the options that change files.
std::string hash_of_family(const Program& program, const Recipe& recipe) {
  constexpr std::array kNoEffect{"base",         "device",       "members",    "manifest", "preview",
                                 "preview-maps", "feature-list", "max-memory", "out"};
  Recipe undescribed = recipe;
  undescribed.description.clear();
  std::string text = recipe_to_json(undescribed);
  for (const auto& [name, value] : program.options.given()) {
    if (std::find(kNoEffect.begin(), kNoEffect.end(), name) != kNoEffect.end()) continue;
    text += name + "=" + value + "\n";
  }
  return sha256_of(text);
}

class MemberMaker {
 public:
  MemberMaker(Program& program, const MembersRequest& request, const MeshRequest& mesh,
              const MemberFiles& files, const Recipe& recipe, const fs::path& file)
      : program_(program),
        mesh_(mesh),
        files_(files),
        recipe_(recipe),
        file_(file),
        manifest_(request.manifest),
        family_(hash_of_family(program, recipe)) {}

  const Manifest& manifest() const { return manifest_; }

  // Throws InputError where members of the manifest were made otherwise: their bytes need not be those that
  // this program and these options make.
  void require_same_set(const fs::path& manifest) const {
    const std::string instead =
        "name another manifest and other files, or remove it to make all members anew";
    if (manifest_.has_other_family(family_)) {
      throw InputError(manifest.string() + ": has members of another recipe, or made with other options; " +
                       instead);
    }
    const std::string other = manifest_.other_version(version());
    if (other.empty()) return;
    throw InputError(manifest.string() + ": has members that " + other + " made, and this is " + version() +
                     "; go on with that program, " + instead);
  }

  bool is_finished(std::uint64_t member) const { return manifest_.has(member, family_, names_of(member)); }

  void make(std::uint64_t number) const {
    make_folders(number);
    const auto start = std::chrono::steady_clock::now();
    const FamilyMember member = family_member(recipe_, number);
    Json line = {
        {"member", number}, {"family", family_}, {"seed", member.recipe.seed}, {"drawn", Json::object()}};
    for (const auto& [field, value] : member.drawn) line["drawn"][field] = value;
    make_mesh_of(number, member, line);
    if (!files_.recipe.empty()) write_loaded_recipe(member.recipe, numbered(files_.recipe, number));
    std::vector<ManifestFile> written;
    for (const fs::path& name : names_of(number)) written.push_back(manifest_.file_of(name));
    line["files"] = to_json(written);
    line["version"] = version();
    line["seconds"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    manifest_.append(line);
  }

  void make_folders(std::uint64_t number) const {
    for (const fs::path& name : names_of(number)) {
      if (name.has_parent_path()) make_output_folder(name.parent_path());
    }
  }

  // The names of all files of a member, in the order of the manifest's lines.
  std::vector<fs::path> names_of(std::uint64_t member) const {
    std::vector<fs::path> names;
    for (const fs::path& pattern :
         {files_.mesh, mesh_.preview.file, mesh_.preview.maps, mesh_.landforms, files_.recipe}) {
      if (!pattern.empty()) names.push_back(numbered(pattern, member));
    }
    return names;
  }

 private:
  void make_mesh_of(std::uint64_t number, const FamilyMember& member, Json& line) const {
    if (files_.mesh.empty()) return;
    MeshRequest request = mesh_;
    request.preview.file = numbered(mesh_.preview.file, number);
    request.preview.maps = numbered(mesh_.preview.maps, number);
    request.landforms = numbered(mesh_.landforms, number);
    if (recipe_.family && !mesh_.preview.file.empty()) {
      set_light_and_view(*recipe_.family, member, request.preview);
      if (recipe_.family->any_view) line["view"] = json_of(member.view);
      if (recipe_.family->any_sun) line["sun"] = json_of(member.sun);
    }
    const SilencedProgram silenced(program_);
    make_mesh(program_, request, member.recipe, file_, numbered(files_.mesh, number));
    for (const char* figure : {"vertices", "triangles", "closed", "manifold", "genus", "components"}) {
      if (program_.summary.contains(figure)) line[figure] = program_.summary[figure];
    }
  }

  // Two programs with changes that no commit holds differ by the digest of these changes.
  std::string version() const {
    return program_.tool() + (kCodeVersion.changes.empty() ? "" : " " + kCodeVersion.changes);
  }

  Program& program_;
  const MeshRequest& mesh_;
  const MemberFiles& files_;
  const Recipe& recipe_;
  const fs::path& file_;
  Manifest manifest_;
  std::string family_;
};

struct Tally {
  std::uint64_t made = 0, there = 0, failed = 0;
};

// Makes one member. False where it failed, which has been said then.
bool make_or_report(Program& program, const MemberMaker& maker, std::uint64_t number) {
  std::string reason;
  try {
    maker.make(number);
    return true;
  } catch (const std::bad_alloc&) {
    reason = "out of memory; try a smaller resolution";
  } catch (const std::exception& e) {
    reason = e.what();
  }
  if (!Program::interrupted()) program.report_failure(fmt::format("member {}: {}", number, reason));
  return false;
}

// The manifest tells files that a power cut damaged, so that members need not wait for the disk one by one.
Tally make_range(Program& program, const MemberMaker& maker, const MemberRange& range) {
  const UnsyncedOutputs unsynced;
  const Progress progress = program.progress("members");
  Tally tally;
  for (std::uint64_t number = range.begin; number < range.end; ++number) {
    const double share =
        static_cast<double>(number - range.begin) / static_cast<double>(range.end - range.begin);
    if (!progress(share, fmt::format("member {}", number))) break;
    if (maker.is_finished(number)) {
      ++tally.there;
    } else if (make_or_report(program, maker, number)) {
      ++tally.made;
    } else if (!Program::interrupted()) {
      ++tally.failed;
    }
  }
  if (!Program::interrupted()) progress(1.0, "");
  return tally;
}

// Folders are made, and what cannot be written is refused, before any work.
void prepare_outputs(const Program& program, const MemberMaker& maker, const MeshRequest& mesh,
                     const MemberFiles& files, std::uint64_t first) {
  maker.make_folders(first);
  MeshRequest request = mesh;
  request.preview.file = numbered(mesh.preview.file, first);
  request.preview.maps = numbered(mesh.preview.maps, first);
  request.landforms = numbered(mesh.landforms, first);
  check_mesh_outputs(program, request, numbered(files.mesh, first));
}

}  // namespace

MemberRange range_of(const MembersRequest& request) { return parse_range(request.range); }

void set_light_and_view(const Family& family, const FamilyMember& member, PreviewRequest& preview) {
  if (family.any_view) preview.look.look_from(member.view);
  if (family.any_sun) preview.look.light_from(member.sun);
}

void declare_members_options(Program& program, MembersRequest& request) {
  program.makes_folders = [&request] { return !request.range.empty(); };
  Option members =
      program.app
          .add_option("--members", request.range,
                      "make members A to B - 1 of the recipe's family instead, each with files of its own: "
                      "{member} in their names stands for its number. Member 4711 is the same body on every "
                      "machine. Needs a --manifest, but for --predict")
          .placeholder("A:B");
  program.app.add_option("--out", request.folder, "with --members: short for -o DIR/{member}.ply")
      .needs(members)
      .excludes(program.app.option("--output"))
      .placeholder("DIR")
      .writes([](const auto& words) { return std::vector{fs::path(words.front()) / "{member}.ply"}; });
  program.app
      .add_option("--manifest", request.manifest,
                  "with --members: a file that gets a line of JSON for each finished member. Members that it "
                  "has, and whose files are whole, are not made again")
      .needs(members)
      .placeholder("FILE.jsonl")
      .writes();
}

void check_members(const MembersRequest& request, const MeshRequest& mesh, const MemberFiles& files) {
  parse_range(request.range);
  const bool pictures = !mesh.preview.file.empty() || !mesh.preview.maps.empty() || !mesh.landforms.empty();
  if (files.mesh.empty() && !files.recipe.empty() && pictures)
    throw InputError(
        "--write-recipe without -o keeps recipes alone; leave out --preview, --preview-maps and "
        "--feature-list, or "
        "add -o");
  if (request.manifest.empty() && !mesh.size.only_predict)
    throw InputError("manifest: is required with --members; add --manifest bodies.jsonl");
  require_mark(files.mesh, "--output");
  require_mark(files.recipe, "--write-recipe");
  require_mark(mesh.preview.file, "--preview");
  require_mark(mesh.preview.maps, "--preview-maps");
  require_mark(mesh.landforms, "--feature-list");
  require_no_output(request.manifest,
                    {files.mesh, files.recipe, mesh.preview.file, mesh.preview.maps, mesh.landforms});
}

void prepare_summary(const Program& program) {
  const fs::path file = program.summary_file;
  if (file.empty()) return;
  if (file.has_parent_path()) make_output_folder(file.parent_path());
  require_writable(file);
}

void make_members(Program& program, const MembersRequest& request, const MeshRequest& mesh,
                  const MemberFiles& files, const Recipe& recipe, const fs::path& file) {
  const MemberRange range = parse_range(request.range);
  if (!files.mesh.empty()) check_mesh_request(mesh, recipe, file);
  if (request.manifest.has_parent_path()) make_output_folder(request.manifest.parent_path());
  const MemberMaker maker(program, request, mesh, files, recipe, file);
  maker.require_same_set(request.manifest);
  prepare_outputs(program, maker, mesh, files, range.begin);
  prepare_summary(program);
  if (const int unreadable = maker.manifest().unreadable_lines(); unreadable > 0) {
    program.say(fmt::format("note: {}: {} cut short or of another kind; such members are made again",
                            request.manifest.string(),
                            counted(static_cast<std::size_t>(unreadable), "line")));
  }
  const Tally tally = make_range(program, maker, range);
  for (const fs::path& name : maker.names_of(range.begin)) sync_file_system(fs::absolute(name).parent_path());
  sync_file_system(request.manifest);
  program.summary["members"] = {
      {"made", tally.made}, {"already_there", tally.there}, {"failed", tally.failed}};
  program.say(fmt::format("{}: {} made, {} already there, {} failed, of {}{}", request.manifest.string(),
                          tally.made, tally.there, tally.failed, range.end - range.begin,
                          Program::interrupted() ? "; stopped, the same command goes on" : ""));
}

}  // namespace astrolith
