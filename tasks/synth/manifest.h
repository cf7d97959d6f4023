// The manifest of a set of bodies: a file of lines, one JSON object for each finished member.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace astrolith {

struct ManifestFile {
  std::string name;  // relative to the manifest's folder
  std::uint64_t bytes = 0;
  std::string sha256;

  bool operator==(const ManifestFile&) const = default;
};

struct ManifestEntry {
  std::string family;   // the SHA-256 of what all members have in common
  std::string version;  // of the program that made it
  std::vector<ManifestFile> files;
};

class Manifest {
 public:
  // Reads the file, which need not exist. Of several lines about one member the last counts. A line that is
  // no such object, as a process that died leaves it, counts as none. Throws InputError for a file that
  // cannot be read, has more than 256 MB or is no manifest.
  explicit Manifest(std::filesystem::path file);

  int unreadable_lines() const { return unreadable_lines_; }

  // Whether the member has been finished for this family with files of these names (as given to
  // describe_file) and perhaps others, which all are there still, byte for byte.
  bool has(std::uint64_t member, const std::string& family,
           const std::vector<std::filesystem::path>& files) const;

  // Whether a member stands in it that another recipe or other options made.
  bool has_other_family(const std::string& family) const;

  // Name, size and hash of a file that is there. Throws InputError when it cannot be read.
  ManifestFile describe_file(const std::filesystem::path& file) const;

  // The version of a program that made members of it and that is not this one; empty where there is none.
  std::string other_version(const std::string& version) const;

  // Appends the line of a finished member: `line` has "member", "family", "files" and what else is to be
  // kept. Throws as append_line() does.
  void append(const nlohmann::ordered_json& line) const;

 private:
  std::string relative_name(const std::filesystem::path& file) const;
  void read();
  bool read_line(const std::string& line);

  std::filesystem::path file_;
  std::map<std::uint64_t, ManifestEntry> entries_;
  int unreadable_lines_ = 0;
};

// The files as a manifest's line states them.
nlohmann::ordered_json to_json(const std::vector<ManifestFile>& files);

}  // namespace astrolith
