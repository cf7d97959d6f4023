// Memory of this process and of the machine.
#pragma once

#include <sys/resource.h>
#include <unistd.h>

#include <cstdint>
#include <fstream>
#include <string>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace astrolith {

// The most memory that this process has held so far, bytes. The system's getrusage() would also count what
// the process held before it became this program, which is the memory of the program that started it.
inline std::uint64_t peak_bytes() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    std::uint64_t kilobytes = 0;
    if (word == "VmHWM:" && status >> kilobytes) return kilobytes * 1024;
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // Linux counts in kilobytes
}

// The memory that this process holds now, bytes; 0 where the system does not say.
inline std::uint64_t resident_bytes() {
  std::uint64_t all = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> all >> resident;
  return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGE_SIZE));
}

// The memory that this process has mapped for writing, bytes; 0 where the system does not say.
inline std::uint64_t mapped_bytes() {
  std::uint64_t pages = 0;
  std::ifstream statm("/proc/self/statm");
  for (int field = 0; field < 6; ++field) statm >> pages;  // the sixth is data and stack
  return pages * static_cast<std::uint64_t>(sysconf(_SC_PAGE_SIZE));
}

// Arrays of at least as many bytes go back to the system when they are freed, after return_freed_memory().
inline constexpr int kReturnedBytes = 1 << 20;

// From now on large arrays go back to the system when they are freed. Otherwise the C library keeps the more
// of them the larger the arrays are, and the peak of a mesh is up to a third above what the mesh ever holds.
inline void return_freed_memory() {
#if defined(__GLIBC__)
  mallopt(M_MMAP_THRESHOLD, kReturnedBytes);
  mallopt(M_TRIM_THRESHOLD, kReturnedBytes);
#endif
}

// Gives memory that was freed so far back to the system, as far as the C library can.
inline void give_back_freed_memory() {
#if defined(__GLIBC__)
  malloc_trim(0);
#endif
}

// A sanitizer keeps memory of its own beside the program's, and ends a program whose allocation fails.
#ifdef ASTROLITH_SANITIZED
inline constexpr bool kMemoryIsTheProgramsOwn = false;
#else
inline constexpr bool kMemoryIsTheProgramsOwn = true;
#endif

// While it lives, this process cannot grow beyond `bytes` of memory: an allocation that would take it there
// throws std::bad_alloc. Expects that the threads of the work exist. Does nothing under a sanitizer.
class MemoryGuard {
 public:
  explicit MemoryGuard(double bytes) {
    if (getrlimit(RLIMIT_DATA, &before_) != 0 || !kMemoryIsTheProgramsOwn) return;
    // The limit counts memory that is mapped for writing, whether it is used or not. What is mapped and not
    // yet used may still become so: stacks of threads, free parts of heaps, and pages of the program itself.
    constexpr double kStillToBeUsed = 4e6;
    const double room = bytes - static_cast<double>(resident_bytes()) - kStillToBeUsed;
    const double allowed = static_cast<double>(mapped_bytes()) + (room > 0.0 ? room : 0.0);
    rlimit limit = before_;
    if (allowed < static_cast<double>(limit.rlim_max)) limit.rlim_cur = static_cast<rlim_t>(allowed);
    setrlimit(RLIMIT_DATA, &limit);
  }
  MemoryGuard(const MemoryGuard&) = delete;
  MemoryGuard& operator=(const MemoryGuard&) = delete;
  ~MemoryGuard() { setrlimit(RLIMIT_DATA, &before_); }

 private:
  rlimit before_{RLIM_INFINITY, RLIM_INFINITY};
};

}  // namespace astrolith
