// The class Sha256 by OpenSSL.
#include <openssl/evp.h>

#include <array>

#include "numerics/errors.h"
#include "numerics/files/sha256.h"

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

}  // namespace astrolith
