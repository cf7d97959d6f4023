#include "numerics/files/output_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <random>
#include <string>
#include <system_error>
#include <vector>

#include "numerics/errors.h"
#include "numerics/files/zstd_stream.h"

namespace astrolith {
namespace {

class Descriptor {
 public:
  explicit Descriptor(const std::filesystem::path& file)
      : number_(::open(file.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666)) {
    if (number_ >= 0) return;
    throw InputError(file.string() + ": cannot be written: " + std::strerror(errno) +
                     "; name a file in a folder that exists");
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { ::close(number_); }
  int number() const { return number_; }

 private:
  int number_;
};

// The size of the file in bytes; negative where it cannot be told.
off_t file_size(int descriptor) {
  struct stat status {};
  return ::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode) ? status.st_size : -1;
}

bool ends_within_line(int descriptor, off_t size) {
  char last = '\n';
  return size > 0 && ::pread(descriptor, &last, 1, size - 1) == 1 && last != '\n';
}

bool write_all(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

namespace fs = std::filesystem;

constexpr mode_t kMode = 0666;  // less the umask

fs::path parent_folder(const fs::path& target) {
  return target.has_parent_path() ? target.parent_path() : ".";
}

// The name under which the system lists an open file.
std::string listed_name(int descriptor) { return "/proc/self/fd/" + std::to_string(descriptor); }

FileHandle open_stream(int descriptor) {
  FileHandle file(::fdopen(descriptor, "w+b"));
  if (!file) ::close(descriptor);
  return file;
}

// Null where the file system or the system knows no nameless files.
FileHandle open_linkable_file(const fs::path& target) {
#ifdef O_TMPFILE
  const int descriptor = ::open(parent_folder(target).c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, kMode);
  if (descriptor < 0) return nullptr;
  if (::access(listed_name(descriptor).c_str(), F_OK) == 0) return open_stream(descriptor);
  ::close(descriptor);
#else
  static_cast<void>(target);
#endif
  return nullptr;
}

FileHandle create(const char* name) {
  const int descriptor = ::open(name, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, kMode);
  return descriptor < 0 ? nullptr : open_stream(descriptor);
}

std::atomic<int> g_unsynced{std::getenv("ASTROLITH_NO_SYNC") != nullptr ? 1 : 0};

// False, with errno set, where the disk fails. A file system that cannot be asked is taken at its word.
bool on_disk(int synced) { return synced == 0 || errno == EINVAL || errno == ENOTSUP; }

bool sync(int descriptor) { return g_unsynced > 0 || on_disk(::fsync(descriptor)); }

// The names in a folder. A folder that may be written and not read cannot be synced.
bool sync_folder(const fs::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return true;
  const bool done = sync(descriptor);
  const int error = errno;
  ::close(descriptor);
  errno = error;
  return done;
}

// The file that a name stands for: a link is written through, and need not lead to a file yet.
fs::path through_links(fs::path target) {
  constexpr int kMostLinks = 40;  // as many as Linux follows
  std::error_code error;
  for (int i = 0; i < kMostLinks; ++i) {
    const fs::path next = fs::read_symlink(target, error);
    if (error) return target;  // no link
    target = parent_folder(target) / next;
  }
  throw InputError(target.string() + ": is a link that leads to itself; give the name of a file");
}

// Replacing a file asks no right to write it, which its owner may have taken away.
void require_not_read_only(const fs::path& target) {
  struct stat status;
  if (::stat(target.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return;
  if ((status.st_mode & 0222) != 0 && ::access(target.c_str(), W_OK) == 0) return;
  throw InputError(target.string() + ": is read-only; give another name, or allow writing (chmod u+w)");
}

// The new file has the mode of the one that it replaces, and its owner where that is allowed.
void copy_permissions(const fs::path& target, int descriptor) {
  struct stat status;
  if (::stat(target.c_str(), &status) != 0) return;
  const bool owned = ::fchown(descriptor, status.st_uid, status.st_gid) == 0;
  if (owned || status.st_uid == ::geteuid()) static_cast<void>(::fchmod(descriptor, status.st_mode & 0777));
}

// Renaming would replace a device by a file, or take away the name under which a program sees its own output.
void require_replaceable(const fs::path& target) {
  std::error_code error;
  const fs::file_status status = fs::status(target, error);
  if (fs::is_directory(status)) throw InputError(target.string() + ": is a folder; give the name of a file");
  const fs::path link = fs::read_symlink(target, error);
  const bool to_a_process = !error && link.native().rfind("/proc/", 0) == 0;
  if (to_a_process || (fs::exists(status) && !fs::is_regular_file(status))) {
    throw InputError(target.string() + ": is a device or pipe; give the name of a file");
  }
}

void require_creatable(const fs::path& target) {
  struct stat status;
  if (::lstat(target.c_str(), &status) != 0 && errno == ENAMETOOLONG) {
    throw InputError(target.string() + ": cannot write (" + std::strerror(errno) +
                     "); choose a shorter name");
  }
}

}  // namespace

void append_line(const std::filesystem::path& file, std::string_view line) {
  const Descriptor descriptor(file);
  ::flock(descriptor.number(),
          LOCK_EX);  // until the descriptor is closed; a file system without locks has none
  const off_t size = file_size(descriptor.number());
  if (size < 0) throw InputError(file.string() + ": is no regular file; name another");
  std::string text(ends_within_line(descriptor.number(), size) ? "\n" : "");
  text.append(line).append(1, '\n');
  if (write_all(descriptor.number(), text)) return;
  const std::string reason = std::strerror(errno);
  if (::ftruncate(descriptor.number(), size) != 0) {
    throw WorkError(file.string() + ": holds a line that was cut short: " + reason);
  }
  throw WorkError(file.string() + ": cannot be written: " + reason);
}

std::array<std::atomic<const char*>, 64>& temporary_files() {
  static std::array<std::atomic<const char*>, 64> names{};
  return names;
}

void remove_temporary_files() {
  for (const std::atomic<const char*>& name : temporary_files()) {
    if (const char* file = name.load()) ::unlink(file);
  }
}

TemporaryName::TemporaryName(const fs::path& target) {
  // Process numbers would not do: programs in two containers may share both the number and the folder.
  std::random_device random;
  const std::string own = std::to_string(random()) + "_" + std::to_string(random());
  name_ = (parent_folder(target) / (".astrolith_" + own + ".tmp")).string();
  for (std::atomic<const char*>& name : temporary_files()) {
    const char* nobody = nullptr;
    if (name.compare_exchange_strong(nobody, name_.c_str())) {
      known_as_ = &name;
      break;
    }
  }
}

TemporaryName::~TemporaryName() {
  const int error = errno;  // the caller's, which it may be about to report
  ::unlink(name_.c_str());
  errno = error;
  if (known_as_ != nullptr) known_as_->store(nullptr);
}

FileHandle open_nameless_file(const fs::path& target) {
  if (FileHandle file = open_linkable_file(target)) return file;
  const TemporaryName name(target);
  return create(name.c_str());
}

OutputFile::OutputFile(const fs::path& target, Start start) : packed_(target.extension() == ".zst") {
  require_replaceable(target);
  require_creatable(target);
  target_ = through_links(target);
  require_not_read_only(target_);
  if (start == Start::kNameless) file_ = open_linkable_file(target_);
  if (file_) return;
  temporary_ = std::make_unique<TemporaryName>(target_);
  file_ = create(temporary_->c_str());
  if (!file_) {
    throw InputError(target_.string() + ": cannot write (" + std::strerror(errno) +
                     "); choose a folder that exists and is writable");
  }
}

void OutputFile::write(const void* data, std::size_t bytes) {
  if (bytes != 0 && std::fwrite(data, 1, bytes, file_.get()) != bytes) fail();
}

void OutputFile::append_file(int descriptor, std::uint64_t bytes) {
  if (std::fflush(file_.get()) != 0) fail();
  off_t from = 0;
#ifdef __linux__
  ssize_t copied = 1;
  while (bytes > 0 && copied > 0) {  // the system copies it, where the file system lets it
    copied = ::copy_file_range(descriptor, &from, ::fileno(file_.get()), nullptr, bytes, 0);
    bytes -= copied > 0 ? static_cast<std::uint64_t>(copied) : 0;
  }
#endif
  if (::fseeko(file_.get(), 0, SEEK_END) != 0) fail();
  std::vector<char> block(std::min<std::uint64_t>(bytes, std::uint64_t{1} << 16));
  while (bytes > 0) {
    const ssize_t read =
        ::pread(descriptor, block.data(), std::min<std::uint64_t>(bytes, block.size()), from);
    if (read == 0) errno = EIO;  // the other file is shorter
    if (read <= 0) fail();
    write(block.data(), static_cast<std::size_t>(read));
    from += read;
    bytes -= static_cast<std::uint64_t>(read);
  }
}

void OutputFile::seek(std::int64_t offset) {
  if (::fseeko(file_.get(), offset, SEEK_SET) != 0) fail();
}

int OutputFile::duplicate_descriptor() {
  const int descriptor = std::fflush(file_.get()) == 0 ? ::dup(::fileno(file_.get())) : -1;
  if (descriptor < 0) fail();
  return descriptor;
}

void OutputFile::compress() {
  if (std::fflush(file_.get()) != 0) fail();
  OutputFile packed(target_);
  pack_zstd(file_.get(), packed);
  file_.swap(packed.file_);
  temporary_.swap(packed.temporary_);
}

void OutputFile::commit() {
  if (packed_) compress();
  const int descriptor = duplicate_descriptor();
  copy_permissions(target_, descriptor);
  bool done = std::fclose(file_.release()) == 0;
  done = done && sync(descriptor) && name_it(descriptor) && sync_folder(parent_folder(target_));
  const int error = errno;
  ::close(descriptor);
  errno = error;
  if (!done) fail();
}

bool OutputFile::name_it(int descriptor) {
  if (temporary_) return std::rename(temporary_->c_str(), target_.c_str()) == 0;
  const std::string nameless = listed_name(descriptor);
  if (::linkat(AT_FDCWD, nameless.c_str(), AT_FDCWD, target_.c_str(), AT_SYMLINK_FOLLOW) == 0) return true;
  return errno == EEXIST && replace_target(nameless);
}

bool OutputFile::replace_target(const std::string& nameless) {
  const TemporaryName name(target_);
  return ::linkat(AT_FDCWD, nameless.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0 &&
         ::rename(name.c_str(), target_.c_str()) == 0;
}

void OutputFile::fail() const {
  throw WorkError(target_.string() + ": writing failed (" + std::strerror(errno) + "); is the disk full?");
}

void write_file(const fs::path& target, std::string_view content) {
  OutputFile file(target);
  file.write(content.data(), content.size());
  file.commit();
}

UnsyncedOutputs::UnsyncedOutputs() { ++g_unsynced; }
UnsyncedOutputs::~UnsyncedOutputs() { --g_unsynced; }

void sync_file_system(const fs::path& file) {
  const int descriptor = g_unsynced > 0 ? -1 : ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return;
#ifdef __linux__
  const bool done = on_disk(::syncfs(descriptor));
#else
  const bool done = on_disk(::fsync(descriptor));
#endif
  const std::string reason = std::strerror(errno);
  ::close(descriptor);
  if (!done) throw WorkError(file.string() + ": the disk did not keep it (" + reason + ")");
}

void require_writable(const fs::path& target) { const OutputFile probe(target); }

void require_folder_can_be_made(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::path there = std::filesystem::absolute(folder, error).lexically_normal();
  while (!std::filesystem::exists(there, error) && there.has_relative_path()) there = there.parent_path();
  if (!std::filesystem::is_directory(there, error) || ::access(there.c_str(), W_OK) != 0) {
    throw InputError(folder.string() + ": cannot make this folder; choose a place that is writable");
  }
}

void require_other_file(const fs::path& output, const fs::path& input) {
  std::error_code none;  // files that do not exist are not the same
  if (fs::equivalent(output, input, none)) {
    throw InputError(output.string() + ": is the input itself; give the output another name");
  }
}

void require_two_files(const fs::path& output, const fs::path& other) {
  const auto place = [](const fs::path& file) {
    return fs::absolute(through_links(file)).lexically_normal();
  };
  if (place(output) == place(other)) {
    throw InputError(output.string() + ": is the name of two outputs; give each its own");
  }
  require_other_file(output, other);
}

void make_output_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder)) {
    throw InputError(folder.string() + ": cannot make this folder; choose a place that is writable");
  }
}

}  // namespace astrolith
