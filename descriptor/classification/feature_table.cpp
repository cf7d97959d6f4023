#include "descriptor/classification/feature_table.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "geometry/io/mesh_io.h"
#include "numerics/errors.h"
#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

namespace fs = std::filesystem;

bool hidden(const fs::path& path) { return path.filename().string().starts_with('.'); }

std::vector<fs::path> list_entries(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    throw InputError(folder.string() + ": is no folder; give a folder of meshes");
  }
  std::vector<fs::path> entries;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (!hidden(it->path())) entries.push_back(it->path());
  }
  if (error)
    throw InputError(folder.string() + ": cannot be read (" + error.message() + "); check its rights");
  std::sort(entries.begin(), entries.end());
  return entries;
}

// The last part of the name of a folder, also for "classes/bird/" and ".".
std::string folder_name(const fs::path& folder) {
  fs::path full = fs::absolute(folder).lexically_normal();
  if (!full.has_filename()) full = full.parent_path();
  return full.filename().string();
}

std::vector<fs::path> folders_in(const fs::path& folder) {
  std::vector<fs::path> folders = list_entries(folder);
  std::error_code unused;  // an entry without a status counts as no folder
  std::erase_if(folders, [&](const fs::path& p) { return !fs::is_directory(p, unused); });
  return folders;
}

// The message with the name of the file in front. Messages of readers begin with it already; those of
// descriptors do not.
std::string naming(const std::filesystem::path& file, const std::string& message) {
  const std::string name = file.string();
  return message.starts_with(name) ? message : name + ": " + message;
}

// Moves the lines that are not empty, in their order.
void keep_filled(std::vector<std::string>& lines, std::vector<std::string>& kept) {
  for (std::string& line : lines) {
    if (!line.empty()) kept.push_back(std::move(line));
  }
}

}  // namespace

std::vector<fs::path> meshes_in(const fs::path& folder) {
  std::vector<fs::path> meshes = list_entries(folder);
  std::error_code unused;
  std::erase_if(meshes,
                [&](const fs::path& p) { return fs::is_directory(p, unused) || !has_readable_extension(p); });
  return meshes;
}

std::vector<fs::path> others_in(const fs::path& folder) {
  std::vector<fs::path> others = list_entries(folder);
  std::error_code unused;
  std::erase_if(others,
                [&](const fs::path& p) { return fs::is_directory(p, unused) || has_readable_extension(p); });
  return others;
}

LabelledFiles find_classes(std::span<const fs::path> folders) {
  std::map<std::string, std::vector<fs::path>> classes;
  std::vector<fs::path> skipped;
  const auto add = [&](const fs::path& folder) {
    const std::vector<fs::path> meshes = meshes_in(folder);
    if (meshes.empty()) {
      throw InputError(folder.string() + ": holds no meshes; give a folder of meshes for each class");
    }
    auto& files = classes[folder_name(folder)];
    files.insert(files.end(), meshes.begin(), meshes.end());
    const std::vector<fs::path> others = others_in(folder);
    skipped.insert(skipped.end(), others.begin(), others.end());
  };
  for (const fs::path& folder : folders) {
    const std::vector<fs::path> inner = folders_in(folder);
    if (inner.empty()) {
      add(folder);
    } else if (!meshes_in(folder).empty()) {
      throw InputError(folder.string() +
                       ": holds meshes beside folders; give a class of meshes a folder of its own");
    } else {
      for (const fs::path& one : inner) add(one);
    }
  }
  LabelledFiles result;
  result.skipped = std::move(skipped);
  for (const auto& [name, files] : classes) {
    result.labels.insert(result.labels.end(), files.size(), static_cast<int>(result.classes.size()));
    result.files.insert(result.files.end(), files.begin(), files.end());
    result.classes.push_back(name);
  }
  return result;
}

FeatureTable read_features(std::span<const std::filesystem::path> files, const FeatureOptions& options,
                           const ShapeReader& read, const Progress& progress) {
  check(options);
  FeatureTable table{FeatureRows(files.size()), {}, {}};
  std::vector<std::string> failures(files.size()), remarks(files.size());
  std::mutex reporting;
  std::size_t done = 0;
  bool stopped = false;
  const auto go_on = [&](const std::filesystem::path& file, std::size_t newly_done) {
    const std::lock_guard lock(reporting);
    done += newly_done;
    const double fraction = static_cast<double>(done) / static_cast<double>(files.size());
    stopped = stopped || !report(progress, fraction, file.filename().string());
    return !stopped;
  };
  parallel_for(0, static_cast<std::int64_t>(files.size()), [&](std::int64_t index) {
    const auto i = static_cast<std::size_t>(index);
    // A large file asks within its own work too, so that a stop need not wait for it.
    const Progress within = [&](double, std::string_view) { return go_on(files[i], 0); };
    if (!within(0, "")) return;
    try {
      table.rows[i] = shape_features(read(files[i], remarks[i]), options, within);
    } catch (const std::runtime_error& e) {  // InputError, WorkError
      const std::lock_guard lock(reporting);
      if (stopped) return;
      failures[i] = naming(files[i], e.what());
    }
    go_on(files[i], 1);
  });
  if (stopped && done < files.size()) throw WorkError("features: stopped; run it again");
  keep_filled(failures, table.failures);
  keep_filled(remarks, table.remarks);
  return table;
}

LabelledFeatures labelled(const LabelledFiles& files, const FeatureTable& table) {
  LabelledFeatures data{files.classes, {}, {}};
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    if (table.rows[i].empty()) continue;
    data.rows.push_back(table.rows[i]);
    data.labels.push_back(files.labels[i]);
  }
  return data;
}

}  // namespace astrolith
