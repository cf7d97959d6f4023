#include <openssl/evp.h>

#include <algorithm>
#include <cstddef>

#include "estimation/page/page_internal.h"

namespace astrolith {

std::string escaped_html(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string base64(std::span<const std::uint8_t> bytes) {
  // OpenSSL counts in int: pieces of a multiple of three bytes need no padding between them.
  constexpr std::size_t kPiece = std::size_t{3} << 20;
  std::string text;
  for (std::size_t start = 0; start < bytes.size(); start += kPiece) {
    const std::size_t count = std::min(kPiece, bytes.size() - start);
    std::string piece(4 * ((count + 2) / 3) + 1, '\0');  // and OpenSSL's final zero
    EVP_EncodeBlock(reinterpret_cast<unsigned char*>(piece.data()), bytes.data() + start,
                    static_cast<int>(count));
    piece.pop_back();
    text += piece;
  }
  return text;
}

}  // namespace astrolith
