#include "tasks/synth/manifest.h"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "numerics/errors.h"
#include "numerics/files/input_file.h"
#include "numerics/files/output_file.h"
#include "numerics/files/relative_path.h"
#include "numerics/files/sha256.h"

namespace astrolith {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::string_view kLineBegin = R"({"member":)";
constexpr std::uintmax_t kMostBytes = std::uintmax_t{1} << 28;

bool is_entry(const json& line) {
  return line.is_object() && line.contains("member") && line["member"].is_number_unsigned() &&
         line.contains("family") && line["family"].is_string() && line.contains("version") &&
         line["version"].is_string() && line.contains("files") && line["files"].is_array();
}

bool is_file(const json& file) {
  return file.is_object() && file.contains("name") && file["name"].is_string() && file.contains("bytes") &&
         file["bytes"].is_number_unsigned() && file.contains("sha256") && file["sha256"].is_string();
}

}  // namespace

Manifest::Manifest(fs::path file) : file_(std::move(file)) {
  std::error_code error;
  if (fs::exists(file_, error) && !fs::is_regular_file(file_, error)) {
    throw InputError("manifest: " + file_.string() +
                     " is a folder, a device or a pipe; give the name of a file");
  }
  if (fs::exists(file_, error) && fs::file_size(file_, error) > 0) read();
}

void Manifest::read() {
  require_plain_file(file_);
  if (fs::file_size(file_) > kMostBytes) {
    throw InputError(file_.string() + ": is larger than 256 MB; make the members in ranges, a manifest each");
  }
  std::ifstream stream(file_);
  if (!stream) throw InputError(file_.string() + ": cannot be read; check its permissions");
  for (std::string line; std::getline(stream, line);) {
    if (read_line(line)) continue;
    ++unreadable_lines_;
    // A process that died leaves the beginning of a line. Any other file is somebody's, and must not grow.
    if (entries_.empty() && !line.starts_with(kLineBegin.substr(0, line.size()))) {
      throw InputError(file_.string() + ": is there, and is no manifest; name another file");
    }
  }
}

bool Manifest::read_line(const std::string& line) {
  const json object = json::parse(line, nullptr, false);
  if (!is_entry(object)) return false;
  ManifestEntry entry{object["family"].get<std::string>(), object["version"].get<std::string>(), {}};
  for (const json& file : object["files"]) {
    if (!is_file(file)) return false;
    entry.files.push_back({file["name"].get<std::string>(), file["bytes"].get<std::uint64_t>(),
                           file["sha256"].get<std::string>()});
  }
  entries_[object["member"].get<std::uint64_t>()] = std::move(entry);
  return true;
}

std::string Manifest::relative_name(const fs::path& file) const { return relative_to(file_, file); }

ManifestFile Manifest::describe_file(const fs::path& file) const {
  return {relative_name(file), fs::file_size(file), file_sha256(file)};
}

bool Manifest::has(std::uint64_t member, const std::string& family,
                   const std::vector<fs::path>& files) const {
  const auto found = entries_.find(member);
  if (found == entries_.end() || found->second.family != family) return false;
  const std::vector<ManifestFile>& stated = found->second.files;
  const auto is_stated = [&](const fs::path& file) {
    return std::ranges::find(stated, relative_name(file), &ManifestFile::name) != stated.end();
  };
  const fs::path folder = file_.parent_path();
  const auto has_size = [&](const ManifestFile& s) {
    std::error_code error;
    return fs::is_regular_file(folder / s.name, error) && fs::file_size(folder / s.name, error) == s.bytes;
  };
  const auto is_whole = [&](const ManifestFile& s) { return s.sha256 == file_sha256(folder / s.name); };
  // Names and sizes first: they cost nothing.
  return std::ranges::all_of(files, is_stated) && std::ranges::all_of(stated, has_size) &&
         std::ranges::all_of(stated, is_whole);
}

bool Manifest::has_other_family(const std::string& family) const {
  return std::any_of(entries_.begin(), entries_.end(),
                     [&](const auto& entry) { return entry.second.family != family; });
}

std::string Manifest::other_version(const std::string& version) const {
  const auto other = std::find_if(entries_.begin(), entries_.end(),
                                  [&](const auto& entry) { return entry.second.version != version; });
  return other == entries_.end() ? "" : other->second.version;
}

void Manifest::append(const nlohmann::ordered_json& line) const {
  append_line(file_, line.dump(-1, ' ', false, json::error_handler_t::replace));
}

nlohmann::ordered_json to_json(const std::vector<ManifestFile>& files) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const ManifestFile& file : files) {
    list.push_back({{"name", file.name}, {"bytes", file.bytes}, {"sha256", file.sha256}});
  }
  return list;
}

}  // namespace astrolith
