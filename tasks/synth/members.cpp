#include "tasks/synth/members.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <new>
#include <optional>
#include <vector>

#include "cuda/device.h"
#include "geometry/io/mesh_format.h"
#include "geometry/io/mesh_io.h"
#include "numerics/errors.h"
#include "numerics/files/output_file.h"
#include "numerics/files/sha256.h"
#include "numerics/memory_use.h"
#include "numerics/parallel_for.h"
#include "numerics/process_limits.h"
#include "numerics/vec3_json.h"
#include "numerics/version/code_version.h"
#include "recipe/recipe_json.h"
#include "synthesis/finish/family_member.h"
#include "tasks/job/load_recipe.h"
#include "tasks/job/words.h"
#include "tasks/synth/manifest.h"
#include "tasks/synth/member_differences.h"

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

struct MemberRange {
  std::uint64_t begin = 0, end = 0;
};

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

bool has_mark(const fs::path& name) { return name.string().find(kNumberMark) != std::string::npos; }

fs::path numbered(const fs::path& pattern, std::uint64_t member) {
  std::string name = pattern.string();
  const std::string digits = fmt::format("{:07}", member);
  for (std::size_t at = 0; (at = name.find(kNumberMark, at)) != std::string::npos; at += digits.size()) {
    name.replace(at, kNumberMark.size(), digits);
  }
  return name;
}

// The mesh job of one member.
MeshJob numbered(MeshJob mesh, std::uint64_t member) {
  for (const NamedFile& file : list_files(mesh.sinks)) *file.name = numbered(*file.name, member);
  mesh.sinks.member = member;
  return mesh;
}

// The names of the files of a member.
std::vector<fs::path> list_names(MeshSinks sinks) {
  std::vector<fs::path> names;
  for (const NamedFile& file : list_files(sinks)) {
    if (file.name->empty()) continue;
    names.push_back(*file.name);
    if (file.name == &sinks.height_map) names.push_back(fs::path(*file.name).replace_extension(".json"));
  }
  return names;
}

// The files that the mesh job of a member has written beside those of list_names(): its levels and maps.
std::vector<fs::path> files_beside(const fs::path& mesh, const Json& summary) {
  std::vector<fs::path> names;
  const auto add = [&](const Json& name) {
    const fs::path file = mesh.parent_path() / name.get<std::string>();
    if (file != mesh && std::ranges::find(names, file) == names.end()) names.push_back(file);
  };
  for (const Json& level : summary.value("levels", Json::array())) add(level["file"]);
  for (const Json& maps : summary.value("maps", Json::array())) std::ranges::for_each(maps["files"], add);
  return names;
}

// The SHA-256 of what all members have in common: the recipe and the options that change files. A file that
// an option reads counts by its content.
std::string hash_family(const Job& job, const Recipe& recipe) {
  constexpr std::array kNoEffect{"base", "device", "members", "max-memory"};
  Recipe undescribed = recipe;
  undescribed.description.clear();
  std::string text = recipe_to_json(undescribed);
  for (const auto& [name, value] : job.options.given()) {
    if (std::find(kNoEffect.begin(), kNoEffect.end(), name) != kNoEffect.end()) continue;
    const OptionRow& row = *job.options.find(name);
    text += name + "=";
    if (!row.reads) text += value;
    for (const fs::path& file : row.reads ? row.reads(row.words) : std::vector<fs::path>{})
      text += file_sha256(file) + " ";
    text += "\n";
  }
  return sha256(text);
}

class MemberMaker {
 public:
  MemberMaker(Job& job, const MembersRequest& request, const MeshJob& mesh, const MemberSource& source)
      : job_(job),
        mesh_(mesh),
        source_(source),
        file_(request.manifest),
        manifest_(request.manifest),
        family_(hash_family(job, source.recipe)) {}

  const Manifest& manifest() const { return manifest_; }

