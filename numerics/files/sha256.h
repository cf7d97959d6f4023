// SHA-256 (FIPS 180-4) of files and streams. A recipe names its input by the hash, and equal hashes prove
// that two meshes are equal byte for byte.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace astrolith {

//   Sha256 hash;
//   hash.update(data, bytes);
//   std::string digits = hash.hex();
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(Sha256&&) noexcept;
  Sha256& operator=(Sha256&&) noexcept;

  void update(const void* data, std::size_t bytes);
  // 64 lower-case hexadecimal digits for all bytes so far. Further updates may follow.
  std::string hex() const;

 private:
  struct Context;
  std::unique_ptr<Context> context_;
};

// 64 lower-case hexadecimal digits.
std::string sha256(std::string_view bytes);
// The SHA-256 of a file, as of a text. Throws InputError when the file cannot be read, as a pipe cannot.
std::string file_sha256(const std::filesystem::path& file);

}  // namespace astrolith
