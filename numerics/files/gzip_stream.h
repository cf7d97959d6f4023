// gzip (RFC 1952) by zlib.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace astrolith {

// Whether bytes begin as a gzip file does.
bool is_gzip(std::string_view bytes);

// The content of a compressed file, of all its members one after another. Throws InputError, without a file's
// name, for bytes that are damaged or end too early, and for content above `most_bytes`, which is never held.
std::string unpack_gzip(std::string_view packed, std::uint64_t most_bytes);

// The first `bytes` bytes of the content of a file of which `packed` is the beginning; fewer where `packed`
// does not yield them, or is damaged.
std::string unpack_gzip_start(std::string_view packed, std::size_t bytes);

}  // namespace astrolith