  // Throws InputError where members of the manifest were made otherwise: their bytes need not be those that
  // this program and these options make.
  void require_same_set() const {
    const std::string instead =
        "name another manifest and other files, or remove it to make all members anew";
    if (manifest_.has_other_family(family_)) {
      throw InputError(file_.string() + ": has members of another recipe, or made with other options; " +
                       instead);
    }
    const std::string other = manifest_.other_version(version());
    if (other.empty()) return;
    throw InputError(file_.string() + ": has members that " + other + " made, and this is " + version() +
                     "; go on with that program, " + instead);
  }

  bool is_finished(std::uint64_t member) const {
    return manifest_.has(member, family_, list_names(numbered(mesh_, member).sinks));
  }

  // Makes a member's files. Returns its line of the manifest.
  Json make(std::uint64_t number) const {
    make_folders(number);
    const auto start = std::chrono::steady_clock::now();
    MeshJob mesh = numbered(mesh_, number);
    JobPart job(job_);
    const FamilyMember member = source_.draw(job, number);
    Json line = {
        {"member", number}, {"family", family_}, {"seed", member.recipe.seed}, {"drawn", Json::object()}};
    for (const auto& [field, value] : member.drawn) line["drawn"][field] = value;
    if (const auto& family = source_.recipe.family; family && !mesh.sinks.preview.file.empty()) {
      PictureOptions& look = mesh.sinks.preview.look;
      if (family->any_view && !look.chooses_view(job)) {
        look.look_from(member.view);
        line["view"] = to_json(member.view);
      }
      if (family->any_sun && !look.chooses_sun(job)) {
        look.light_from(member.sun);
        line["sun"] = to_json(member.sun);
      }
    }
    if (mesh.sinks.wanted()) make_mesh(job, mesh, member.recipe, source_.file);
    for (const char* figure : {"drawn_body", "similarity", "similarity_with", "variation", "vertices",
                               "triangles", "closed", "manifold", "genus", "components"}) {
      if (job.summary.contains(figure)) line[figure] = job.summary[figure];
    }
    if (!mesh.sinks.recipe.empty()) write_loaded_recipe(member.recipe, mesh.sinks.recipe);
    if (file_.empty()) return line;
    std::vector<ManifestFile> written;
    for (const fs::path& name : list_names(mesh.sinks)) written.push_back(manifest_.describe_file(name));
    for (const fs::path& name : files_beside(mesh.sinks.file, job.summary))
      written.push_back(manifest_.describe_file(name));
    line["files"] = to_json(written);
    line["version"] = version();
    line["seconds"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return line;
  }

  // Adds the line of a member to the manifest.
  void keep(const Json& line) const {
    if (!file_.empty()) manifest_.append(line);
  }

  void make_folders(std::uint64_t number) const {
    for (const fs::path& name : list_names(numbered(mesh_, number).sinks)) {
      if (name.has_parent_path()) make_output_folder(name.parent_path());
    }
  }

 private:
  // Two programs with changes that no commit holds differ by the digest of these changes.
  std::string version() const {
    return job_.tool() + (kCodeVersion.changes.empty() ? "" : " " + kCodeVersion.changes);
  }

  Job& job_;
  const MeshJob& mesh_;
  const MemberSource& source_;
  fs::path file_;  // the manifest; empty = none
  Manifest manifest_;
  std::string family_;
};

struct Tally {
  std::uint64_t made = 0, there = 0, failed = 0;
};

// Makes the members of a range, some beside each other. A member that fails is reported.
Tally make_range(Job& job, const MemberMaker& maker, const MemberRange& range, int beside_each_other) {
  std::mutex mutex;
  const Progress progress = job.progress("members");
  std::uint64_t next = range.begin;
  Tally tally;
  // The next member to be made; none at the end, or after a stop.
  const auto take = [&]() -> std::optional<std::uint64_t> {
    const std::lock_guard lock(mutex);
    if (next == range.end) return {};
    const double share =
        static_cast<double>(next - range.begin) / static_cast<double>(range.end - range.begin);
    if (!progress(share, fmt::format("member {}", next))) return {};
    return next++;
  };
  const auto make_or_report = [&](std::uint64_t number) {
    std::string reason;
    try {
      const bool is_there = maker.is_finished(number);
      const Json line = is_there ? Json() : maker.make(number);
      const std::lock_guard lock(mutex);
      if (!is_there) maker.keep(line);
      ++(is_there ? tally.there : tally.made);
      return;
    } catch (const std::bad_alloc&) {
      reason = "out of memory; try a smaller resolution";
    } catch (const std::exception& e) {
      reason = e.what();
    }
    if (job.stopped()) return;
    const std::lock_guard lock(mutex);
    ++tally.failed;
    job.report_failure(fmt::format("member {}: {}", number, reason));
  };
  // The manifest tells files that a power cut damaged, so that members need not wait for the disk one by one.
  const UnsyncedOutputs unsynced;
  parallel_for(0, beside_each_other, [&](std::int64_t) {
    while (const std::optional<std::uint64_t> number = take())
      within_own_loops([&] { make_or_report(*number); });
  });
  if (!job.stopped()) progress(1.0, "");
  return tally;
}

// How many of some members are made at once. A small mesh leaves threads idle, a large one needs memory: more
// is set aside for each than a mesh with gravity and a picture, or a batch of a GPU, is known to take.
int members_at_once(const MeshJob& mesh, std::uint64_t members) {
  constexpr double kMostTriangles = 1e6, kBytesPerTriangle = 600.0, kBytesPerTexel = 60.0,
                   kBytesOnGpu = 1.5e9;
  constexpr double kTrianglesPerSquare =
      5.0;  // of a mesh for the square of its resolution, with some roughness
  const MeshSpec& spec = mesh.spec;
  const double triangles =
      spec.triangles > 0.0 ? spec.triangles : kTrianglesPerSquare * spec.resolution * spec.resolution;
  if (triangles > kMostTriangles || mesh.max_memory_gb > 0.0) return 1;
  double most = std::min(static_cast<double>(thread_limit()), static_cast<double>(members));
  const double map_bytes = kBytesPerTexel * mesh.sinks.bake * mesh.sinks.bake;
  most = std::min(most, 0.5 * memory_limit(0.0) / (kBytesPerTriangle * triangles + map_bytes));
  if (mesh.device.has_gpu())
    most = std::min(most, static_cast<double>(probe_device().memory_bytes) / kBytesOnGpu);
  return std::max(1, static_cast<int>(most));
}

// The first member, the last and some between.
std::vector<std::uint64_t> sampled_members(const MemberRange& range, std::uint64_t fewest) {
  constexpr std::uint64_t kMembersForOne = 20, kMost = 8;
  const std::uint64_t all = range.end - range.begin;
  const std::uint64_t count = std::min(all, std::clamp(all / kMembersForOne, fewest, kMost));
  std::vector<std::uint64_t> numbers{range.begin};
  for (std::uint64_t i = 1; i < count; ++i) numbers.push_back(range.begin + (all - 1) * i / (count - 1));
  return numbers;
}

// The meshes of some members that are there. Throws InputError for files that cannot be read back, or would
// take longer to compare than to make.
std::vector<TriangleMesh> some_meshes(const fs::path& pattern, const MemberRange& range) {
  constexpr std::uint64_t kFewest = 4;
  constexpr std::uintmax_t kLargestCompared = 32 << 20;  // a .ply of a million triangles and more
  std::vector<TriangleMesh> meshes;
  for (const std::uint64_t number : sampled_members(range, kFewest)) {
    const fs::path file = numbered(pattern, number);
    if (!fs::is_regular_file(file)) continue;
    if (fs::file_size(file) > kLargestCompared) throw InputError("files of more than 32 MB");
    meshes.push_back(read_mesh(file));
  }
  return meshes;
}

// Says how much some members differ, or why it does not. The set is made by then, whatever happens here.
void say_differences(Job& job, const MeshJob& mesh, const MemberRange& range) {
  const auto& [spec, sinks, device, max_memory_gb, only_predict] = mesh;
  if (sinks.file.empty() || spec.points || !spec.tile.empty() || !spec.patch.empty()) return;
  try {
    if (!has_readable_extension(sinks.file)) return;
    const Json figures = member_differences(some_meshes(sinks.file, range), job.progress("differences"));
    if (figures.is_null()) return;
    job.summary["members"]["differences"] = figures;
    job.say(describe_differences(figures));
  } catch (const std::exception& e) {
    if (!job.stopped()) job.say(fmt::format("note: how much members differ is not known: {}", e.what()));
  }
}

// Makes the folder of the summary, and throws InputError where the summary cannot be written.
void prepare_summary(const Job& job) {
  const OptionRow* const row = job.options.find("--summary");
  if (row == nullptr || row->words.empty()) return;
  const fs::path file = row->words.front();
  if (file.has_parent_path()) make_output_folder(file.parent_path());
  require_writable(file);
}

}  // namespace

