#include "numerics/process_limits.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>
#include <string>
#include <thread>

#include "numerics/memory_use.h"

namespace astrolith {
namespace {

namespace fs = std::filesystem;

// The number in a file. None for "max", and where there is no such file.
std::optional<double> number_in(const fs::path& file) {
  double value = 0.0;
  if (std::ifstream(file) >> value) return value;
  return {};
}

// A value of a file of names and values.
double named_value(const fs::path& file, std::string_view name) {
  std::ifstream stream(file);
  std::string word;
  for (double value = 0.0; stream >> word >> value;) {
    if (word == name) return value;
  }
  return 0.0;
}

// How the two versions of control groups name the same things.
struct MemoryFiles {
  const char *limit, *held, *droppable;
};
constexpr MemoryFiles kMemory1{"memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file"};
constexpr MemoryFiles kMemory2{"memory.max", "memory.current", "inactive_file"};

// Group 1 states a limit near 2^63 where it has none.
double free_bytes(const fs::path& group, const MemoryFiles& files) {
  constexpr double kNone = 1e18;
  const std::optional<double> limit = number_in(group / files.limit), held = number_in(group / files.held);
  if (!limit || !held || *limit > kNone) return GroupLimits{}.free_bytes;
  return std::max(0.0, *limit - *held + named_value(group / "memory.stat", files.droppable));
}

double quota(const fs::path& group) {
  std::ifstream both(group / "cpu.max");
  double time = 0.0, period = 0.0;
  if (both >> time >> period && period > 0.0) return time / period;
  const std::optional<double> quota_1 = number_in(group / "cpu.cfs_quota_us"),
                              period_1 = number_in(group / "cpu.cfs_period_us");
  if (quota_1 && period_1 && *quota_1 > 0.0 && *period_1 > 0.0) return *quota_1 / *period_1;
  return GroupLimits{}.processors;
}

// Heeds a group and all groups around it. Inside a container the path may be that of the machine, and then
// the root of the file system is the container's own group.
void heed(const fs::path& root, const std::string& path, const MemoryFiles& files, GroupLimits& limits) {
  for (fs::path part = fs::path(path).relative_path();; part = part.parent_path()) {
    limits.free_bytes = std::min(limits.free_bytes, free_bytes(root / part, files));
    limits.processors = std::min(limits.processors, quota(root / part));
    if (part.empty()) return;
  }
}

}  // namespace

GroupLimits group_limits(const fs::path& membership, const fs::path& groups) {
  GroupLimits limits;
  std::ifstream lines(membership);
  for (std::string line; std::getline(lines, line);) {  // "0::/path", "4:memory:/path"
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == line.npos || second == line.npos) continue;
    const std::string controller = line.substr(first + 1, second - first - 1), path = line.substr(second + 1);
    heed(groups / controller, path, controller.empty() ? kMemory2 : kMemory1, limits);
  }
  return limits;
}

int usable_processors() {
  const double all = std::max(1u, std::thread::hardware_concurrency());
  return std::max(1, static_cast<int>(std::min(all, std::ceil(group_limits().processors))));
}

double memory_limit(double gigabytes) {
  if (gigabytes > 0.0) return 1e9 * gigabytes;
  const double machine =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
  return 0.75 * std::min(machine, group_limits().free_bytes + static_cast<double>(resident_bytes()));
}

}  // namespace astrolith
