// Zstandard (RFC 8878) by libzstd, a piece at a time.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

#include "numerics/files/output_file.h"

namespace astrolith {

// Whether bytes begin as a Zstandard frame does.
bool is_zstd(std::string_view bytes);

// Appends the compressed content of `plain`, from its first byte, to `packed`. The same content gives the
// same bytes with the same version of libzstd. Throws WorkError where `plain` cannot be read or the disk is
// full.
void pack_zstd(std::FILE* plain, OutputFile& packed);

// The content of a compressed file. Throws InputError, without a file's name, for bytes that are not
// Zstandard or end too early, and for content above `most_bytes`, which is never held: a small file can
// unpack to any size. Memory is the content, at most doubled, and some .1 MB.
std::string unpack_zstd(std::string_view packed, std::uint64_t most_bytes);

// The first `bytes` bytes of the content of a file of which `packed` is the beginning; fewer where `packed`
// does not yield them, or is damaged.
std::string unpack_zstd_start(std::string_view packed, std::size_t bytes);

}  // namespace astrolith