void declare_members_options(Job& job, MembersRequest& request) {
  Option members =
      job.options
          .add_option(
              "--members", request.range,
              "make bodies A to B - 1 of the recipe instead, each with files of its own: {member} in "
              "their names stands for its number. They are members of the recipe's family, or draws of its "
              "population by --seed and their numbers, or else have their numbers as seeds; with --vary they "
              "are the variations of these numbers, of the family's "
              "members where there is one. Says how much they differ. Member 4711 is the same body on every "
              "machine")
          .placeholder("A:B")
          .makes_folders();
  job.options.add_option("--out", request.folder, "with --members: short for -o DIR/{member}.ply")
      .needs(members)
      .excludes(job.options.option("--output"))
      .placeholder("DIR")
      .writes([](const auto& words) { return std::vector{fs::path(words.front()) / "{member}.ply"}; });
  job.options
      .add_option("--manifest", request.manifest,
                  "with --members: a file that gets a line of JSON for each finished member. Members that it "
                  "has, and whose files are whole, are not made again")
      .needs(members)
      .placeholder("FILE.jsonl")
      .writes();
}

void check_members(const MembersRequest& request, MeshJob mesh) {
  const bool many = !request.range.empty();
  if (many) parse_range(request.range);
  for (const auto& [option, file] : list_files(mesh.sinks)) {
    if (file->empty()) continue;
    if (many && !has_mark(*file))
      throw InputError(
          std::string(option) +
          ": every member writes a file of its own; put {member} into the name, as in body_{member}" +
          file->extension().string());
    if (!many && has_mark(*file))
      throw InputError(
          file->string() +
          ": {member} stands for the number of each body of --members A:B; add --members, or leave "
          "{member} out");
  }
  const MeshSinks& sinks = mesh.sinks;
  const bool pictures =
      !sinks.preview.file.empty() || !sinks.preview.maps.empty() || !sinks.landforms.empty();
  if (many && sinks.file.empty() && !sinks.recipe.empty() && pictures)
    throw InputError(
        "--write-recipe without -o keeps recipes alone; leave out --preview, --preview-maps and "
        "--feature-list, "
        "or add -o");
}

