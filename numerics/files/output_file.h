// Files that are whole or absent: each is written under a temporary name beside its target and then renamed.
#pragma once

#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string>
#include <system_error>

#include "numerics/errors.h"

namespace astrolith {

// Names of the temporary files that exist now, so that a signal handler can remove them. At most 64 are
// recorded; further ones are not removed by the handler.
inline std::array<std::atomic<const char*>, 64>& temporary_files() {
  static std::array<std::atomic<const char*>, 64> names{};
  return names;
}

// Removes the recorded temporary files. It may be called in a signal handler that ends the program.
inline void remove_temporary_files() {
  for (const std::atomic<const char*>& name : temporary_files()) {
    if (const char* file = name.load()) ::unlink(file);
  }
}

//   OutputFile file("rock.json");
//   file.write(text.data(), text.size());
//   file.commit();                      // without this the destructor leaves nothing behind
class OutputFile {
 public:
  // Throws InputError when the folder does not exist or cannot be written, or when the target exists and is
  // no regular file.
  explicit OutputFile(const std::filesystem::path& target)
      : target_(target), temporary_(target.string() + ".tmp" + std::to_string(::getpid())) {
    std::error_code unused;  // a file without a status cannot be opened either, which is reported below
    const std::filesystem::file_status status = std::filesystem::status(target_, unused);
    if (std::filesystem::is_directory(status)) {
      throw InputError(target_.string() + ": is a folder; give the name of a file");
    }
    // Renaming would replace the device itself by a file.
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
      throw InputError(target_.string() + ": is a device or pipe; give the name of a file");
    }
    file_ = std::fopen(temporary_.c_str(), "wb");
    if (file_ == nullptr) {
      throw InputError(target_.string() + ": cannot write (" + std::strerror(errno) +
                       "); choose a folder that exists and is writable");
    }
    for (std::atomic<const char*>& name : temporary_files()) {
      const char* nobody = nullptr;
      if (name.compare_exchange_strong(nobody, temporary_.c_str())) {
        known_as_ = &name;
        break;
      }
    }
  }
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile() {
    if (file_ != nullptr) std::fclose(file_);
    if (!committed_) std::remove(temporary_.c_str());
    forget();
  }

  // Appends bytes. Throws WorkError when the disk is full.
  void write(const void* data, std::size_t bytes) {
    if (bytes != 0 && std::fwrite(data, 1, bytes, file_) != bytes) fail();
  }
  // Moves to `offset` bytes from the start, for formats whose header states counts that are known only at the
  // end.
  void seek(std::int64_t offset) {
    if (fseeko(file_, offset, SEEK_SET) != 0) fail();
  }
  // The name that a library which opens the file itself writes to; commit() then renames it.
  const std::string& temporary_name() const { return temporary_; }

  // Gives the file its name. Throws WorkError when the disk is full.
  void commit() {
    const bool flushed = std::fflush(file_) == 0;
    const bool closed = std::fclose(file_) == 0;
    file_ = nullptr;
    if (!flushed || !closed || std::rename(temporary_.c_str(), target_.c_str()) != 0) fail();
    committed_ = true;
    forget();
  }

 private:
  void forget() {
    if (known_as_ != nullptr) known_as_->store(nullptr);
    known_as_ = nullptr;
  }
  [[noreturn]] void fail() {
    throw WorkError(target_.string() + ": writing failed (" + std::strerror(errno) + "); is the disk full?");
  }

  std::filesystem::path target_;
  std::string temporary_;
  std::FILE* file_ = nullptr;
  bool committed_ = false;
  std::atomic<const char*>* known_as_ = nullptr;
};

// Throws InputError when the file cannot be written. Programs call it before long work.
inline void require_writable(const std::filesystem::path& target) { const OutputFile probe(target); }

// Throws InputError when writing the output would destroy the input.
inline void require_other_file(const std::filesystem::path& output, const std::filesystem::path& input) {
  std::error_code none;  // files that do not exist are not the same
  if (std::filesystem::equivalent(output, input, none)) {
    throw InputError(output.string() + ": is the input itself; give the output another name");
  }
}

// Throws InputError when two outputs have one name.
inline void require_two_files(const std::filesystem::path& output, const std::filesystem::path& other) {
  const auto place = [](const std::filesystem::path& file) {
    return std::filesystem::absolute(file).lexically_normal();
  };
  if (place(output) == place(other)) {
    throw InputError(output.string() + ": is the name of two outputs; give each its own");
  }
  require_other_file(output, other);
}

// Makes the folder for an output of several files. Throws InputError when it does not exist and cannot be
// made.
inline void make_output_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder)) {
    throw InputError(folder.string() + ": cannot make this folder; choose a place that is writable");
  }
}

}  // namespace astrolith
