#include "numerics/printable_text.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>

namespace astrolith {
namespace {

struct CodeRange {
  std::uint32_t first, last;
};

// The ranges of Unicode 15 with the general categories Cc (beyond ASCII), Cf, Zl and Zp; fillers that show
// nothing; and the noncharacters of the first plane.
constexpr CodeRange kHidden[] = {
    {0x80, 0x9f},       {0xad, 0xad},       {0x34f, 0x34f},     {0x600, 0x605},     {0x61c, 0x61c},
    {0x6dd, 0x6dd},     {0x70f, 0x70f},     {0x890, 0x891},     {0x8e2, 0x8e2},     {0x115f, 0x1160},
    {0x17b4, 0x17b5},   {0x180b, 0x180f},   {0x200b, 0x200f},   {0x2028, 0x202e},   {0x2060, 0x206f},
    {0x3164, 0x3164},   {0xfdd0, 0xfdef},   {0xfe00, 0xfe0f},   {0xfeff, 0xfeff},   {0xffa0, 0xffa0},
    {0xfff0, 0xfffb},   {0xfffe, 0xffff},   {0x110bd, 0x110bd}, {0x110cd, 0x110cd}, {0x13430, 0x1343f},
    {0x1bca0, 0x1bca3}, {0x1d173, 0x1d17a}, {0xe0000, 0xe0fff}};

bool is_hidden(std::uint32_t code) {
  if ((code & 0xffff) >= 0xfffe) return true;  // the last two of every plane are noncharacters
  return std::any_of(std::begin(kHidden), std::end(kHidden),
                     [&](const CodeRange& range) { return code >= range.first && code <= range.last; });
}

unsigned byte_at(std::string_view text, std::size_t i) { return static_cast<unsigned char>(text[i]); }

struct Character {
  std::uint32_t code = 0;
  std::size_t bytes = 0;  // 0 where the text is not UTF-8
};

// The character at the start of a text that is not empty. Overlong forms, surrogates and codes beyond Unicode
// are not UTF-8.
Character first_character(std::string_view text) {
  constexpr std::uint32_t kLeastByLength[] = {0, 0, 0x80, 0x800, 0x10000};
  const unsigned lead = byte_at(text, 0);
  if (lead < 0x80) return {lead, 1};
  const std::size_t bytes = lead >= 0xf8 ? 0 : lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : lead >= 0xc0 ? 2 : 0;
  if (bytes == 0 || bytes > text.size()) return {};
  std::uint32_t code = lead & (0x7fu >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte_at(text, i) & 0xc0) != 0x80) return {};
    code = code << 6 | (byte_at(text, i) & 0x3f);
  }
  const bool is_surrogate = code >= 0xd800 && code <= 0xdfff;
  if (code < kLeastByLength[bytes] || code > 0x10ffff || is_surrogate) return {};
  return {code, bytes};
}

std::string escape(const char* format, std::uint32_t number) {
  char text[16];
  std::snprintf(text, sizeof text, format, static_cast<unsigned>(number));
  return text;
}

std::string escape_control(unsigned code) {
  switch (code) {
    case '\n':
      return "\\n";
    case '\r':
      return "\\r";
    case '\t':
      return "\\t";
    default:
      return escape("\\x%02x", code);
  }
}

}  // namespace

std::string printable(std::string_view text) {
  std::string line;
  for (std::size_t i = 0; i < text.size();) {
    const Character c = first_character(text.substr(i));
    if (c.bytes == 0) {
      line += escape("\\x%02x", byte_at(text, i++));
      continue;
    }
    if (c.code < 0x20 || c.code == 0x7f) {
      line += escape_control(c.code);
    } else if (is_hidden(c.code)) {
      line += escape(c.code > 0xffff ? "\\U%08x" : "\\u%04x", c.code);
    } else {
      line += text.substr(i, c.bytes);
    }
    i += c.bytes;
  }
  return line;
}

}  // namespace astrolith