void check_sheet(const MembersRequest& request, const fs::path& sheet) {
  if (has_mark(sheet)) throw InputError("--sheet: is one for all members; leave {member} out of its name");
  if (request.range.empty()) return;
  const MemberRange range = parse_range(request.range);
  if (range.end - range.begin > kMostOnSheet)
    throw InputError(
        fmt::format("--sheet: shows {} members at most; ask for fewer, or leave it out", kMostOnSheet));
}

void make_members(Job& job, const MembersRequest& request, const MeshJob& mesh, const MemberSource& source) {
  const MemberRange range = parse_range(request.range);
  const std::string set = request.manifest.empty() ? "members" : request.manifest.string();
  if (mesh.sinks.wanted()) check_mesh(mesh, source.recipe, source.file);
  if (request.manifest.has_parent_path()) make_output_folder(request.manifest.parent_path());
  const MemberMaker maker(job, request, mesh, source);
  maker.require_same_set();
  // Folders are made, and what cannot be written is refused, before any work.
  maker.make_folders(range.begin);
  const MeshJob first = numbered(mesh, range.begin);
  check_mesh_outputs(job, first);
  prepare_summary(job);
  if (const int unreadable = maker.manifest().unreadable_lines(); unreadable > 0) {
    job.say(fmt::format("note: {}: {} cut short or of another kind; such members are made again", set,
                        counted(static_cast<std::size_t>(unreadable), "line")));
  }
  const Tally tally = make_range(job, maker, range, members_at_once(mesh, range.end - range.begin));
  for (const fs::path& name : list_names(first.sinks)) sync_file_system(fs::absolute(name).parent_path());
  if (!request.manifest.empty()) sync_file_system(request.manifest);
  job.summary["members"] = {{"made", tally.made}, {"already_there", tally.there}, {"failed", tally.failed}};
  job.say(fmt::format("{}: {} made, {} already there, {} failed, of {}{}", set, tally.made, tally.there,
                      tally.failed, range.end - range.begin,
                      job.stopped() ? "; stopped, the same command goes on" : ""));
  if (!job.stopped() && tally.failed == 0) say_differences(job, mesh, range);
}

