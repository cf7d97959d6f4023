#include "numerics/files/gzip_stream.h"

#include <zlib.h>

#include <algorithm>
#include <limits>

#include "numerics/errors.h"

namespace astrolith {
namespace {

// Unpacks until the content has `most` bytes, the input ends or is damaged. Returns zlib's last word.
int unpack(std::string_view packed, std::uint64_t most, std::string& content) {
  constexpr int kGzip = 16 + MAX_WBITS;
  constexpr std::size_t kPiece = std::size_t{1} << 18;
  z_stream stream{};
  if (inflateInit2(&stream, kGzip) != Z_OK) throw WorkError("zlib cannot begin");
  int said = Z_OK;
  std::string piece(kPiece, '\0');
  while (said == Z_OK && content.size() < most) {
    if (stream.avail_in == 0) {
      const std::size_t given = std::min<std::size_t>(packed.size(), std::numeric_limits<uInt>::max());
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
      stream.avail_in = static_cast<uInt>(given);
      packed.remove_prefix(given);
    }
    stream.next_out = reinterpret_cast<Bytef*>(piece.data());
    stream.avail_out = static_cast<uInt>(std::min<std::uint64_t>(kPiece, most - content.size()));
    const uInt room = stream.avail_out;
    said = inflate(&stream, Z_NO_FLUSH);
    content.append(piece, 0, room - stream.avail_out);
    // Another member may follow, or padding that is none.
    const int next = stream.avail_in > 0 ? *stream.next_in : packed.empty() ? 0 : packed.front();
    if (said == Z_STREAM_END && next == '\x1f') said = inflateReset(&stream);
  }
  inflateEnd(&stream);
  return said;
}

}  // namespace

bool is_gzip(std::string_view bytes) { return bytes.substr(0, 2) == "\x1f\x8b"; }

std::string unpack_gzip(std::string_view packed, std::uint64_t most_bytes) {
  std::string content;
  const int said = unpack(packed, most_bytes + 1, content);
  if (content.size() > most_bytes)
    throw InputError("unpacks to more than " + std::to_string(most_bytes) +
                     " bytes; unpack it with gunzip first");
  if (said == Z_BUF_ERROR || said == Z_OK)
    throw InputError("is damaged (gzip: it ends too early); copy it again");
  if (said != Z_STREAM_END) throw InputError("is damaged (gzip); copy it again");
  return content;
}

std::string unpack_gzip_start(std::string_view packed, std::size_t bytes) {
  std::string content;
  unpack(packed, bytes, content);
  return content;
}

}  // namespace astrolith
