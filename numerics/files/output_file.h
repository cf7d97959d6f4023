// Files that are whole or absent: each is written without a name and gets its name at the end.
// Several processes may extend a file of lines, such as the manifest of a set of bodies.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "numerics/errors.h"

namespace astrolith {

// Appends the line, which has no line break in it, and one line break. Processes that append to one file take
// turns. A last line that was cut short by a process that died is ended first, so that it stands alone. A
// line that cannot be written whole is taken back. Throws InputError where the file cannot be opened, and
// WorkError when the disk is full.
void append_line(const std::filesystem::path& file, std::string_view line);

// Names of the temporary files that exist now, so that a signal handler can remove them. At most 64 are
// recorded; further ones are not removed by the handler.
std::array<std::atomic<const char*>, 64>& temporary_files();

// Removes the recorded temporary files. It may be called in a signal handler that ends the program.
void remove_temporary_files();

// The name of a temporary file. The file is removed with this object, or by remove_temporary_files().
class TemporaryName {
 public:
  // Chooses a random name in the folder of `target`.
  explicit TemporaryName(const std::filesystem::path& target);
  TemporaryName(const TemporaryName&) = delete;
  TemporaryName& operator=(const TemporaryName&) = delete;
  ~TemporaryName();

  const char* c_str() const { return name_.c_str(); }

 private:
  std::string name_;
  std::atomic<const char*>* known_as_ = nullptr;
};

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using FileHandle = std::unique_ptr<std::FILE, CloseFile>;

// Opens a file without a name in the folder of `target`, to be written and read back. It is gone when it is
// closed or when the process ends, however it ends. Null, with errno set, where the folder cannot be written.
FileHandle open_nameless_file(const std::filesystem::path& target);

//   OutputFile file("rock.json");
//   file.write(text.data(), text.size());
//   file.commit();                      // without this call nothing is left behind
//
// The file has no name until commit(), so that a killed program leaves nothing (O_TMPFILE). There are two
// exceptions. Where the file system knows no such files, the file has a temporary name beside its target from
// the start. Where the target exists, the whole file has a temporary name for the moment between two system
// calls, because Linux can replace a name only by another name.
//
// This holds through a power cut, too: commit() waits until the disk has the content before it gives the
// name, and then until the disk has the name. UnsyncedOutputs leaves that out.
//
// As with programs that write in place, a target that is a link is written through, and one that exists keeps
// its mode.
//
// A target whose name ends in .zst is compressed by commit() (numerics/files/zstd_stream.h).
class OutputFile {
 public:
  // kNameless becomes kNamed where the file system knows no nameless files.
  enum class Start { kNameless, kNamed };

  // Throws InputError when the folder does not exist or cannot be written, or when the target exists and is
  // read-only or no regular file.
  explicit OutputFile(const std::filesystem::path& target, Start start = Start::kNameless);

  // Appends bytes. Throws WorkError when the disk is full.
  void write(const void* data, std::size_t bytes);
  // Appends the first `bytes` of a file that this process has open. Throws WorkError when the disk is full.
  void append_file(int descriptor, std::uint64_t bytes);
  // Moves to `offset` bytes from the start, for formats whose header states counts that are known only at the
  // end.
  void seek(std::int64_t offset);
  // A new descriptor of this file, for a library that writes through a descriptor and closes it. Throws
  // WorkError when there is none left.
  int duplicate_descriptor();

  // Gives the file its name. Throws WorkError when the disk is full, or fails to keep the file.
  void commit();

 private:
  [[noreturn]] void fail() const;
  void compress();  // the file's content becomes its Zstandard form
  // These return false, with errno set, where they fail.
  bool name_it(int descriptor);
  bool replace_target(const std::string& nameless);

  std::filesystem::path target_;  // no link
  bool packed_;
  std::unique_ptr<TemporaryName> temporary_;  // null while the file has no name
  FileHandle file_;
};

// Writes the file as an OutputFile, whole or not at all, and throws as one.
void write_file(const std::filesystem::path& target, std::string_view content);

// While an object of this class lives, or where the environment has ASTROLITH_NO_SYNC, no commit() of the
// process waits for the disk. It is meant for sets of thousands of small files, whose maker can tell a file
// that a power cut damaged. Such a maker calls sync_file_system() at its end.
class UnsyncedOutputs {
 public:
  UnsyncedOutputs();
  UnsyncedOutputs(const UnsyncedOutputs&) = delete;
  UnsyncedOutputs& operator=(const UnsyncedOutputs&) = delete;
  ~UnsyncedOutputs();
};

// Waits until the disk has all files of the file system that holds this one, unless the environment has
// ASTROLITH_NO_SYNC. A file that does not exist is no reason to wait. Throws WorkError when the disk fails.
void sync_file_system(const std::filesystem::path& file);

// Throws InputError when the file cannot be written. Programs call it before long work.
void require_writable(const std::filesystem::path& target);

// Throws InputError when the folder neither exists nor could be made now. Programs call it before long work.
void require_folder_can_be_made(const std::filesystem::path& folder);

// Throws InputError when writing the output would destroy the input.
void require_other_file(const std::filesystem::path& output, const std::filesystem::path& input);

// Throws InputError when two outputs have one name.
void require_two_files(const std::filesystem::path& output, const std::filesystem::path& other);

// Makes the folder for an output of several files. Throws InputError when it does not exist and cannot be
// made.
void make_output_folder(const std::filesystem::path& folder);

}  // namespace astrolith