void predict_members(Job& job, const MembersRequest& request, const MeshJob& asked,
                     const MemberSource& source) {
  MeshJob mesh = asked;
  check_mesh(mesh, source.recipe, source.file);
  if (mesh.sinks.file.empty() && mesh.sinks.recipe.empty()) mesh.sinks.file = "{member}.ply";
  if (!mesh.sinks.file.empty()) check_mesh_name(mesh, mesh.sinks.file);
  prepare_summary(job);
  const MemberRange range = parse_range(request.range);
  const std::vector<std::uint64_t> numbers = sampled_members(range, 2);
  const std::uint64_t members = range.end - range.begin;
  const double share = static_cast<double>(members) / static_cast<double>(numbers.size());
  const int at_once = members_at_once(mesh, members);
  const double start = job.seconds();
  double triangles = 0.0, file_bytes = 0.0, peak = 0.0, seconds = 0.0, processor = 0.0;
  for (const std::uint64_t number : numbers) {
    const double on_clock = job.seconds(), processor_before = job.processor_seconds(),
                 held = static_cast<double>(resident_bytes());
    JobPart part(job);
    const Recipe member = source.draw(part, number).recipe;
    if (!mesh.sinks.recipe.empty()) file_bytes += share * static_cast<double>(recipe_to_json(member).size());
    if (mesh.sinks.file.empty()) continue;
    make_mesh(part, mesh, member, source.file);
    const Json& figures = part.summary["predicted"];
    triangles += share * figures["triangles"].get<double>();
    file_bytes += share * figures["file_bytes"].get<double>();
    peak = std::max(peak, held + at_once * (figures["peak_bytes"].get<double>() - held));
    const double member_seconds = figures["processor_seconds"].get<double>() - processor_before;
    processor += share * member_seconds;
    seconds +=
        share * (at_once > 1 ? member_seconds / at_once
                             : figures["seconds"].get<double>() - std::min(on_clock, processor_before));
  }
  job.summary["predicted"] = {{"triangles", triangles},
                              {"file_bytes", file_bytes},
                              {"peak_bytes", peak},
                              {"seconds", seconds},
                              {"processor_seconds", processor},
                              {"members", members},
                              {"sampled_members", numbers},
                              {"own_seconds", job.seconds() - start}};
  if (job.quiet) return;
  job.print_result(
      fmt::format("{} members: about {} triangles, {} of files, {} memory, {}; from {} of them\n", members,
                  rounded_count(triangles), byte_words(file_bytes), byte_words(peak),
                  seconds_words(seconds, processor), numbers.size()));
}

}  // namespace astrolith
