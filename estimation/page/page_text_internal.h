// Text as HTML, and bytes as text.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace astrolith {

// `text` with &, <, > and " as entities.
std::string escaped_html(const std::string& text);

// RFC 4648, with padding and without line breaks.
std::string base64(std::span<const std::uint8_t> bytes);

}  // namespace astrolith
