// Zstandard and gzip where libzstd and zlib are missing: compressed files are known and refused.
#include "numerics/errors.h"
#include "numerics/files/gzip_stream.h"
#include "numerics/files/zstd_stream.h"

namespace astrolith {

bool is_zstd(std::string_view bytes) { return bytes.substr(0, 4) == "\x28\xb5\x2f\xfd"; }

void pack_zstd(std::FILE*, OutputFile&) {
  throw WorkError("Zstandard is missing here; write the file without .zst");
}

std::string unpack_zstd(std::string_view, std::uint64_t) {
  throw InputError("is compressed, and Zstandard is missing here; unpack it first");
}

std::string unpack_zstd_start(std::string_view, std::size_t) { return {}; }

bool is_gzip(std::string_view bytes) { return bytes.substr(0, 2) == "\x1f\x8b"; }

std::string unpack_gzip(std::string_view, std::uint64_t) {
  throw InputError("is compressed, and zlib is missing here; unpack it first");
}

std::string unpack_gzip_start(std::string_view, std::size_t) { return {}; }

}  // namespace astrolith
