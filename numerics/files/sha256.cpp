#include "numerics/files/sha256.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <vector>

#include "numerics/errors.h"

namespace astrolith {

std::string sha256(std::string_view bytes) {
  Sha256 hash;
  hash.update(bytes.data(), bytes.size());
  return hash.hex();
}

std::string file_sha256(const std::filesystem::path& file) {
  const auto refuse = [&] {
    throw InputError(file.string() + ": cannot read (" + std::strerror(errno) + "); check the name");
  };
  std::error_code none;
  if (std::filesystem::is_fifo(file, none)) {  // opening one waits until somebody writes
    throw InputError(file.string() + ": is a pipe; give a file");
  }
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(file.c_str(), "rb"), &std::fclose);
  if (!stream) refuse();
  Sha256 hash;
  std::vector<char> chunk(std::size_t{1} << 16);
  while (const std::size_t count = std::fread(chunk.data(), 1, chunk.size(), stream.get())) {
    hash.update(chunk.data(), count);
  }
  if (std::ferror(stream.get()) != 0) refuse();
  return hash.hex();
}

}  // namespace astrolith
