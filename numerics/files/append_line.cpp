#include "numerics/files/append_line.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "numerics/errors.h"

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
off_t size_of(int descriptor) {
  struct stat status {};
  return ::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode) ? status.st_size : -1;
}

bool ends_in_the_middle_of_a_line(int descriptor, off_t size) {
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

}  // namespace

void append_line(const std::filesystem::path& file, std::string_view line) {
  const Descriptor descriptor(file);
  ::flock(descriptor.number(),
          LOCK_EX);  // until the descriptor is closed; a file system without locks has none
  const off_t size = size_of(descriptor.number());
  if (size < 0) throw InputError(file.string() + ": is no regular file; name another");
  std::string text(ends_in_the_middle_of_a_line(descriptor.number(), size) ? "\n" : "");
  text.append(line).append(1, '\n');
  if (write_all(descriptor.number(), text)) return;
  const std::string reason = std::strerror(errno);
  if (::ftruncate(descriptor.number(), size) != 0) {
    throw WorkError(file.string() + ": holds a line that was cut short: " + reason);
  }
  throw WorkError(file.string() + ": cannot be written: " + reason);
}

}  // namespace astrolith
