#include <sys/stat.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>

#include "geometry/io/mesh_file_internal.h"
#include "numerics/files/zstd_stream.h"

namespace astrolith {

void MeshFile::fail(std::string_view place, std::string_view what, std::string_view remedy) const {
  std::string message = path.string() + ": ";
  if (!place.empty()) message.append(place).append(": ");
  throw InputError(message.append(what).append("; ").append(remedy));
}

namespace {

// Replaces a compressed file by its content. Meshes become a few times smaller; a file that would become a
// hundred times as large is refused.
void unpack(MeshFile& file) {
  constexpr std::uint64_t kMostGrowth = 100;
  try {
    file.bytes = unpack_zstd(file.bytes, kMostGrowth * file.bytes.size());
  } catch (const InputError& e) {
    throw InputError(file.path.string() + ": " + e.what());
  }
}

}  // namespace

MeshFile load_mesh_file(const std::filesystem::path& path) {
  MeshFile file{path, {}};
  struct FileCloser {
    void operator()(std::FILE* f) const { std::fclose(f); }
  };
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) {
    file.fail("", std::string("cannot be read (") + std::strerror(errno) + ")", "check the name");
  }
  if (S_ISDIR(status.st_mode)) file.fail("", "is a folder", "give the name of a mesh file");
  if (!S_ISREG(status.st_mode)) file.fail("", "is not a plain file", "copy the mesh into a file first");
  const std::unique_ptr<std::FILE, FileCloser> in(std::fopen(path.c_str(), "rb"));
  if (!in) file.fail("", std::string("cannot be read (") + std::strerror(errno) + ")", "check its rights");
  file.bytes.resize(static_cast<std::size_t>(status.st_size));
  file.bytes.resize(std::fread(file.bytes.data(), 1, file.bytes.size(), in.get()));
  if (std::ferror(in.get()) != 0) file.fail("", "reading failed", "copy it to another disk");
  if (file.bytes.empty()) file.fail("", "is empty", "give a mesh file");
  if (is_zstd(file.bytes)) unpack(file);
  return file;
}

std::string quoted(std::string_view piece) {
  constexpr std::size_t kLongest = 40;
  std::string text = "'";
  for (const char c : piece.substr(0, kLongest)) text += c >= ' ' && c <= '~' ? c : '?';
  return text + (piece.size() > kLongest ? "...'" : "'");
}

}  // namespace astrolith
