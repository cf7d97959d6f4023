#include "descriptor/classification/feature_table.h"

#include <mutex>
#include <stdexcept>
#include <string_view>

#include "numerics/errors.h"
#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

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

FeatureTable features_of_files(std::span<const std::filesystem::path> files, const FeatureOptions& options,
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
