#include "numerics/files/sha256.h"

#include <openssl/evp.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <vector>

#include "numerics/errors.h"

namespace astrolith {
namespace {

void expect_success(int status) {
  if (status != 1) throw WorkError("SHA-256 failed in OpenSSL; is its default provider installed?");
}

}  // namespace

// Owns a context of OpenSSL.
struct Sha256::Context {
  Context() = default;
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
  ~Context() { EVP_MD_CTX_free(pointer); }

  EVP_MD_CTX* const pointer = EVP_MD_CTX_new();
};

Sha256::Sha256() : context_(std::make_unique<Context>()) {
  expect_success(EVP_DigestInit_ex(context_->pointer, EVP_sha256(), nullptr));
}
Sha256::~Sha256() = default;
Sha256::Sha256(Sha256&&) noexcept = default;
Sha256& Sha256::operator=(Sha256&&) noexcept = default;

void Sha256::update(const void* data, std::size_t bytes) {
  expect_success(EVP_DigestUpdate(context_->pointer, data, bytes));
}

std::string Sha256::hex() const {
  const Context copy;
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  expect_success(EVP_MD_CTX_copy_ex(copy.pointer, context_->pointer));
  expect_success(EVP_DigestFinal_ex(copy.pointer, digest.data(), &size));
  std::string text;
  for (unsigned int i = 0; i < size; ++i) {
    text += "0123456789abcdef"[digest[i] >> 4];
    text += "0123456789abcdef"[digest[i] & 15];
  }
  return text;
}

std::string sha256_of(std::string_view bytes) {
  Sha256 hash;
  hash.update(bytes.data(), bytes.size());
  return hash.hex();
}

std::string sha256_of_file(const std::filesystem::path& file) {
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
