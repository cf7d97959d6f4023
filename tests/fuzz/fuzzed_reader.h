// What every fuzzer does with its reader: nothing but InputError may leave it, and what it allocates is
// bounded by the size of the file.
#pragma once

#include <fcntl.h>
#include <sanitizer/allocator_interface.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "numerics/errors.h"

namespace astrolith::fuzz {

// Bytes that are allocated now, and the most there were since the last reset.
struct AllocatedBytes {
  std::atomic<std::int64_t> now = 0, most = 0;
};
inline AllocatedBytes allocated;

inline void count_allocation(const volatile void*, std::size_t bytes) {
  const std::int64_t now = allocated.now += static_cast<std::int64_t>(bytes);
  if (now > allocated.most) allocated.most = now;
}
inline void count_release(const volatile void* block) {
  if (block != nullptr) {
    allocated.now -=
        static_cast<std::int64_t>(__sanitizer_get_allocated_size(const_cast<const void*>(block)));
  }
}

// The bytes of memory that a reader may take for a file: a fixed part and a multiple of the file's size.
struct MemoryBound {
  std::int64_t fixed;
  std::int64_t each_byte;
};

// Whether a text is one line. (Programs escape what else a terminal would not show.)
inline bool is_one_line(const std::string& text) {
  for (const char c : text) {
    if (static_cast<unsigned char>(c) < ' ') return false;
  }
  return true;
}

// Runs `read` and ends the program, so that the fuzzer keeps the file, where another exception than
// InputError leaves it, a message has more than one line, or the memory was above the bound.
template <typename Read>
void run_reader(std::size_t file_bytes, MemoryBound bound, Read&& read) {
  static const bool counted = __sanitizer_install_malloc_and_free_hooks(count_allocation, count_release) != 0;
  if (!counted) std::abort();
  const std::int64_t before = allocated.now;
  allocated.most = before;
  try {
    read();
  } catch (const InputError& error) {
    if (!is_one_line(error.what())) std::abort();
  }
  const std::int64_t taken = allocated.most - before;
  const std::int64_t allowed = bound.fixed + bound.each_byte * static_cast<std::int64_t>(file_bytes);
  if (taken <= allowed) return;
  std::fprintf(stderr, "a file of %zu bytes took %lld bytes, where %lld are allowed\n", file_bytes,
               static_cast<long long>(taken), static_cast<long long>(allowed));
  std::abort();
}

// A file in memory, for readers that take a path.
class FileInMemory {
 public:
  FileInMemory(const std::uint8_t* data, std::size_t size) : descriptor_(memfd_create("fuzzed", 0)) {
    if (descriptor_ < 0 || write(descriptor_, data, size) != static_cast<ssize_t>(size)) std::abort();
  }
  ~FileInMemory() { close(descriptor_); }
  FileInMemory(const FileInMemory&) = delete;
  FileInMemory& operator=(const FileInMemory&) = delete;

  std::filesystem::path path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

}  // namespace astrolith::fuzz
