// What the control groups of Linux (cgroups 1 and 2) leave to this process: a container, a job of a cluster
// or a service often has less than the machine.
#pragma once

#include <filesystem>
#include <limits>

namespace astrolith {

struct GroupLimits {
  // The memory that the group may still take, bytes: its limit, less what it holds and cannot drop.
  double free_bytes = std::numeric_limits<double>::infinity();
  // The quota of time in processors, such as 1.5.
  double processors = std::numeric_limits<double>::infinity();
};

// The limits of the groups that the file `membership` names and of those around them, in the file system
// `groups`. Infinite where there are none.
GroupLimits group_limits(const std::filesystem::path& membership = "/proc/self/cgroup",
                         const std::filesystem::path& groups = "/sys/fs/cgroup");

// The processors that this process may use: those of the machine, or its group's quota rounded up; at
// least 1.
int usable_processors();

// The memory that --max-memory allows, bytes. 0 gigabytes stands for three quarters of the machine's memory,
// or of what this process and others of its group may hold where that is less.
double memory_limit(double gigabytes);

}  // namespace astrolith
