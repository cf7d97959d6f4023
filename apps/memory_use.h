// Memory of this process and of the machine.
#pragma once

#include <sys/resource.h>
#include <unistd.h>

#include <cstdint>

namespace astrolith {

// The most memory that this process has held so far, bytes.
inline std::uint64_t peak_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // Linux counts in kilobytes
}

// The memory that --max-memory allows, bytes. 0 gigabytes stands for three quarters of the machine's memory.
inline double memory_limit(double gigabytes) {
  if (gigabytes > 0.0) return 1e9 * gigabytes;
  return 0.75 * static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
}

}  // namespace astrolith
